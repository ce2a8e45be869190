//! Shaders of mock recorders. Each texel gets a value computed from the pass's name, the position and all inputs.

use super::bind::{BindingKind, Bindings, TextureBinding, WORKGROUP};
use crate::execute::cx::Cx;
use framegraph::{Access, AccessKind, Dimension, Numeric};
use std::fmt::Write;
use wgpu::StorageTextureAccess;

/// Integers stay below 256, so that they are exact in every format.
const COMMON: &str = "
fn from_depth(depth: f32) -> vec4f { return vec4f(depth); }
fn from_uint(texel: vec4u) -> vec4f { return vec4f(texel & vec4u(255)) / 255.0; }
fn from_sint(texel: vec4i) -> vec4f { return vec4f(texel & vec4i(127)) / 127.0; }
fn as_uint(value: vec4f) -> vec4u { return vec4u(value * 100.0); }
fn as_sint(value: vec4f) -> vec4i { return vec4i(value * 100.0); }
";

/// Returns a number in 0…1 derived from the name.
fn share(name: &str, salt: u8) -> f32 {
    let hash =
        name.bytes().chain([salt]).fold(0x811c_9dc5u32, |hash, b| (hash ^ u32::from(b)).wrapping_mul(16_777_619));
    (hash >> 8) as f32 / 16_777_216.0
}

/// Generates declarations of all bindings and the function `value(at, salt)`. `at` is the position in the target, 0…1
/// on both axes.
fn common(name: &str, bindings: &Bindings) -> String {
    let mut text = String::from(COMMON);
    let mut sum = String::new();
    for (number, what) in bindings.what.iter().enumerate() {
        let declared = match what {
            BindingKind::Fetched(shape) => {
                fetch(&mut text, number, shape);
                format!("var source{number}: {};", shape.fetched().0)
            }
            BindingKind::Loaded(shape) => {
                load(&mut text, number, shape);
                format!("var source{number}: {};", shape.stored(StorageTextureAccess::ReadOnly).0)
            }
            BindingKind::Stored(shape) => {
                format!("var target{number}: {};", shape.stored(StorageTextureAccess::WriteOnly).0)
            }
            BindingKind::Uniform(floats) => {
                let ty = ["f32", "f32", "vec2f", "vec3f", "vec4f"][*floats as usize];
                let first = if *floats < 2 { "" } else { ".x" };
                reads(&mut text, number, &format!("vec4f(source{number}{first})"));
                format!("var<uniform> source{number}: {ty};")
            }
            BindingKind::Read => {
                let index = format!("u32(at.x * 4096.0) % arrayLength(&source{number})");
                reads(&mut text, number, &format!("vec4f(source{number}[{index}])"));
                format!("var<storage, read> source{number}: array<f32>;")
            }
            BindingKind::Written => format!("var<storage, read_write> target{number}: array<f32>;"),
        };
        push(&mut text, &format!("@group(0) @binding({number}) {declared}\n"));
        if !matches!(what, BindingKind::Stored(_) | BindingKind::Written) {
            // Weights differ, so that swapped inputs change the result.
            let weight = 0.25 + 0.5 * share(name, number as u8 + 1);
            push(&mut sum, &format!("  sum += {weight:.6} * read{number}(at);\n"));
        }
    }
    let (a, b) = (share(name, 0), share(name, 255));
    push(
        &mut text,
        &format!(
            "fn value(at: vec2f, salt: f32) -> vec4f {{
  var sum = vec4f({a:.6} + 0.5 * at.x, {b:.6} + 0.5 * at.y, salt + at.x * at.y, {a:.6});
{sum}  return fract(sum);
}}
"
        ),
    );
    text
}

/// Generates a function that returns `value` for binding `number`, independent of `at`.
fn reads(text: &mut String, number: usize, value: &str) {
    push(text, &format!("fn read{number}(at: vec2f) -> vec4f {{ return {value}; }}\n"));
}

