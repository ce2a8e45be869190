//! The pass that estimates ambient occlusion.

use super::settings::{Method, OcclusionSettings};
use crate::full_screen::FullScreen;
use crate::precision::Precision;
use crate::program::{Interface, ProgramDesc, Programs};
use crate::view::{CameraView, ViewId, Views};
use framegraph::{DeclareError, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_shaders::layout::{OcclusionUniforms, Projection};
use framegraph_shaders::{Feature, Features, Module, library};
use framegraph_wgpu::{Cx, Record, RecordError};
use glam::{DMat4, Vec2};
use std::f32::consts::TAU;

/// Format of visibility: half floats, since steps of 1/255 show where the dark is brightened.
pub(super) const VISIBILITY_FORMAT: Format = Format::R16Float;

static SHADER: Module<'static> = library::pass("pass/occlusion.wgsl").unwrap();

static INTERFACE: Interface =
    Interface { groups: &[&["settings", "structure"]], constants: &["FINE_NORMALS", "EXACT_TAPS"] };

/// Estimates ambient occlusion from the structure of a view. Of the world it needs [`Programs`] and the view's camera.
#[derive(Clone, Copy, Debug)]
pub struct AmbientOcclusion {
    /// The view whose structure it is.
    pub view: ViewId,
    /// Reversed depth as a pyramid, all levels written; the result gets the size of its first.
    pub structure: Texture,
    /// How.
    pub settings: OcclusionSettings,
    /// The numbers that taps are weighted in; positions are f32 in either.
    pub precision: Precision,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct AmbientOcclusionIo {
    structure: View,
    levels: u8,
    /// Visibility, 0 to 1, in red.
    pub occlusion: Texture,
}

impl Pass for AmbientOcclusion {
    type Io = AmbientOcclusionIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<AmbientOcclusionIo, DeclareError> {
        let TextureDesc { extent, mips: levels, .. } = pass.desc(self.structure)?;
        let structure = pass.sampled(self.structure)?;
        let occlusion = pass.texture("occlusion", TextureDesc::new(extent, VISIBILITY_FORMAT));
        Ok(AmbientOcclusionIo { structure, levels, occlusion: pass.color(occlusion, Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + AsRef<Views> + ?Sized> Record<W> for AmbientOcclusion {
    fn record(&self, io: &AmbientOcclusionIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        self.precision.check(cx.gpu()).map_err(crate::PassError::from)?;
        let views: &Views = world.as_ref();
        let texels = cx.targets().extent;
        let settings = self.uniforms(&views.get(self.view)?.view, texels, io.levels);
        let provided = [Some(cx.uniform(&settings)), Some(cx.view(io.structure)?.into())];
        let features = Features::NONE.with_if(Feature::HALF, self.precision == Precision::Half);
        let program =
            ProgramDesc { fragment: Some("fs_sao"), features: &features, ..ProgramDesc::new(&SHADER, &INTERFACE) };
        let constants = [self.settings.fine_normals, self.settings.exact_taps].map(f64::from);
        FullScreen { constants: &constants, ..FullScreen::new(program, &[&provided]) }.draw(world.as_ref(), cx)
    }
}

impl AmbientOcclusion {
    /// The settings as the shader reads them, for a structure of so many texels and levels.
    fn uniforms(&self, view: &CameraView, [width, height]: [u32; 2], levels: u8) -> OcclusionUniforms {
        let settings = &self.settings;
        let projection = projection(view);
        // Along the axis that shows more of the world, as Filament has it.
        let texels_per_m = 0.5 * (projection.scale.x * width as f32).min(projection.scale.y * height as f32);
        let Method::Sao { taps, turns } = settings.method;
        let per_tap = 1.0 / (taps as f32 - 0.5);
        OcclusionUniforms {
            projection,
            radius_m: settings.radius_m,
            radius_texels: texels_per_m * settings.radius_m,
            most_texels: 0.25 * height as f32,
            bias: settings.bias,
            intensity: settings.intensity,
            power: settings.power,
            min_sin2: settings.min_horizon_rad.sin().powi(2),
            last_level: i32::from(levels) - 1,
            tap_rotation: Vec2::from_angle(TAU * turns as f32 * per_tap),
            taps: taps as f32,
            per_tap,
        }
    }
}

/// The projection of a view.
pub(super) fn projection(view: &CameraView) -> Projection {
    let [clip_from_world, world_from_view]: [DMat4; 2] =
        [view.frame.clip_from_world, view.frame.world_from_view].map(|m| m.as_dmat4());
    Projection::new(&(clip_from_world * world_from_view))
}
