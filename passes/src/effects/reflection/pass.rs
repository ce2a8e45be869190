//! The pass that traces reflected rays.

use super::settings::ReflectionSettings;
use crate::gpu_scene::draw::{SurfaceDraw, SurfaceVariant};
use crate::gpu_scene::upload::{GpuScene, MATERIAL_BINDINGS};
use crate::gpu_scene::view::{CameraView, ViewId, Views};
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{ClearValue, DeclareError, Format, Intent, Pass, PassBuilder, Previous, Texture, TextureDesc, View};
use framegraph_shaders::layout::ReflectionUniforms;
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Binding, Cx, Depth, Record, RecordError, SamplerDesc};

/// Format of reflections: pre-exposed radiance, and its weight in alpha.
const REFLECTION_FORMAT: Format = Format::Rgba16Float;

static SHADER: Module<'static> = library::pass("pass/reflection.wgsl").unwrap();

static INTERFACE: Interface = Interface {
    groups: &[
        &["frame", "settings", "structure", "earlier", "earlier_sampler", "depth_bounds"],
        &MATERIAL_BINDINGS,
        &["objects", "origins"],
    ],
    constants: &[SurfaceDraw::TRAITS],
};

/// Traces the reflected ray of each pixel of opaque and masked surfaces through the structure of a view. Positions and
/// depths are always `f32`, regardless of [`Precision`](crate::Precision).
#[derive(Clone, Copy, Debug)]
pub struct Reflection {
    /// View to draw.
    pub view: ViewId,
    /// Reversed depth of the scene; its first level is read.
    pub structure: Texture,
    /// Bounds of that depth ([`DepthBounds`](super::DepthBounds)), with all levels written. Rays then visit every texel
    /// and skip blocks; otherwise they step by [`ReflectionSettings::stride_texels`].
    pub bounds: Option<Texture>,
    /// Depth of the nearest surfaces, with one sample per texel, of which the first level is tested; the result has its
    /// size. May be the structure.
    pub depth: Texture,
    /// Pre-exposed radiance of the previous frame, seen from the previous view ([`CameraView::after`]).
    pub earlier: Previous,
    /// Number of levels of the result.
    pub levels: u8,
    /// Settings.
    pub settings: ReflectionSettings,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct ReflectionIo {
    structure: View,
    bounds: Option<View>,
    bounds_levels: u8,
    earlier: View,
    /// Radiance premultiplied by its weight, and the weight in alpha, with level 0 written. All 0 without a previous
    /// frame.
    pub reflections: Texture,
    /// Hit distances along the rays, in meters.
    pub ways: Texture,
}

impl Pass for Reflection {
    type Io = ReflectionIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<ReflectionIo, DeclareError> {
        let extent = pass.desc(self.depth)?.extent;
        let structure = pass.sampled(self.structure.mip(0))?;
        let earlier = pass.sampled(self.earlier)?;
        let bounds = self.bounds.map(|bounds| pass.sampled(bounds)).transpose()?;
        let bounds_levels = self.bounds.map_or(Ok(0), |bounds| pass.desc(bounds).map(|desc| desc.mips))?;
        pass.depth_read_only(self.depth.mip(0))?;
        let reflections = pass.texture("reflections", TextureDesc::new(extent, REFLECTION_FORMAT).mips(self.levels));
        let nothing = Intent::Clear(ClearValue::Color([0.0; 4]));
        let ways = pass.texture("reflection_hit_distance", TextureDesc::new(extent, Format::R16Float));
        let reflections = pass.color(reflections.mip(0), nothing)?;
        let ways = pass.color(ways, nothing)?;
        Ok(ReflectionIo { structure, bounds, bounds_levels, earlier, reflections, ways })
    }
}

impl<W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized> Record<W> for Reflection {
    fn record(&self, io: &ReflectionIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        if !cx.is_valid(self.earlier)? {
            return Ok(());
        }
        let (views, programs): (&Views, &Programs) = (world.as_ref(), world.as_ref());
        let seen = views.get(self.view)?;
        let frame = [
            Some(cx.uniform(&seen.view.frame)),
            Some(cx.uniform(&self.uniforms(&seen.view, io.bounds_levels))),
            Some(cx.view(io.structure)?.into()),
            Some(cx.view(io.earlier)?.into()),
            Some(cx.sampler(SamplerDesc::LINEAR).into()),
            io.bounds.map(|bounds| cx.view(bounds)).transpose()?.map(Binding::from),
        ];
        let fragment = Some(if io.bounds.is_some() { "fs_blocks" } else { "fs_main" });
        let program = |variant: SurfaceVariant| {
            let features = &variant.vertex_features();
            programs.get(&ProgramDesc { features, fragment, ..ProgramDesc::new(&SHADER, &INTERFACE) })
        };
        let surfaces =
            SurfaceDraw { program: &program, frame: &frame, constants: &[], depth: Depth::EQUAL, colors: &[] };
        let [opaque, masked] = &seen.view.draws.surfaces;
        surfaces.draw(opaque, seen.instances(world.as_ref()), cx)?;
        surfaces.draw(masked, seen.instances(world.as_ref()), cx)
    }
}

impl Reflection {
    fn uniforms(&self, view: &CameraView, bounds_levels: u8) -> ReflectionUniforms {
        let ReflectionSettings { thickness_m, bias_m, reach_m, stride_texels, most_roughness } = self.settings;
        let stand = view.stand();
        let (earlier_clip_from_view, exposure_ratio) = stand.to_earlier(view.earlier);
        ReflectionUniforms {
            projection: stand.projection(),
            earlier_clip_from_view,
            thickness_m,
            bias_m,
            reach_m,
            stride: stride_texels,
            most_roughness,
            exposure_ratio,
            bounds_levels: bounds_levels.into(),
            ..ReflectionUniforms::default()
        }
    }
}
