//! Shaders of random passes. There is one source for each list of inputs and kind of output; everything else is in
//! uniforms.
//!
//! The vertex stage of a raster pass computes the digest and passes it on with flat interpolation. Computing it in
//! every fragment would be slow.

use super::code::{LOOKS, Numeric};
use super::spec::Class;
use framegraph::Format;
use std::fmt::Write;

/// Output of one draw or dispatch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Out {
    /// Only the witness buffer.
    Nothing,
    /// A color attachment at this slot, of floats or unsigned integers.
    Color(u8, Numeric),
    /// Depth plane of the attachment.
    Depth,
    /// One stencil value of the attachment.
    Stencil,
    /// One level of a storage texture, with all its layers.
    Texture(Format),
    /// A storage buffer.
    Buffer,
}

/// Identity of a shader.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Signature {
    pub inputs: Vec<Class>,
    pub out: Out,
    pub stage: Stage,
}

/// Shader stages of the pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    Compute,
    Raster,
    /// Draws into several layers at once.
    Layered,
}

/// Number of words in `Params` before the lists.
pub const PARAMS: usize = 20;

const COMMON: &str = "
fn mix(hash: u32, value: u32) -> u32 {
  var x = (hash ^ value) * 0x9E3779B1u;
  x = (x ^ (x >> 15u)) * 0x85EBCA77u;
  return x ^ (x >> 13u);
}
fn texel_hash(digest: u32, tag: u32, x: u32, y: u32) -> u32 { return mix(mix(digest, tag), y * 65536u + x); }
fn painted(hash: u32) -> vec4u {
  return vec4u(mix(hash, 0u), mix(hash, 1u), mix(hash, 2u), mix(hash, 3u)) & params.mask;
}
fn chosen(tag: u32, x: u32, y: u32) -> bool {
  return params.paint == 0u || (mix(mix(params.salt, (tag & 0x3FFFFFFFu) ^ 0x5EEDu), y * 65536u + x) & 3u) == 0u;
}
fn word(digest: u32, index: u32) -> u32 {
  let hash = texel_hash(digest, params.tag, index, 0u);
  return select(hash, 3u + (hash & 3u), index < 4u);
}
fn written(index: u32) -> bool {
  if index < 4u { return params.paint != 1u; }
  return chosen(params.tag, index, 0u);
}
fn code(value: vec4f, list: u32) -> vec4u {
  return vec4u(round(value * params.scales[list])) & params.masks[list];
}
fn fold(hash: u32, value: u32) -> u32 { return (hash ^ value) * 0x9E3779B1u + 0x7F4A7C15u; }
fn fold4(hash: u32, codes: vec4u) -> u32 {
  return fold(fold(fold(fold(hash, codes.x), codes.y), codes.z), codes.w);
}
";

impl Signature {
    /// Returns the number of inputs whose values are scaled to codes. Each has a row in `scales` and `masks`.
    pub fn lists(&self) -> usize {
        self.inputs.iter().filter(|c| scaled(**c)).count()
    }

    /// Returns a unique name of the shader.
    pub fn name(&self) -> String {
        format!("{:?} -> {:?} {:?}", self.inputs, self.out, self.stage)
    }

    /// `@binding` number of the first input.
    pub const FIRST: u32 = 2;

    /// Generates the WGSL source.
    pub fn text(&self) -> String {
        let lists = self.lists().max(1);
        let mut text = format!(
            "struct Params {{ salt: u32, tag: u32, paint: u32, witness: u32, wanted: u32, indirect: u32, z: f32, pad: u32,
  extent: vec4u, mask: vec4u, scale: vec4f, scales: array<vec4f, {lists}>, masks: array<vec4u, {lists}> }}
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> witness: array<u32>;{COMMON}"
        );
        let (mut digest, mut same, mut list) = (String::new(), String::new(), 0);
        for (index, class) in self.inputs.iter().enumerate() {
            let binding = Self::FIRST + index as u32;
            text += &format!("@group(0) @binding({binding}) var{} t{index}: {};\n", space(*class), variable(*class));
            match *class {
                Class::SamePixel(numeric, samples) => same += &same_pixel(numeric, samples, false, index, list),
                Class::InTile(numeric, samples) => same += &same_pixel(numeric, samples, true, index, list),
                _ => {
                    text += &function(*class, index, list);
                    let _ = writeln!(digest, "  hash = input{index}(hash);");
                }
            }
            list += usize::from(scaled(*class));
        }
        text += &format!(
            "fn with_same(start: u32, at: vec2u, layer: u32) -> u32 {{\n  var hash = start;\n{same}  return hash;\n}}\n"
        );
        text += &format!("fn digest() -> u32 {{\n  var hash = params.salt;\n{digest}  return mix(hash, 0u);\n}}\n");
        let binding = Self::FIRST + self.inputs.len() as u32;
        text += &match self.out {
            Out::Texture(format) => {
                let format = storage_name(format);
                format!("@group(0) @binding({binding}) var out: texture_storage_2d_array<{format}, write>;\n")
            }
            Out::Buffer => format!("@group(0) @binding({binding}) var<storage, read_write> out: array<u32>;\n"),
            _ => String::new(),
        };
        text += &match self.stage {
            Stage::Compute => compute(self.out),
            Stage::Raster => raster(self.out, false),
            Stage::Layered => raster(self.out, true),
        };
        text
    }
}