/// Generates a function that sums the texels at `at` over all levels and layers.
fn fetch(text: &mut String, number: usize, shape: &TextureBinding) {
    let (_, floats) = shape.fetched();
    let source = format!("source{number}");
    let texel = "min(vec2u(at * vec2f(size)), size - 1u)";
    let body = if shape.dimension == Dimension::D3 {
        format!(
            "let size = textureDimensions({source}); let texel = min(vec3u(vec3f(at, 0.5) * vec3f(size)), size - 1u);
  return {floats}(textureLoad({source}, texel, 0));"
        )
    } else if shape.samples > 1 {
        let load = |sample: u8| format!("{floats}(textureLoad({source}, texel, {sample}))");
        let all: Vec<String> = (0..shape.samples).map(load).collect();
        format!("let size = textureDimensions({source}); let texel = {texel};\n  return {};", all.join(" + "))
    } else if shape.levels == 1 && shape.layers == 1 {
        // Loops that run once take Mesa's compiler minutes if a shader has many of them.
        format!(
            "let size = textureDimensions({source}, 0); let texel = {texel};\n  return {floats}(textureLoad({source}, texel, 0));"
        )
    } else {
        let (layers, layer) = if shape.layers > 1 { (shape.layers, "layer, ") } else { (1, "") };
        format!(
            "var sum = vec4f();
  for (var layer = 0; layer < {layers}; layer++) {{
    for (var level = 0u; level < textureNumLevels({source}); level++) {{
      let size = textureDimensions({source}, level); let texel = {texel};
      sum += {floats}(textureLoad({source}, texel, {layer}level));
    }}
  }}
  return sum;"
        )
    };
    push(text, &format!("fn read{number}(at: vec2f) -> vec4f {{\n  {body}\n}}\n"));
}

/// Generates a function that loads the texel at `at` from a storage texture.
fn load(text: &mut String, number: usize, shape: &TextureBinding) {
    let source = format!("source{number}");
    let floats = match shape.format.numeric() {
        Numeric::Uint => "from_uint",
        Numeric::Sint => "from_sint",
        Numeric::Float | Numeric::Depth => "vec4f",
    };
    let body = match (shape.dimension, shape.layers) {
        (Dimension::D3, _) => format!(
            "let size = textureDimensions({source}); let texel = min(vec3u(vec3f(at, 0.5) * vec3f(size)), size - 1u);
  return {floats}(textureLoad({source}, texel));"
        ),
        (_, layers) => {
            let layer = if layers > 1 { ", 0" } else { "" };
            format!(
                "let size = textureDimensions({source}); let texel = min(vec2u(at * vec2f(size)), size - 1u);
  return {floats}(textureLoad({source}, texel{layer}));"
            )
        }
    };
    push(text, &format!("fn read{number}(at: vec2f) -> vec4f {{\n  {body}\n}}\n"));
}

/// Generates stores to all storage bindings. `texel` is the invocation's position and `all_texels` the size of the
/// dispatch.
fn stores(bindings: &Bindings, level: u32) -> String {
    let mut text = String::new();
    for (number, what) in bindings.what.iter().enumerate() {
        let target = format!("target{number}");
        match what {
            BindingKind::Stored(shape) => {
                let (_, texel) = shape.stored(StorageTextureAccess::WriteOnly);
                let value = format!("value((vec2f(texel) + 0.5) / vec2f(size), {level}.0 * 0.1 + f32(layer) * 0.01)");
                let value = match texel {
                    "vec4u" => format!("as_uint({value})"),
                    "vec4i" => format!("as_sint({value})"),
                    _ => value,
                };
                let (size, layers, place) = match (shape.dimension, shape.layers) {
                    (Dimension::D3, _) => (
                        format!("textureDimensions({target}).xy"),
                        format!("textureDimensions({target}).z"),
                        "vec3u(texel, layer)",
                    ),
                    (_, 1) => (format!("textureDimensions({target})"), "1u".into(), "texel"),
                    _ => (format!("textureDimensions({target})"), format!("textureNumLayers({target})"), "texel, layer"),
                };
                push(
                    &mut text,
                    &format!(
                        "  {{ let size = {size};
    if all(texel < size) {{
      for (var layer = 0u; layer < {layers}; layer++) {{ textureStore({target}, {place}, {value}); }}
    }} }}\n"
                    ),
                );
            }
            BindingKind::Written => push(
                &mut text,
                &format!(
                    "  for (var i = texel.y * all_texels.x + texel.x; i < arrayLength(&{target}); i += all_texels.x * all_texels.y) {{
    {target}[i] = value(vec2f(fract(f32(i) / 97.0), 0.5), 0.0).x;
  }}\n"
                ),
            ),
            _ => {}
        }
    }
    text
}

