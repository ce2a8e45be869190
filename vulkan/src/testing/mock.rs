//! Recorders for graphs without shaders, for example those of files.
//!
//! Each pass reads all of its inputs and writes values that depend on them, on its name and on the position. The
//! results of a frame are therefore equal for all plans of a graph, if the plans are right.

use super::draw::{Bound, DepthTest, Dispatch, Draw};
use super::kit::Kit;
use crate::cx::{Cx, RecordError};
use crate::views::ViewShape;
use ash::vk;
use framegraph::{Access, AccessKind, Aspect, Desc, Dimension, Format, Mode, Numeric, PassKind, TextureDesc};
use std::fmt::Write;

/// Records passes by their declarations. See the module documentation.
pub struct Mock {
    /// Pipelines and descriptor sets.
    pub kit: Kit,
}

/// A shader under construction.
#[derive(Default)]
struct Source {
    text: String,
    /// Statements that add the inputs to `sum`.
    reads: String,
    /// Statements that write storage.
    writes: String,
    bindings: Vec<Bound>,
    /// Largest extent of storage that is written.
    extent: [u32; 2],
}

const COMMON: &str = "
fn of_uint(v: vec4u) -> f32 { return f32(v.x & 255u) / 255.0; }
fn of_sint(v: vec4i) -> f32 { return f32(v.x & 127) / 127.0; }
";

impl Mock {
    /// Records a pass.
    ///
    /// # Errors
    /// Fails if a shader does not compile, for example because the device lacks a storage format.
    pub fn record(&mut self, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let graph = cx.plan().graph();
        let own = graph.accesses_of(cx.pass());
        match graph.passes()[cx.pass().index()].kind {
            PassKind::Copy => self.kit.copies(cx, own),
            PassKind::Compute => {
                let source = Source::new(cx, own)?;
                let [x, y] = source.extent.map(|side| side.div_ceil(8).max(1));
                let text = format!(
                    "{COMMON}{}@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3u) {{
  let texel = id.xy; let at = (vec2f(id.xy) + 0.5) / vec2f({}.0, {}.0);\n{}{}{}}}\n",
                    source.text,
                    source.extent[0].max(1),
                    source.extent[1].max(1),
                    start(cx.pass_name()),
                    source.reads,
                    source.writes
                );
                let bindings = &source.bindings;
                self.kit.dispatch(cx, &Dispatch { wgsl: &text, bindings, groups: [x, y, 1], indirect: None })
            }
            PassKind::Raster => self.raster(cx, own),
        }
    }

    fn raster(&mut self, cx: &mut Cx<'_>, own: &[Access]) -> Result<(), RecordError> {
        let source = Source::new(cx, own)?;
        let (mut outputs, mut colors, mut slots) = (String::new(), String::new(), 0);
        for access in own.iter().filter(|access| access.kind == AccessKind::Color) {
            let (slot, format) = (access.slot, cx.plan().format(access.resource).unwrap_or(Format::R8Unorm));
            let (ty, value) = match format.numeric() {
                Numeric::Uint => ("vec4u", "vec4u(u32(value * 200.0))"),
                Numeric::Sint => ("vec4i", "vec4i(i32(value * 100.0))"),
                _ => ("vec4f", "vec4f(value, value * 0.5, 1.0 - value, 0.25)"),
            };
            write!(outputs, "@location({slot}) c{slot}: {ty}, ")?;
            write!(colors, "out.c{slot} = {value}; ")?;
            slots |= 1 << slot;
        }
        let whole = own.iter().any(|access| access.mode == Mode::Overwrite);
        let (reach, z) = (if whole { "4.0" } else { "2.0" }, 0.1 + 0.8 * share(cx.pass_name(), 7));
        let (declared, returned, out, done) = if outputs.is_empty() {
            (String::new(), "", "", "if value < -1.0 { discard; }")
        } else {
            (format!("struct Out {{ {outputs} }}\n"), " -> Out", "var out: Out;", "return out;")
        };
        let [width, height] = cx.extent();
        let text = format!(
            "{COMMON}{declared}{}@vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {{
  return vec4f(f32(i & 1) * {reach} - 1.0, f32(i >> 1) * {reach} - 1.0, {z:.5}, 1.0);
}}
@fragment fn fs_main(@builtin(position) position: vec4f){returned} {{
  let at = position.xy / vec2f({width}.0, {height}.0); let texel = vec2u(position.xy); {out}
{}{}  let value = fract(sum);\n{}{colors}{done}\n}}\n",
            source.text,
            start(cx.pass_name()),
            source.reads,
            source.writes.replace("fract(sum)", "value"),
        );
        let depth = own.iter().find(|access| access.kind.is_depth()).map_or(DepthTest::NONE, |access| {
            let format = cx.plan().format(access.resource).unwrap_or(Format::Depth32Float);
            let writes = |plane| access.mode.writes() && access.range.aspect != plane;
            DepthTest {
                compare: if whole { vk::CompareOp::ALWAYS } else { vk::CompareOp::GREATER_OR_EQUAL },
                write: writes(Aspect::Stencil) && format.has_depth(),
                stencil: None,
                stencil_write: writes(Aspect::Depth) && format.has_stencil(),
                reference: 1 + cx.pass().index() as u32 % 200,
            }
        });
        self.kit.draw(cx, &Draw { slots, depth, ..Draw::new(&text, &source.bindings) })
    }
}