/// Returns whether the values of an input are scaled to codes.
fn scaled(class: Class) -> bool {
    match class {
        Class::Texture(numeric, _) | Class::SamePixel(numeric, _) | Class::InTile(numeric, _) => {
            numeric == Numeric::Float
        }
        Class::Storage(format) => format != Format::R32Uint,
        Class::Buffer | Class::Uniform => false,
    }
}

fn space(class: Class) -> &'static str {
    match class {
        Class::Buffer => "<storage, read>",
        Class::Uniform => "<uniform>",
        Class::Texture(..) | Class::Storage(_) | Class::SamePixel(..) | Class::InTile(..) => "",
    }
}

fn variable(class: Class) -> String {
    match class {
        Class::SamePixel(numeric, samples) => variable(Class::Texture(numeric, samples)),
        Class::InTile(numeric, samples) => variable(Class::Texture(numeric, samples)).replace("_array", ""),
        Class::Texture(Numeric::Float, false) => "texture_2d_array<f32>".into(),
        Class::Texture(Numeric::Float, true) => "texture_multisampled_2d<f32>".into(),
        Class::Texture(Numeric::Uint | Numeric::Stencil, false) => "texture_2d_array<u32>".into(),
        Class::Texture(Numeric::Uint | Numeric::Stencil, true) => "texture_multisampled_2d<u32>".into(),
        Class::Texture(Numeric::Depth, false) => "texture_depth_2d_array".into(),
        Class::Texture(Numeric::Depth, true) => "texture_depth_multisampled_2d".into(),
        Class::Storage(format) => format!("texture_storage_2d_array<{}, read>", storage_name(format)),
        Class::Buffer => "array<u32>".into(),
        Class::Uniform => "array<vec4u, 4>".into(),
    }
}

fn storage_name(format: Format) -> &'static str {
    match format {
        Format::Rgba8Unorm => "rgba8unorm",
        Format::Rgba16Float => "rgba16float",
        Format::Rgba32Float => "rgba32float",
        Format::R32Uint => "r32uint",
        Format::R8Unorm => "r8unorm",
        _ => panic!("{format:?} is no storage format"),
    }
}

/// Generates the function that adds one input to the digest.
fn function(class: Class, index: usize, list: usize) -> String {
    let looked = |count: &str, body: &str| {
        format!(
            "    for (var look = 0u; look < {LOOKS}u; look++) {{
      let at = (look * 61u + 7u) % {count};
{body}
    }}"
        )
    };
    let parts = |levels: &str, size: &str, load: &str| {
        let codes = match class {
            Class::Texture(Numeric::Depth, _) => format!("vec4u(u32(round({load} * 65536.0)), 0u, 0u, 0u)"),
            _ if scaled(class) => format!("code({load}, {list}u)"),
            _ => format!("vec4u({load}.x, 0u, 0u, 0u)"),
        };
        let body = format!(
            "      let xy = vec2u(at % size.x, at / size.x);
      hash = fold4(hash, {codes});"
        );
        format!(
            "  {levels}
    let size = {size};
    hash = fold(hash, level * 256u + layer + 1u);
{}
  }}",
            looked("(size.x * size.y)", &body)
        )
    };
    let body = match class {
        Class::Texture(_, false) => {
            let levels = format!(
                "for (var part = 0u; part < textureNumLevels(t{index}) * textureNumLayers(t{index}); part++) {{
    let level = part / textureNumLayers(t{index}); let layer = part % textureNumLayers(t{index});"
            );
            parts(
                &levels,
                &format!("textureDimensions(t{index}, level)"),
                &format!("textureLoad(t{index}, xy, layer, level)"),
            )
        }
        Class::Texture(_, true) => {
            let levels = "let level = 0u; for (var layer = 0u; layer < 4u; layer++) {";
            parts(levels, &format!("textureDimensions(t{index})"), &format!("textureLoad(t{index}, xy, layer)"))
        }
        Class::Storage(_) => {
            let levels =
                format!("let level = 0u; for (var layer = 0u; layer < textureNumLayers(t{index}); layer++) {{");
            parts(&levels, &format!("textureDimensions(t{index})"), &format!("textureLoad(t{index}, xy, layer)"))
        }
        Class::Buffer => looked(&format!("arrayLength(&t{index})"), &format!("      hash = fold(hash, t{index}[at]);")),
        Class::Uniform => looked("16u", &format!("      hash = fold(hash, t{index}[at / 4u][at % 4u]);")),
        Class::SamePixel(..) | Class::InTile(..) => String::new(),
    };
    format!("fn input{index}(start: u32) -> u32 {{\n  var hash = start;\n{body}\n  return hash;\n}}\n")
}

