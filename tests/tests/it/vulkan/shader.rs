//! Shaders that perform the declared accesses of a pass: they read and write its resources.

use crate::vulkan::device::Trouble;
use ash::vk;
use framegraph::{
    Access, AccessKind, Aspect, Dimension, Numeric, PassId, PassKind, Plan, Range, ResourceId, TextureDesc,
};
use naga::back::spv;
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// Resource and subresource of a binding.
#[derive(Clone, Debug)]
pub struct Bound {
    pub kind: vk::DescriptorType,
    pub resource: ResourceId,
    /// Exactly the accessed levels, layers and planes, or bytes.
    pub range: Range,
    /// True for an array view, even of one layer.
    pub arrayed: bool,
}

/// A shader with its bindings; binding numbers are indices.
#[derive(Debug)]
pub struct PassShader {
    pub text: String,
    pub bound: Vec<Bound>,
}

/// Creates the shader of a raster or compute pass. `colors` has the formats of the step's color attachments by slot.
pub fn shader(plan: &Plan, pass: PassId) -> Result<PassShader, Trouble> {
    let (graph, kind) = (plan.graph(), plan.graph().passes()[pass.index()].kind);
    let mut shader = PassShader { text: String::new(), bound: Vec::new() };
    let (mut reads, mut writes, mut outputs, mut colors, mut vertices) =
        (String::new(), String::new(), String::new(), String::new(), false);
    for access in graph.accesses_of(pass) {
        let desc = graph.resources()[access.resource.index()].desc;
        match (access.kind, desc.texture()) {
            (AccessKind::Color, _) => {
                let format = plan.format(access.resource).ok_or("a color without a format")?;
                let (ty, value) = match format.numeric() {
                    Numeric::Uint => ("vec4u", "vec4u(u32(sum))"),
                    Numeric::Sint => ("vec4i", "vec4i(i32(sum))"),
                    _ => ("vec4f", "vec4f(sum)"),
                };
                let slot = access.slot;
                outputs += &format!("@location({slot}) c{slot}: {ty}, ");
                colors += &format!("out.c{slot} = {value}; ");
            }
            (AccessKind::Vertex, _) => vertices = true,
            (AccessKind::Sampled | AccessKind::SamePixel, Some(texture)) => {
                let number = shader.bound.len();
                let (ty, read) = sampled(plan, access, texture, number)?;
                shader.text += &format!("@group(0) @binding({number}) var t{number}: {ty};\n");
                reads += &format!("sum += {read};\n");
                shader.bound.push(Bound {
                    kind: vk::DescriptorType::SAMPLED_IMAGE,
                    resource: access.resource,
                    range: access.range,
                    arrayed: layers(access, texture) > 1,
                });
            }
            (AccessKind::StorageRead | AccessKind::StorageWrite, Some(texture)) => {
                // A storage texture view has one level.
                for mip in access.range.mip_range(texture.mip_count(plan.frame())) {
                    let (number, written) = (shader.bound.len(), access.kind == AccessKind::StorageWrite);
                    let (ty, at, value) = stored(plan, access, texture, written);
                    shader.text += &format!("@group(0) @binding({number}) var t{number}: {ty};\n");
                    match written {
                        true => writes += &format!("textureStore(t{number}, {at}, {value});\n"),
                        false => reads += &format!("sum += f32(textureLoad(t{number}, {at}).x);\n"),
                    }
                    shader.bound.push(Bound {
                        kind: vk::DescriptorType::STORAGE_IMAGE,
                        resource: access.resource,
                        range: Range { mip: mip as u8, mips: 1, ..access.range },
                        arrayed: layers(access, texture) > 1,
                    });
                }
            }
            (AccessKind::StorageRead | AccessKind::StorageWrite | AccessKind::Uniform, None) => {
                let number = shader.bound.len();
                let (space, ty) = match access.kind {
                    AccessKind::Uniform => ("uniform", "vec4f"),
                    AccessKind::StorageRead => ("storage, read", "array<u32>"),
                    _ => ("storage, read_write", "array<u32>"),
                };
                shader.text += &format!("@group(0) @binding({number}) var<{space}> t{number}: {ty};\n");
                match access.kind {
                    AccessKind::StorageWrite => writes += &format!("t{number}[0] = u32(sum) & 0u;\n"),
                    AccessKind::Uniform => reads += &format!("sum += t{number}.x;\n"),
                    _ => reads += &format!("sum += f32(t{number}[0]);\n"),
                }
                let kind = match access.kind {
                    AccessKind::Uniform => vk::DescriptorType::UNIFORM_BUFFER,
                    _ => vk::DescriptorType::STORAGE_BUFFER,
                };
                shader.bound.push(Bound { kind, resource: access.resource, range: access.range, arrayed: false });
            }
            _ => {}
        }
    }
    shader.text += &match kind {
        PassKind::Compute => format!("@compute @workgroup_size(1) fn main() {{ var sum = 0.0;\n{reads}{writes}}}\n"),
        _ => raster(&reads, &writes, &outputs, &colors, vertices),
    };
    Ok(shader)
}

