//! Bindings of surface shading: the interface of the color and sky shaders, and how passes fill it.

use crate::effects::fog::FogSettings;
use crate::effects::shadow::{ShadowBindings, ShadowInput};
use crate::error::PassError;
use crate::gpu_scene::draw::{InstanceSource, SurfaceDraw, SurfaceVariant};
use crate::gpu_scene::lighting::Lighting;
use crate::gpu_scene::punctual::LightLists;
use crate::gpu_scene::upload::{GpuScene, MATERIAL_BINDINGS, features_of};
use crate::gpu_scene::view::{GpuView, ViewId, Views};
use crate::light::shading::{AlphaUse, Shading};
use crate::program::{Interface, Program, ProgramDesc, Programs};
use crate::settings::precision::Precision;
use framegraph::{Format, View};
use framegraph_scene::Lobe;
use framegraph_scene::environment::ShBands;
use framegraph_shaders::{Feature, Features, Module, library};
use framegraph_wgpu::{Binding, Cx, Epilogue, RecordError, SamplerDesc};
use glam::Vec3;
use std::sync::Arc;
use wgpu::AddressMode;

/// Format of pre-exposed radiance: half floats, since the 11 bits of Rg11b10Ufloat tint greys by one 8-bit step.
pub const HDR_FORMAT: Format = Format::Rgba16Float;

/// Shader of surfaces.
static SURFACE_SHADER: Module<'static> = library::pass("pass/color.wgsl").unwrap();

/// Shader of the background.
pub(crate) static SKY_SHADER: Module<'static> = library::pass("pass/sky.wgsl").unwrap();

/// Interface of the surface shader, `pass/color.wgsl`.
pub static SURFACE: Interface =
    Interface { groups: &[FRAME_BINDINGS, &MATERIAL_BINDINGS, &["objects", "origins"]], constants: &CONSTANTS };

/// Constants of lights: bent normals, a sun, punctual lights, the sun's channels, differing channels of instances and
/// lights, and an environment stored as RGBM.
const LIGHT_CONSTANTS: [&str; 6] =
    ["BENT_NORMALS", "SUN", "LAMPS", "SUN_CHANNELS", "CHANNELS_DIFFER", SKY.constants[0]];

/// Constants of material, instance, shading, lights and shadows.
const CONSTANTS: [&str; 2 + Shading::CONSTANTS.len() + LIGHT_CONSTANTS.len() + ShadowBindings::CONSTANTS.len()] = {
    let parts: [&[&str]; 3] = [&Shading::CONSTANTS, &LIGHT_CONSTANTS, &ShadowBindings::CONSTANTS];
    let mut names = [SurfaceDraw::TRAITS; _];
    names[1] = SurfaceDraw::OBJECT_LIGHT;
    let (mut at, mut part) = (2, 0);
    while part < parts.len() {
        let mut index = 0;
        while index < parts[part].len() {
            names[at] = parts[part][index];
            (at, index) = (at + 1, index + 1);
        }
        part += 1;
    }
    names
};

/// Interface of the background shader, `pass/sky.wgsl`.
pub static SKY: Interface = Interface { groups: &[FRAME_BINDINGS, &["sky"]], constants: &["ENVIRONMENT_RGBM"] };

/// Bind group 0: bindings shared by all draws of a view. [`SurfaceBindings`] fills them in this order.
const FRAME_BINDINGS: &[&str] = &[
    "frame",
    "lights",
    "froxels",
    "light_lists",
    "environment_map",
    "environment_sampler",
    "specular_map",
    "dfg_table",
    "light_sampler",
    "scene_levels",
    "scene_sampler",
    "ambient_occlusion",
    "structure",
    "contact_depth",
    "reflections",
    "reflection_hit_distance",
    "fog",
    "total_absorbance",
    "absorbance_moments",
    "eyes",
    ShadowBindings::NAMES[0],
    ShadowBindings::NAMES[1],
    ShadowBindings::NAMES[2],
    ShadowBindings::NAMES[3],
    ShadowBindings::NAMES[4],
    ShadowBindings::NAMES[5],
];