/// Generates the shader of a raster pass.
pub(super) fn raster_wgsl(cx: &Cx<'_>, own: &[Access], bindings: &Bindings, whole: bool) -> String {
    let name = cx.pass_name();
    let [width, height] = cx.targets().extent;
    let mut text = common(name, bindings);
    // Depth differs between passes and is neither 0 nor 1.
    let (reach, depth) = (if whole { "4.0" } else { "2.0" }, 0.1 + 0.8 * share(name, 7));
    let (mut outputs, mut values) = (String::new(), String::new());
    for access in own.iter().filter(|a| a.kind == AccessKind::Color) {
        let slot = access.slot;
        let Some(format) = cx.targets().colors[usize::from(slot)] else { continue };
        let (ty, convert) = match format.numeric() {
            Numeric::Uint => ("vec4u", "as_uint"),
            Numeric::Sint => ("vec4i", "as_sint"),
            Numeric::Float | Numeric::Depth => ("vec4f", "vec4f"),
        };
        push(&mut outputs, &format!("  @location({slot}) color{slot}: {ty},\n"));
        push(&mut values, &format!("  out.color{slot} = {convert}(value(at, {slot}.0 * 0.05));\n"));
    }
    let (returns, out, result) = if outputs.is_empty() {
        // Unused bindings would be removed from the shader's layout.
        ("", "", "  if value(at, 0.0).x < -1.0 { discard; }\n")
    } else {
        push(&mut text, &format!("struct Out {{\n{outputs}}}\n"));
        (" -> Out", "  var out: Out;\n", "  return out;\n")
    };
    let stored = stores(bindings, 0);
    push(
        &mut text,
        &format!(
            "@vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {{
  return vec4f(f32(i & 1) * {reach} - 1.0, f32(i >> 1) * {reach} - 1.0, {depth:.6}, 1.0);
}}
@fragment fn fs_main(@builtin(position) position: vec4f){returns} {{
  let all_texels = vec2u({width}, {height});
  let texel = vec2u(position.xy);
  let at = position.xy / vec2f(all_texels);
{out}{values}{stored}{result}}}
"
        ),
    );
    text
}

/// Generates the shader of a compute pass that writes mip level `level` of its storage textures.
pub(super) fn compute_wgsl(name: &str, bindings: &Bindings, level: u32) -> String {
    let mut text = common(name, bindings);
    let [width, height] = bindings.extent.map(|side| side.next_multiple_of(WORKGROUP));
    let stored = stores(bindings, level);
    push(
        &mut text,
        &format!(
            "@compute @workgroup_size({WORKGROUP}, {WORKGROUP}) fn main(@builtin(global_invocation_id) id: vec3u) {{
  let all_texels = vec2u({width}, {height});
  let texel = id.xy;
{stored}}}
"
        ),
    );
    text
}

fn push(text: &mut String, more: &str) {
    let written = text.write_str(more);
    // Writing to a string does not fail.
    debug_assert!(written.is_ok());
}