/// Returns a number from 0 to 1 that depends on the name.
fn share(name: &str, salt: u8) -> f32 {
    let mix = |hash: u32, byte| (hash ^ u32::from(byte)).wrapping_mul(16_777_619);
    (name.bytes().chain([salt]).fold(0x811c_9dc5, mix) >> 8) as f32 / 16_777_216.0
}

fn start(name: &str) -> String {
    format!("  var sum = {:.5} + 0.5 * at.x + 0.25 * at.y;\n", share(name, 0))
}

impl Source {
    fn new(cx: &mut Cx<'_>, own: &[Access]) -> Result<Self, RecordError> {
        let mut source = Self::default();
        for access in own {
            match (access.kind, cx.plan().graph().resources()[access.resource.index()].desc) {
                (AccessKind::Sampled | AccessKind::SamePixel, Desc::Texture(desc)) => {
                    source.texture(cx, access, &desc)?;
                }
                (AccessKind::StorageRead | AccessKind::StorageWrite, Desc::Texture(desc)) => {
                    for mip in access.range.mip_range(desc.mip_count(cx.plan().frame())) {
                        source.storage(cx, access, &desc, mip as u8)?;
                    }
                }
                (kind, Desc::Buffer(_)) => source.buffer(cx, access, kind)?,
                _ => {}
            }
        }
        Ok(source)
    }

    fn declare(&mut self, space: &str, ty: &str, bound: Bound) -> usize {
        let number = self.bindings.len();
        self.text += &format!("@group(0) @binding({number}) var{space} t{number}: {ty};\n");
        self.bindings.push(bound);
        number
    }