/// Parts of a world that shading reads.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfaceWorld<'a> {
    pub programs: &'a Programs,
    pub scene: &'a GpuScene,
    pub lighting: &'a Lighting,
    pub view: &'a GpuView,
    /// All views, to compare shadow maps.
    pub views: &'a Views,
}

impl<'a> SurfaceWorld<'a> {
    /// Returns the parts of `world`, with the view of this index.
    pub fn of<W>(world: &'a W, view: ViewId) -> Result<Self, PassError>
    where
        W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Lighting> + AsRef<Views> + ?Sized,
    {
        let views: &Views = world.as_ref();
        Ok(Self {
            programs: world.as_ref(),
            scene: world.as_ref(),
            lighting: world.as_ref(),
            view: views.get(view)?,
            views,
        })
    }

    /// Returns the source of instances for draws.
    pub fn instances(&self) -> InstanceSource<'a> {
        self.view.instances(self.scene)
    }
}

/// Optional inputs of shading besides the scene.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SurfaceInputs {
    /// Shadow maps.
    pub shadow: Option<ShadowInput>,
    /// Pyramid of the radiance behind transmissive surfaces.
    pub scene: Option<View>,
    /// Depth of the scene at the size of the picture, for contact shadows.
    pub contact: Option<View>,
    /// Ambient occlusion.
    pub occlusion: Option<OcclusionInput>,
    /// Pyramid of screen-space reflections, and hit distances.
    pub reflections: Option<[View; 2]>,
    /// Fog.
    pub fog: Option<FogSettings>,
    /// True if the depth attachment has stencil.
    pub stencil: bool,
    /// Sums of absorbance and of its moments, with the bias and overestimation of the estimate.
    pub moments: Option<([View; 2], [f32; 2])>,
}

/// Ambient occlusion as read by shading.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OcclusionInput {
    /// Visibility in red.
    pub picture: View,
    /// Depth pyramid it was computed from, if smaller than the picture.
    pub structure: Option<View>,
    /// True if the other channels hold the bent normal.
    pub bent_normals: bool,
}

impl SurfaceInputs {
    /// Returns inputs with shadow maps only, if any.
    pub fn shadowed(shadow: Option<ShadowInput>) -> Self {
        Self { shadow, ..Self::default() }
    }
}

/// State shared by all draws of a color pass: bindings of group 0, and shader features and constants.
#[derive(Debug)]
pub(crate) struct SurfaceBindings {
    /// Bindings in the order of [`FRAME_BINDINGS`], then those of inlined effects.
    pub frame: Vec<Option<Binding>>,
    features: Features,
    shading: Shading,
    /// Number of spherical-harmonic bands of the irradiance.
    bands: ShBands,
    /// True if the depth has stencil, which materials test and write.
    pub stencil: bool,
    /// True if radiance behind transmissive surfaces is available.
    transmits: bool,
    /// Values of [`LIGHT_CONSTANTS`].
    light: [f64; LIGHT_CONSTANTS.len()],
    /// Values of [`ShadowBindings::CONSTANTS`].
    shadows: [f64; ShadowBindings::CONSTANTS.len()],
    /// Effects that the plan inlined into the pass.
    pub epilogue: Epilogue,
}