/// Generates the statement that adds one same-pixel read to a hash.
fn same_pixel(numeric: Numeric, samples: bool, in_tile: bool, index: usize, list: usize) -> String {
    let load = match (in_tile, samples) {
        (true, _) => format!("textureLoad(t{index}, vec2i(0), 0)"),
        (_, true) => format!("textureLoad(t{index}, at, 0)"),
        _ => format!("textureLoad(t{index}, at, min(layer, textureNumLayers(t{index}) - 1u), 0)"),
    };
    let codes = match numeric {
        Numeric::Float => format!("code({load}, {list}u)"),
        Numeric::Depth => format!("vec4u(u32(round({load} * 65536.0)), 0u, 0u, 0u)"),
        Numeric::Uint | Numeric::Stencil => format!("vec4u({load}.x, 0u, 0u, 0u)"),
    };
    format!("  hash = fold4(hash, {codes});\n")
}

/// Generates the statements that write a storage texture or buffer. `index` and `stride` are those of the invocation.
fn stores(out: Out, digest: &str) -> String {
    match out {
        Out::Texture(format) => {
            let value = if format == Format::R32Uint { "codes" } else { "vec4f(codes) / params.scale" };
            format!(
                "  let size = textureDimensions(out);
  for (var layer = 0u; layer < textureNumLayers(out); layer++) {{
    for (var i = index; i < size.x * size.y; i += stride) {{
      let xy = vec2u(i % size.x, i / size.x);
      if chosen(params.tag + layer, xy.x, xy.y) {{
        let codes = painted(texel_hash({digest}, params.tag + layer, xy.x, xy.y));
        textureStore(out, xy, layer, {value});
      }}
    }}
  }}"
            )
        }
        Out::Buffer => format!(
            "  for (var i = index; i < arrayLength(&out); i += stride) {{
    if written(i) {{ out[i] = word({digest}, i); }}
  }}"
        ),
        _ => String::new(),
    }
}

fn compute(out: Out) -> String {
    let stores = stores(out, "hash");
    format!(
        "@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
        @builtin(local_invocation_index) index: u32) {{
  if any(group != vec3u(0u)) {{ return; }}
  let plain = digest();
  if index == 0u {{ witness[params.witness] = plain; }}
  var hash = plain;
  if params.indirect != 0u {{ hash = mix(mix(mix(hash, groups.x), groups.y), groups.z); }}
  let stride = 64u;
{stores}
}}
"
    )
}

fn raster(out: Out, layered: bool) -> String {
    let (returns, body) = match out {
        Out::Nothing => (String::new(), String::new()),
        Out::Color(slot, numeric) => {
            let (kind, value) = match numeric {
                Numeric::Uint => ("vec4u", "codes"),
                _ => ("vec4f", "vec4f(codes) / params.scale"),
            };
            let body = format!(
                "  if !chosen(tag, at.x, at.y) {{ discard; }}
  let codes = painted(with_same(texel_hash(in.digest, tag, at.x, at.y), at, layer));
  return {value};"
            );
            (format!(" -> @location({slot}) {kind}"), body)
        }
        Out::Depth => {
            let body = "  if !chosen(tag, at.x, at.y) { discard; }
  return f32(painted(with_same(texel_hash(in.digest, tag, at.x, at.y), at, layer)).x) / 65536.0;";
            (" -> @builtin(frag_depth) f32".into(), body.into())
        }
        Out::Stencil => {
            let body = "  let hash = with_same(texel_hash(in.digest, tag, at.x, at.y), at, layer);
  if !chosen(tag, at.x, at.y) || (hash & 3u) != params.wanted { discard; }";
            (String::new(), body.into())
        }
        Out::Texture(_) | Out::Buffer => {
            let stores = stores(out, "in.plain");
            let body = format!(
                "  let index = at.y * params.extent.x + at.x;
  let stride = params.extent.x * params.extent.y;
{stores}"
            );
            (String::new(), body)
        }
    };
    let (view, layer) = if layered { (", @builtin(view_index) view: u32", "u32(view)") } else { ("", "0u") };
    format!(
        "struct Varying {{
  @builtin(position) at: vec4f,
  @location(0) @interpolate(flat) digest: u32,
  @location(1) @interpolate(flat) plain: u32,
}}
@vertex fn vs_main(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> Varying {{
  let corner = vertex % 3u;
  let plain = digest();
  var hash = plain;
  if params.indirect != 0u {{ hash = mix(mix(hash, instance), vertex); }}
  return Varying(vec4f(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, params.z, 1.0), hash, plain);
}}
@fragment fn fs_main(in: Varying{view}){returns} {{
  let at = vec2u(in.at.xy);
  let layer = {layer};
  let tag = params.tag + layer;
  if all(at == vec2u(0u)) {{ witness[params.witness] = in.plain; }}
  // Every binding must be used.
  if in.plain == 0u && with_same(in.digest, at, layer) == 1u {{ discard; }}
{body}
}}
"
    )
}