    fn texture(&mut self, cx: &mut Cx<'_>, access: &Access, desc: &TextureDesc) -> Result<(), RecordError> {
        let format = cx.plan().format(access.resource).unwrap_or(desc.format);
        let stencil = !format.has_depth() && format.has_stencil() || access.range.aspect == Aspect::Stencil;
        let plane = match (format.planes() > 1, stencil) {
            (false, _) => None,
            (true, true) => Some(Aspect::Stencil),
            (true, false) => Some(Aspect::Depth),
        };
        let layers = access.range.layer_range(desc.layers.into()).len();
        let flat = desc.samples > 1 || desc.dimension == Dimension::D3;
        if desc.samples > 1 && layers > 1 {
            return Err("several layers of samples cannot be sampled in WGSL".into());
        }
        let bound = cx.bind(access, ViewShape { arrayed: !flat, aspect: plane, ..ViewShape::default() })?;
        let in_tile = bound.input.is_some();
        let bound = match in_tile && !flat {
            true => cx.bind(access, ViewShape { aspect: plane, ..ViewShape::default() })?,
            false => bound,
        };
        let (of, depth, value) = match format.numeric() {
            Numeric::Depth if !stencil => ("", "_depth", "f32(LOAD)"),
            Numeric::Depth | Numeric::Uint => ("<u32>", "", "of_uint(LOAD)"),
            Numeric::Sint => ("<i32>", "", "of_sint(LOAD)"),
            Numeric::Float => ("<f32>", "", "(LOAD).x"),
        };
        let array = if in_tile { "" } else { "_array" };
        let ty = match (desc.dimension, desc.samples) {
            (Dimension::D3, _) => format!("texture_3d{of}"),
            (_, 1) => format!("texture{depth}_2d{array}{of}"),
            _ => format!("texture{depth}_multisampled_2d{of}"),
        };
        let number = self.declare("", &ty, Bound::Texture(bound));
        let weight = 0.25 + 0.5 * share(cx.pass_name(), number as u8 + 1);
        let texel = |size: &str| format!("min(vec2u(at * vec2f({size})), {size} - 1u)");
        let add = |load: &str| format!("sum += {weight:.5} * {};", value.replace("LOAD", load));
        self.reads += &match (in_tile, desc.dimension, desc.samples) {
            (true, ..) => add(&format!("textureLoad(t{number}, vec2i(0), 0)")),
            (_, Dimension::D3, _) => add(&format!("textureLoad(t{number}, vec3u(0u), 0)")),
            (_, _, 1) => format!(
                "for (var level = 0u; level < textureNumLevels(t{number}); level++) {{
    let size = textureDimensions(t{number}, level);
    for (var layer = 0u; layer < textureNumLayers(t{number}); layer++) {{ {} }} }}",
                add(&format!("textureLoad(t{number}, {}, layer, level)", texel("size")))
            ),
            _ => {
                let size = format!("textureDimensions(t{number})");
                add(&format!("textureLoad(t{number}, {}, 0)", texel(&size)))
            }
        };
        self.reads.push('\n');
        Ok(())
    }

    fn storage(&mut self, cx: &mut Cx<'_>, access: &Access, desc: &TextureDesc, mip: u8) -> Result<(), RecordError> {
        let format = cx.plan().format(access.resource).unwrap_or(desc.format);
        let writes = access.kind == AccessKind::StorageWrite;
        let volume = desc.dimension == Dimension::D3;
        let bound = cx.bind(access, ViewShape { arrayed: !volume, mip: Some(mip), ..ViewShape::default() })?;
        let (dimension, at) = if volume { ("3d", "vec3u(texel, layer)") } else { ("2d_array", "texel, layer") };
        let mode = if writes { "write" } else { "read" };
        let ty = format!("texture_storage_{dimension}<{}, {mode}>", format!("{format:?}").to_lowercase());
        let number = self.declare("", &ty, Bound::Storage(bound));
        let count = match volume {
            true => format!("textureDimensions(t{number}).z"),
            false => format!("textureNumLayers(t{number})"),
        };
        if !writes {
            let first = if volume { "vec3u(0u)" } else { "vec2u(0u), 0" };
            self.reads += &format!("sum += f32(textureLoad(t{number}, {first}).x);\n");
            return Ok(());
        }
        let value = match format.numeric() {
            Numeric::Uint => "vec4u(u32(fract(sum) * 200.0))",
            Numeric::Sint => "vec4i(i32(fract(sum) * 100.0))",
            _ => "vec4f(fract(sum))",
        };
        self.writes += &format!(
            "  for (var layer = 0u; layer < {count}; layer++) {{ textureStore(t{number}, {at}, {value}); }}\n"
        );
        let [width, height] = desc.mip_extent(cx.plan().frame(), mip.into());
        self.extent = [self.extent[0].max(width), self.extent[1].max(height)];
        Ok(())
    }

    fn buffer(&mut self, cx: &mut Cx<'_>, access: &Access, kind: AccessKind) -> Result<(), RecordError> {
        let part = cx.buffer_of(access)?;
        match kind {
            AccessKind::StorageRead => {
                let number = self.declare("<storage, read>", "array<u32>", Bound::Buffer(part));
                self.reads += &format!("sum += f32(t{number}[0] & 255u) / 256.0;\n");
            }
            AccessKind::StorageWrite => {
                let number = self.declare("<storage, read_write>", "array<u32>", Bound::Buffer(part));
                let value = share(cx.pass_name(), 9);
                // Every invocation writes equal words.
                self.writes += &format!(
                    "  for (var i = 0u; i < arrayLength(&t{number}); i++) {{ t{number}[i] = u32({value:.5} * 200.0) + i; }}\n"
                );
            }
            AccessKind::Uniform if part.bytes >= 16 => {
                let number = self.declare("<uniform>", "vec4u", Bound::Uniform(part));
                self.reads += &format!("sum += f32(t{number}.x & 255u) / 256.0;\n");
            }
            _ => {}
        }
        Ok(())
    }
}
