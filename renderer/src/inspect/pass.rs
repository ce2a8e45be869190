//! The pass that an inspection adds. It reads a texture of any format, plane or sample count. The bits are written to a
//! texture that can be read back.

use crate::execute::cx::Cx;
use crate::execute::error::RecordError;
use crate::pipelines::shader::Shader;
use crate::pipelines::state::Raster;
use framegraph::{
    Aspect, DeclareError, Dimension, Extent, Format, Graph, Intent, Numeric, PassId, ReadOnly, Texture, TextureDesc,
    View,
};

/// Format of the result: four 32-bit integers per texel, which drivers do not alter.
const BITS: Format = Format::Rgba32Uint;

/// Part to read, with all defaults resolved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) desc: TextureDesc,
    pub(super) mip: u8,
    pub(super) layer: u16,
    pub(super) aspect: Aspect,
    pub(super) sample: Option<u8>,
}

/// Inspection pass after its declaration.
#[derive(Clone, Copy, Debug)]
pub(super) struct InspectionPass {
    pub(super) pass: PassId,
    pub(super) view: View,
    pub(super) out: Texture,
    pub(super) size: [u32; 2],
}

impl Part {
    /// Declares the pass at the end of `graph`.
    ///
    /// # Errors
    /// Fails if the graph rejects the read.
    pub(super) fn declare(
        &self,
        graph: &mut Graph,
        target: ReadOnly,
        frame: [u32; 2],
    ) -> Result<InspectionPass, DeclareError> {
        let [width, height] = self.desc.mip_extent(frame, self.mip.into());
        let out = graph.texture("inspection", TextureDesc::new(Extent::absolute(width, height), BITS));
        let level = target.mip(self.mip).aspect(self.aspect);
        let target = if self.desc.dimension == Dimension::D3 { level } else { level.layer(self.layer) };
        let (view, out) = graph.add_fn("inspection", |pass| {
            pass.never_merge();
            Ok((pass.sampled(target)?, pass.color(out, Intent::Overwrite)?))
        })?;
        graph.readback(out)?;
        let pass = graph.pass_ids().next_back().unwrap_or_default();
        Ok(InspectionPass { pass, view, out, size: [width, height] })
    }

    /// Returns whether samples can be averaged.
    fn averages(&self) -> bool {
        self.desc.format.numeric() == Numeric::Float
    }

    /// Generates the shader that reads this part.
    fn wgsl(&self) -> String {
        let Self { desc, layer, aspect, sample, .. } = *self;
        let (scalar, depth) = match desc.format.numeric() {
            Numeric::Depth if aspect == Aspect::Stencil || !desc.format.has_depth() => ("u32", false),
            Numeric::Depth => ("f32", true),
            Numeric::Float => ("f32", false),
            Numeric::Uint => ("u32", false),
            Numeric::Sint => ("i32", false),
        };
        let texture = match (desc.dimension, desc.samples, depth) {
            (Dimension::D3, ..) => format!("texture_3d<{scalar}>"),
            (_, 1, false) => format!("texture_2d<{scalar}>"),
            // Bound as a float texture, since OpenGL shaders cannot load texels of depth textures.
            (_, 1, true) => "texture_2d<f32>".to_owned(),
            (_, _, false) => format!("texture_multisampled_2d<{scalar}>"),
            (_, _, true) => "texture_depth_multisampled_2d".to_owned(),
        };
        let load = |last: &str| format!("textureLoad(source, at, {last})");
        let value = match (desc.dimension, desc.samples, sample) {
            (Dimension::D3, ..) => format!("textureLoad(source, vec3u(at, {layer}u), 0)"),
            (_, 1, _) if depth => format!("{}.x", load("0")),
            (_, 1, _) => load("0"),
            (_, samples, None) if self.averages() => {
                let all: Vec<String> = (0..samples).map(|s| load(&s.to_string())).collect();
                format!("({}) / {samples}.0", all.join(" + "))
            }
            (_, _, sample) => load(&sample.unwrap_or(0).to_string()),
        };
        // Single-channel textures are read as (x, 0, 0, 1). Depth is converted to the same form.
        let bits = if depth { "vec4f(value, 0.0, 0.0, 1.0)" } else { "value" };
        format!(
            "@group(0) @binding(0) var source: {texture};
             @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {{
               return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.5, 1.0);
             }}
             @fragment fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4u {{
               let at = vec2u(position.xy);
               let value = {value};
               return bitcast<vec4u>({bits});
             }}"
        )
    }

    /// Records the pass.
    ///
    /// # Errors
    /// Fails if the device rejects a call.
    pub(super) fn record(&self, inspection: &InspectionPass, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let text = self.wgsl();
        let pipeline = cx.raster_pipeline(&Raster::new(Shader::new("inspection", &text)))?;
        let view = cx.view(inspection.view)?;
        let group = cx.bind_group(pipeline.group(0), &[(0, view.into())]);
        let pass = cx.render_pass()?;
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }
}