fn raster(reads: &str, writes: &str, outputs: &str, colors: &str, vertices: bool) -> String {
    let (input, shift) = if vertices { (", @location(0) v: f32", "v * 0.0") } else { ("", "0.0") };
    let (declared, returned, made, done) = match outputs.is_empty() {
        true => (String::new(), "", "", "if sum < -1.0e30 { discard; }"),
        false => (format!("struct Out {{ {outputs} }}\n"), " -> Out", "var out: Out;", "return out;"),
    };
    format!(
        "{declared}@vertex fn vs(@builtin(vertex_index) i: u32{input}) -> @builtin(position) vec4f {{
  return vec4f(f32(i & 1) * 4.0 - 1.0 + {shift}, f32(i >> 1) * 4.0 - 1.0, 0.5, 1.0);
}}
@fragment fn fs(){returned} {{ var sum = 0.0; {made}\n{reads}{writes}{colors}{done} }}\n"
    )
}

/// Returns the number of layers of an access; 1 for three-dimensional textures.
pub fn layers(access: &Access, texture: &TextureDesc) -> u32 {
    match texture.dimension {
        Dimension::D2 => access.range.layer_range(texture.layers.into()).len() as u32,
        Dimension::D3 => 1,
    }
}

fn sampled(plan: &Plan, access: &Access, texture: &TextureDesc, number: usize) -> Result<(String, String), Trouble> {
    let format = plan.format(access.resource).unwrap_or(texture.format);
    let (scalar, depth) = match format.numeric() {
        Numeric::Depth if access.range.aspect == Aspect::Stencil || !format.has_depth() => ("u32", false),
        Numeric::Depth => ("", true),
        Numeric::Float => ("f32", false),
        Numeric::Uint => ("u32", false),
        Numeric::Sint => ("i32", false),
    };
    let array = layers(access, texture) > 1;
    let (suffix, of) = (if array { "_array" } else { "" }, if depth { String::new() } else { format!("<{scalar}>") });
    let (ty, at) = match (texture.dimension, texture.samples, depth) {
        (Dimension::D3, ..) => ("texture_3d".to_owned(), "vec3u(0)"),
        (_, 1, false) => (format!("texture_2d{suffix}"), if array { "vec2u(0), 0" } else { "vec2u(0)" }),
        (_, 1, true) => (format!("texture_depth_2d{suffix}"), if array { "vec2u(0), 0" } else { "vec2u(0)" }),
        _ if array => return Err("several layers of samples cannot be sampled".into()),
        (_, _, false) => ("texture_multisampled_2d".to_owned(), "vec2u(0)"),
        (_, _, true) => ("texture_depth_multisampled_2d".to_owned(), "vec2u(0)"),
    };
    let first = if depth { "" } else { ".x" };
    Ok((ty + &of, format!("f32(textureLoad(t{number}, {at}, 0){first})")))
}

/// Returns the type of a storage texture, a coordinate in it, and a value to store.
fn stored(plan: &Plan, access: &Access, texture: &TextureDesc, written: bool) -> (String, &'static str, &'static str) {
    let format = plan.format(access.resource).unwrap_or(texture.format);
    let word = if written { "write" } else { "read" };
    let (dimension, at) = match (texture.dimension, layers(access, texture)) {
        (Dimension::D3, _) => ("3d", "vec3u(0)"),
        (_, 1) => ("2d", "vec2u(0)"),
        _ => ("2d_array", "vec2u(0), 0"),
    };
    let value = match format.numeric() {
        Numeric::Uint => "vec4u(u32(sum))",
        Numeric::Sint => "vec4i(i32(sum))",
        _ => "vec4f(sum)",
    };
    (format!("texture_storage_{dimension}<{}, {word}>", format!("{format:?}").to_lowercase()), at, value)
}

/// Compiles a WGSL text to SPIR-V.
pub fn spirv(text: &str) -> Result<Vec<u32>, Trouble> {
    let module = naga::front::wgsl::parse_str(text).map_err(|e| format!("{}\n{text}", e.emit_to_string(text)))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::all())
        .validate(&module)
        .map_err(|e| format!("{}\n{text}", e.emit_to_string(text)))?;
    // The vertical flip of clip space is irrelevant here.
    let options = spv::Options { lang_version: (1, 3), flags: spv::WriterFlags::empty(), ..spv::Options::default() };
    Ok(spv::write_vec(&module, &info, &options, None).map_err(|e| format!("{e}\n{text}"))?)
}
