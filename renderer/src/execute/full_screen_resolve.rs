//! Resolves that wgpu cannot do in a store operation. A full-screen pass loads the samples and writes the resolved
//! value.

use crate::execute::cx::Cx;
use crate::execute::error::RecordError;
use crate::execute::part::ViewPart;
use crate::named::Named;
use crate::pipelines::shader::Shader;
use crate::pipelines::state::{Depth, Raster};
use framegraph::{Access, Format, Numeric, ResolveMode};
use std::fmt::Write;

const VERTEX: &str = "@vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
  return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
";

/// Draws all resolves of the current step, which contains nothing else.
///
/// # Errors
/// Fails on OpenGL, where wgpu 30 has no multisampled textures that shaders can load from, and if the pipeline is
/// rejected.
pub(crate) fn record(cx: &mut Cx<'_>) -> Result<(), RecordError> {
    let plan = cx.plan();
    let (mut resolves, mut bindings, mut depth) = (Vec::new(), Vec::new(), Depth::NONE);
    for (number, (samples, resolve)) in plan.full_screen_resolves(cx.step).enumerate() {
        if cx.gpu().info().backend == wgpu::Backend::Gl {
            let samples = Named::resource(plan, samples.resource);
            return Err(RecordError::custom(format!(
                "`{samples}` is resolved with mode `{}`, which loads its samples in a shader; wgpu does not support this on OpenGL: \
                 use another backend, or one sample",
                resolve.resolve.word()
            )));
        }
        let format = samples.range.view.or(plan.format(samples.resource)).unwrap_or(Format::Depth32Float);
        resolves.push(Fetched { number, format, slot: resolve.slot, mode: resolve.resolve });
        bindings.push((number as u32, cx.make_view(samples, ViewPart::WHOLE)?.into()));
        depth.write |= resolve.slot == Access::DEPTH;
    }
    let (name, text) = (format!("{}: resolve", cx.pass_name()), wgsl(&resolves));
    let pipeline = cx.raster_pipeline(&Raster { depth, ..Raster::new(Shader::new(&name, &text)) })?;
    let group = cx.bind_group(pipeline.group(0), &bindings);
    let pass = cx.render_pass()?;
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
    Ok(())
}

/// Multisampled input of a resolve shader.
struct Fetched {
    /// `@binding` number.
    number: usize,
    format: Format,
    /// Color slot of the target, or [`Access::DEPTH`].
    slot: u8,
    mode: ResolveMode,
}

impl Fetched {
    /// Returns the WGSL types of the texture and of a texel.
    fn types(&self) -> [&'static str; 2] {
        match self.format.numeric() {
            Numeric::Float => ["texture_multisampled_2d<f32>", "vec4f"],
            Numeric::Uint => ["texture_multisampled_2d<u32>", "vec4u"],
            Numeric::Sint => ["texture_multisampled_2d<i32>", "vec4i"],
            Numeric::Depth => ["texture_depth_multisampled_2d", "f32"],
        }
    }
}

/// Generates the shader for these resolves.
fn wgsl(resolves: &[Fetched]) -> String {
    let (mut variables, mut outputs, mut body) = (String::new(), String::new(), String::new());
    for fetched in resolves {
        let (n, [variable, texel]) = (fetched.number, fetched.types());
        let place = match fetched.slot {
            Access::DEPTH => "@builtin(frag_depth)".to_owned(),
            slot => format!("@location({slot})"),
        };
        let load = |sample: &str| format!("textureLoad(samples{n}, at, {sample})");
        let next = match fetched.mode {
            ResolveMode::Average => format!("out.out{n} + {}", load("i")),
            ResolveMode::Sample0 => format!("out.out{n}"),
            ResolveMode::Min | ResolveMode::Max => {
                let function = if fetched.mode == ResolveMode::Min { "min" } else { "max" };
                format!("{function}(out.out{n}, {})", load("i"))
            }
        };
        let scale = match fetched.mode {
            ResolveMode::Average => format!("  out.out{n} /= f32(textureNumSamples(samples{n}));\n"),
            _ => String::new(),
        };
        // Writing to a string does not fail.
        _ = writeln!(variables, "@group(0) @binding({n}) var samples{n}: {variable};");
        _ = writeln!(outputs, "  {place} out{n}: {texel},");
        _ = write!(
            body,
            "  out.out{n} = {};
  for (var i = 1u; i < textureNumSamples(samples{n}); i++) {{ out.out{n} = {next}; }}
{scale}",
            load("0u")
        );
    }
    format!(
        "{variables}struct Out {{
{outputs}}}
{VERTEX}@fragment fn fs_main(@builtin(position) position: vec4f) -> Out {{
  let at = vec2u(position.xy);
  var out: Out;
{body}  return out;
}}
"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::gpu::Gpu;
    use wgpu::{ShaderModuleDescriptor, ShaderSource};

    #[test]
    fn every_mode_of_every_kind_of_texel_compiles() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::noop()?;
        for format in [Format::Rgba16Float, Format::Rgba8Uint, Format::R32Sint, Format::Depth24PlusStencil8] {
            for mode in ResolveMode::ALL.into_iter().filter(|mode| mode.fits(format)) {
                let slot = if format.has_depth() { Access::DEPTH } else { 3 };
                let first = Fetched { number: 0, format, slot, mode };
                let second = Fetched { number: 1, format: Format::R16Float, slot: 5, mode: ResolveMode::Max };
                let text = wgsl(&[first, second]);
                let source = ShaderSource::Wgsl(text.clone().into());
                let module = || gpu.device.create_shader_module(ShaderModuleDescriptor { label: None, source });
                gpu.guard("a shader", module).map_err(|error| format!("{mode:?}: {error}\n{text}"))?;
            }
        }
        Ok(())
    }
}