impl SurfaceBindings {
    pub fn new(
        inputs: SurfaceInputs,
        shading: &Shading,
        world: &SurfaceWorld<'_>,
        epilogue: Epilogue,
        cx: &mut Cx<'_>,
    ) -> Result<Self, RecordError> {
        let SurfaceWorld { lighting, view, views, .. } = *world;
        shading.precision.check(cx.gpu()).map_err(PassError::from)?;
        let (wanted, made) = (shading.table, lighting.dfg.settings.visibility);
        if wanted != made {
            return Err(PassError::OtherTable { wanted, made }.into());
        }
        let around = SamplerDesc {
            address: [AddressMode::Repeat, AddressMode::ClampToEdge, AddressMode::ClampToEdge],
            ..SamplerDesc::LINEAR
        };
        let lists = view.view.light_lists.as_ref().filter(|_| LightLists::can_be_bound(&cx.gpu().device.limits()));
        let fog = inputs.fog.filter(FogSettings::is_seen);
        let structure = inputs.occlusion.and_then(|input| input.structure);
        let mut frame = view.view.frame;
        if let Some((_, [bias, overestimation])) = inputs.moments {
            (frame.blended.z, frame.blended.w) = (bias, overestimation);
        }
        let sums = inputs.moments.map(|(sums, _)| sums);
        let own: [Option<Binding>; FRAME_BINDINGS.len() - ShadowBindings::NAMES.len()] = [
            Some(cx.uniform(&frame)),
            Some(view.lights.clone().into()),
            lists.map(|lists| cx.uniform(&lists.uniforms)),
            lists.map(|_| view.light_lists.clone().into()),
            Some(lighting.panorama.view.clone().into()),
            Some(cx.sampler(around).into()),
            Some(lighting.image.specular.clone().into()),
            Some(lighting.dfg.view.clone().into()),
            Some(cx.sampler(SamplerDesc::LINEAR).into()),
            inputs.scene.map(|scene| cx.view(scene)).transpose()?.map(Binding::from),
            Some(cx.sampler(SamplerDesc::LINEAR).into()),
            inputs.occlusion.map(|input| cx.view(input.picture)).transpose()?.map(Binding::from),
            structure.map(|structure| cx.view(structure)).transpose()?.map(Binding::from),
            inputs.contact.map(|depth| cx.view(depth)).transpose()?.map(Binding::from),
            inputs.reflections.map(|[found, _]| cx.view(found)).transpose()?.map(Binding::from),
            inputs.reflections.map(|[_, ways]| cx.view(ways)).transpose()?.map(Binding::from),
            fog.map(|fog| cx.uniform(&fog.uniforms(&view.view))),
            sums.map(|[total, _]| cx.view(total)).transpose()?.map(Binding::from),
            sums.map(|[_, moments]| cx.view(moments)).transpose()?.map(Binding::from),
            view.view.eyes.map(|eyes| cx.uniform(&eyes)),
        ];
        let shadows = ShadowBindings::new(inputs.shadow, (view, views), cx)?;
        let effects = epilogue.bindings.iter().map(|(_, binding)| Some(binding.clone()));
        Ok(Self {
            frame: own.into_iter().chain(shadows.bindings).chain(effects).collect(),
            features: shadows
                .features
                .with_if(Feature::ENVIRONMENT_MAP, !lighting.image.is_even)
                .with_if(Feature::CONTACT_SHADOWS, inputs.shadow.is_some() && inputs.contact.is_some())
                .with_if(Feature::AMBIENT_OCCLUSION, inputs.occlusion.is_some_and(|input| input.structure.is_none()))
                .with_if(Feature::OCCLUSION_UPSAMPLED, inputs.occlusion.is_some_and(|input| input.structure.is_some()))
                .with_if(Feature::FROXELS, lists.is_some())
                .with_if(Feature::REFLECTIONS, inputs.reflections.is_some())
                .with_if(Feature::FOG, fog.is_some())
                .with_if(Feature::STEREO, cx.targets().layers > 1)
                .with_if(Feature::HALF, shading.precision == Precision::Half),
            shading: *shading,
            bands: lighting.image.bands,
            stencil: inputs.stencil,
            transmits: inputs.scene.is_some(),
            light: [
                f64::from(inputs.occlusion.is_some_and(|input| input.bent_normals)),
                f64::from(view.view.frame.sun_illuminance != Vec3::ZERO),
                f64::from(view.view.frame.light_count > 0),
                f64::from(view.view.sun_channels),
                f64::from(view.view.channels_differ),
                f64::from(lighting.image.is_rgbm()),
            ],
            shadows: shadows.constants,
            epilogue,
        })
    }

    /// Returns the program of a surface variant.
    pub fn program(&self, programs: &Programs, variant: SurfaceVariant) -> Result<Arc<Program>, PassError> {
        self.program_with(programs, variant, "fs_main")
    }

