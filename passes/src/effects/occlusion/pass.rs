//! The pass that estimates ambient occlusion.

use super::settings::{ConeTrace, Gtao, Method, Occluders, OcclusionSettings};
use crate::gpu_scene::view::{CameraView, ViewId, Views};
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use crate::settings::precision::Precision;
use framegraph::{DeclareError, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_shaders::layout::{ConeUniforms, OcclusionUniforms};
use framegraph_shaders::{Feature, Features, Module, library};
use framegraph_wgpu::{Cx, Record, RecordError};
use glam::{Vec2, Vec3};
use std::f32::consts::TAU;

/// Format of visibility: half floats, since 8-bit steps show where dark areas are brightened.
const VISIBILITY: Format = Format::R16Float;

/// Format of visibility with bent normals.
const WITH_BENT_NORMALS: Format = Format::Rgba16Float;

static SHADER: Module<'static> = library::pass("pass/occlusion.wgsl").unwrap();

static INTERFACE: Interface = Interface {
    groups: &[&["frame", "settings", "structure"]],
    constants: &["FINE_NORMALS", "EXACT_TAPS", "BITMASK", "SMOOTH_FALLOFF", "BENT_NORMALS", "CONE"],
};

/// Estimates ambient occlusion from the structure of a view. Uses [`Programs`] and the view's camera of the world.
#[derive(Clone, Copy, Debug)]
pub struct AmbientOcclusion {
    /// View of the structure.
    pub view: ViewId,
    /// Reversed depth as a pyramid, with all levels written; the result has the size of its first level.
    pub structure: Texture,
    /// Settings.
    pub settings: OcclusionSettings,
    /// Precision of tap weights; positions are always `f32`.
    pub precision: Precision,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct AmbientOcclusionIo {
    structure: View,
    levels: u8,
    /// Visibility, 0 to 1, in red; the other channels hold the bent normal in world space, if computed.
    pub occlusion: Texture,
}

impl Pass for AmbientOcclusion {
    type Io = AmbientOcclusionIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<AmbientOcclusionIo, DeclareError> {
        let TextureDesc { extent, mips: levels, .. } = pass.desc(self.structure)?;
        let structure = pass.sampled(self.structure)?;
        let format = if self.settings.has_bent_normals() { WITH_BENT_NORMALS } else { VISIBILITY };
        let occlusion = pass.texture("occlusion", TextureDesc::new(extent, format));
        Ok(AmbientOcclusionIo { structure, levels, occlusion: pass.color(occlusion, Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + AsRef<Views> + ?Sized> Record<W> for AmbientOcclusion {
    fn record(&self, io: &AmbientOcclusionIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        self.precision.check(cx.gpu()).map_err(crate::PassError::from)?;
        let views: &Views = world.as_ref();
        let texels = cx.targets().extent;
        let view = &views.get(self.view)?.view;
        let settings = cx.uniform(&self.uniforms(view, texels, io.levels));
        let provided = [cx.uniform(&view.frame), settings, cx.view(io.structure)?.into()].map(Some);
        let features = Features::NONE.with_if(Feature::HALF, self.precision == Precision::Half);
        let (fragment, occluders) = match self.settings.method {
            Method::Sao { .. } => ("fs_sao", None),
            Method::Gtao(Gtao { occluders, .. }) => ("fs_gtao", Some(occluders)),
        };
        let program =
            ProgramDesc { fragment: Some(fragment), features: &features, ..ProgramDesc::new(&SHADER, &INTERFACE) };
        let lit = view.frame.sun_illuminance != Vec3::ZERO;
        let constants = [
            self.settings.fine_normals,
            self.settings.exact_taps,
            matches!(occluders, Some(Occluders::Thick(_))),
            occluders == Some(Occluders::Fading),
            self.settings.has_bent_normals(),
            self.settings.cone.is_some() && lit,
        ]
        .map(f64::from);
        FullScreen { constants: &constants, ..FullScreen::new(program, &[&provided]) }.draw(world.as_ref(), cx)
    }
}

impl AmbientOcclusion {
    /// Returns the uniforms for a structure of this size and number of levels.
    fn uniforms(&self, view: &CameraView, [width, height]: [u32; 2], levels: u8) -> OcclusionUniforms {
        let settings = &self.settings;
        let projection = view.stand().projection();
        // Along the axis that shows more of the world, as in Filament.
        let texels_per_m = 0.5 * (projection.scale.x * width as f32).min(projection.scale.y * height as f32);
        let [mut taps, mut turns] = [1.0, 0.0];
        let mut gtao = Gtao::DEFAULT;
        match settings.method {
            Method::Sao { taps: count, turns: count_turns } => [taps, turns] = [count, count_turns].map(|n| n as f32),
            Method::Gtao(own) => gtao = own,
        }
        let per_tap = 1.0 / (taps - 0.5);
        OcclusionUniforms {
            projection,
            radius_m: settings.radius_m,
            radius_texels: texels_per_m * settings.radius_m,
            most_texels: 0.25 * height as f32,
            bias: settings.bias,
            intensity: settings.intensity,
            // SAO squares the visibility, as in Filament.
            power: settings.power * if matches!(settings.method, Method::Sao { .. }) { 2.0 } else { 1.0 },
            min_sin2: settings.min_horizon_rad.sin().powi(2),
            last_level: i32::from(levels) - 1,
            tap_rotation: Vec2::from_angle(TAU * turns * per_tap),
            taps,
            per_tap,
            slices: gtao.slices as f32,
            steps: gtao.steps as f32,
            step_power: gtao.step_power,
            thickness_m: if let Occluders::Thick(m) = gtao.occluders { m } else { 0.0 },
            cone: cone(settings.cone.unwrap_or(ConeTrace::FILAMENT)),
        }
    }
}

fn cone(of: ConeTrace) -> ConeUniforms {
    let ConeTrace { reach_m, angle_rad, contact_m, bias_m, slope_bias_m, intensity, steps, rays } = of;
    let (tangent, [steps, rays]) = ((0.5 * angle_rad).tan(), [steps, rays].map(|n| n as f32));
    ConeUniforms { reach_m, tangent, contact_m, bias_m, slope_bias_m, intensity, steps, rays }
}