    /// Returns the program of a surface variant with this fragment entry point of `pass/color.wgsl`.
    pub fn program_with(
        &self,
        programs: &Programs,
        variant: SurfaceVariant,
        fragment: &'static str,
    ) -> Result<Arc<Program>, PassError> {
        let SurfaceVariant { lobes, material_table, .. } = variant;
        if lobes.contains(Lobe::Transmission) && !self.transmits {
            return Err(PassError::TransmissionUndeclared);
        }
        let vertices = variant.vertex_features();
        let features = features_of(lobes).iter().chain(vertices.iter()).fold(self.features.clone(), Features::with);
        let features = &features.with_if(Feature::MATERIAL_TABLE, material_table);
        let desc = ProgramDesc { fragment: Some(fragment), ..ProgramDesc::new(&SURFACE_SHADER, &SURFACE) };
        programs.get(&ProgramDesc { features, epilogue: &self.epilogue, ..desc })
    }

    /// Returns the features of the background shader, which applies the same fog.
    pub fn background_features(&self) -> Features {
        Features::NONE.with_if(Feature::FOG, self.features.contains(Feature::FOG))
    }

    /// Returns the values of the constants of [`SKY`], then those of effects.
    pub fn background_constants(&self) -> Vec<f64> {
        let effects = self.epilogue.constants.iter().map(|(_, value)| *value);
        [self.light[LIGHT_CONSTANTS.len() - 1]].into_iter().chain(effects).collect()
    }

    /// Returns the values of the constants after the material's, then those of effects.
    pub fn constants(&self, alpha: AlphaUse) -> Vec<f64> {
        let effects = self.epilogue.constants.iter().map(|(_, value)| *value);
        let shading = self.shading.constants(alpha, self.bands).into_iter();
        shading.chain(self.light).chain(self.shadows).chain(effects).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu_scene::draw::fits;
    use framegraph_scene::Lobes;

    fn color(features: &Features) -> Result<Program, PassError> {
        Program::new(&ProgramDesc { features, ..ProgramDesc::new(&SURFACE_SHADER, &SURFACE) })
    }

    /// The interface provides every binding of all surface and background variants.
    #[test]
    fn every_variable_is_provided() -> Result<(), PassError> {
        let map = || Features::NONE.with(Feature::ENVIRONMENT_MAP);
        color(&map())?;
        for feature in Feature::all() {
            color(&map().with(feature))?;
        }
        color(&Feature::all().collect())?;
        for fragment in ["fs_environment", "fs_procedural", "fs_constant", "fs_black"] {
            for features in [Features::NONE, Features::NONE.with(Feature::FOG)] {
                let (fragment, features) = (Some(fragment), &features);
                Program::new(&ProgramDesc { fragment, features, ..ProgramDesc::new(&SKY_SHADER, &SKY) })?;
            }
        }
        Ok(())
    }

    /// All lobes together bind more textures than WebGPU guarantees; one lobe does not.
    #[test]
    fn a_material_over_the_devices_limit_is_named() -> Result<(), PassError> {
        let frame = [Feature::SHADOWS, Feature::ENVIRONMENT_MAP, Feature::TEXTURED].into_iter().collect::<Features>();
        let outcome = |lobes: Lobes, limits: &wgpu::Limits| {
            let program = color(&features_of(lobes).iter().fold(frame.clone(), Features::with))?;
            Ok::<_, PassError>(fits(&program, lobes, "opal", limits).map_err(|error| error.to_string()))
        };
        let all = Lobe::ALL.into_iter().collect();
        let guaranteed = wgpu::Limits::default();
        let error = outcome(all, &guaranteed)?.err().unwrap_or_default();
        let names = features_of(all).iter().map(Feature::name).collect::<Vec<_>>().join(", ");
        let words = format!("material \"opal\" combines {names}: its shader binds ");
        assert!(
            names.starts_with("ANISOTROPY, CLEAR_COAT, ")
                && error.contains(&words)
                && error.contains("textures, and the device allows 16"),
            "{error}"
        );
        assert_eq!(outcome(Lobes::NONE.with(Lobe::ClearCoat), &guaranteed)?, Ok(()));
        let ample = wgpu::Limits { max_sampled_textures_per_shader_stage: 64, ..guaranteed };
        let error = outcome(all, &ample)?.err().unwrap_or_default();
        assert!(error.contains("samplers, and the device allows 16"), "{error}");
        Ok(())
    }
}
