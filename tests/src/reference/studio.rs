//! Rendering of a statement by the standard frame on the default adapter.

use super::asset::Sources;
use super::bloom;
use super::color;
use super::document::{AntiAliasing, CameraType, ColorGrading, Document, Msaa, Output, ShadowType, Ssr};
use super::fog;
use super::light::around;
use super::occlusion;
use super::picture::Picture;
use super::temporal;
use crate::executors;
use crate::filtered::filtered;
use crate::stage::light_cache;
use framegraph::{Extent, Format, Options, Plan, Scratch, Target, Texture, TextureDesc, compile};
use framegraph_passes::effects::fxaa::Fxaa;
use framegraph_passes::effects::occlusion::OcclusionSettings;
use framegraph_passes::effects::reflection::ReflectionSettings;
use framegraph_passes::gpu_scene::shadow_views::{
    ContactShadows, Fit, MAX_CASCADES, ShadowBias, ShadowFilter, ShadowSettings, Splits,
};
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::light::ibl::{DfgSettings, IblSettings};
use framegraph_passes::light::shading::{LightSettings, LightWindow, SpecularAa, TransmissionBlur};
use framegraph_passes::stages::{Handles, Slot, StageError};
use framegraph_passes::{CameraView, Lighting, PostSettings, Quality, Settings, Shading, ViewId, World, stages};
use framegraph_scene::camera::EV100_RANGE;
use framegraph_scene::{Camera, Environment, Light, LightKind, Projection, Scene, progress};
use framegraph_shader_mirrors::dfg::Visibility;
use framegraph_shaders::layout::FxaaUniforms;
use framegraph_wgpu::Frame;
use framegraph_wgpu::{Gpu, Imports, Pixels, read_texture};
use glam::{DVec3, DVec4, Vec3};
use std::error::Error;

/// Filament's default size of shadow maps, in texels.
const SHADOW_MAP_TEXELS: u32 = 1024;
/// Maximum accepted illuminance in lux, so that sums stay finite in f32.
const MAX_LUX: f64 = 1e10;

/// Number of frames until multiple reflections converge, since reflections show the previous frame.
const FRAMES_WITH_HISTORY: u32 = 4;

/// Shading quality.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shade {
    /// Filament's low quality with gltfio's materials, as in the references. Unlike our low quality, it uses the DFG
    /// table of the exact term. Ambient occlusion does not darken reflections, and a base under a clear coat keeps its
    /// reflectance. Rough glass blurs by an angle. Punctual lights have Filament's range window and fade to 100 m.
    #[default]
    Maker,
    /// A preset of this project.
    Preset(Quality),
}

impl Shade {
    /// Parses `maker` or the name of a preset.
    pub fn from_name(name: &str) -> Option<Self> {
        if name == "maker" { Some(Self::Maker) } else { Quality::from_name(name).map(Self::Preset) }
    }

    const fn shading(self) -> Shading {
        match self {
            Self::Maker => Shading {
                table: Visibility::Exact,
                specular_occlusion: false,
                coat_ior_change: false,
                transmission_blur: TransmissionBlur::Angle,
                light_window: LightWindow::Filament,
                light_fade_m: Some(100.0),
                ..Quality::Low.shading()
            },
            Self::Preset(quality) => quality.shading(),
        }
    }
}

/// Renders a statement with its files and a shading quality.
///
/// # Errors
/// An invalid statement or model, or a failure of the device.
pub fn render(gpu: &Gpu, document: &Document, sources: &Sources, shade: Shade) -> Result<Picture, Box<dyn Error>> {
    let stated = &document.scene;
    let linear = stated.output == Output::Linear;
    if let Some(key) = stated.view.color_grading.as_ref().and_then(color::wrong) {
        return Err(format!("scene.view.color_grading.{key}: needs finite numbers up to a million").into());
    }
    let wanted = |handles: &Handles| handles.get(if linear { Slot::HDR } else { Slot::PICTURE });
    let pixels = rendered(gpu, document, sources, settings(document, shade), wanted)?;
    Ok(if linear {
        Picture::from_linear(stated.resolution, pixels.rgba().into_iter().map(|[r, g, b, _]| [r, g, b]).collect())
    } else {
        Picture::from_codes(stated.resolution, &pixels.rgba8())
    })
}

/// Renders the ambient occlusion of a statement with other settings. Returns visibility, rows from the top, and the
/// size.
///
/// # Errors
/// The errors of [`render`].
pub fn visibility(
    gpu: &Gpu,
    document: &Document,
    sources: &Sources,
    occlusion: OcclusionSettings,
) -> Result<Pixels, Box<dyn Error>> {
    let settings = Settings { occlusion: Some(occlusion), ..settings(document, Shade::Maker) };
    rendered(gpu, document, sources, settings, |handles| handles.get(Slot::OCCLUSION))
}

/// Renders a statement with other ambient occlusion, which also affects reflections as in our presets. Returns radiance
/// times exposure.
///
/// # Errors
/// The errors of [`render`].
pub fn radiance(
    gpu: &Gpu,
    document: &Document,
    sources: &Sources,
    occlusion: Option<OcclusionSettings>,
) -> Result<Picture, Box<dyn Error>> {
    let shading = Shading { specular_occlusion: true, ..shading(document, Shade::Maker) };
    let settings = Settings { occlusion, shading, ..settings(document, Shade::Maker) };
    let pixels = rendered(gpu, document, sources, settings, |handles| handles.get(Slot::HDR))?;
    Ok(Picture::from_linear(pixels.texels, pixels.rgba().into_iter().map(|[r, g, b, _]| [r, g, b]).collect()))
}

/// Renders a statement and returns the texture that `wanted` selects.
fn rendered(
    gpu: &Gpu,
    document: &Document,
    sources: &Sources,
    settings: Settings,
    wanted: impl Fn(&Handles) -> Result<Texture, StageError>,
) -> Result<Pixels, Box<dyn Error>> {
    let stated = &document.scene;
    let mut scene = Scene::open(&sources.model.to_string_lossy(), &mut progress::silent)?;
    let environment = surroundings(document, sources, &mut scene)?;
    let seen = view_settings(document)?;
    let exposure = stated.exposure.direct;
    let [r, g, b, _] = stated.clear_color.map(|c| (c / exposure) as f32);
    let settings = settings.for_scene(&scene, stated.resolution);
    let lighting = lighting(gpu, &environment, &settings.shading)?;
    let view = CameraView::new(&scene, &lighting.image, &Background::Constant(Vec3::new(r, g, b)), &seen);
    let mut world = World::new(gpu, &scene, lighting, [view], &mut progress::silent)?;

    let mut frame: Frame<World> = Frame::new();
    let codes = frame.graph_mut().texture("output", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
    let wanted = wanted(&stages(&settings).declare(&mut frame, settings.handles(), Target::from(codes))?)?;
    frame.graph_mut().readback(wanted)?;
    let [width, height] = stated.resolution;
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), &Options::for_frame(width, height), &mut Scratch::new(), &mut plan)?;
    let mut executor = executors::lend(gpu);
    let imports = Imports::new();
    let frames = match (&settings.taa, settings.reflections) {
        (Some(_), _) => temporal::FRAMES,
        (None, Some(_)) => FRAMES_WITH_HISTORY,
        (None, None) => 1,
    };
    for index in 0..frames {
        if let Some(taa) = &settings.taa {
            world.views.again(ViewId::MAIN, taa.jitter_px(index))?;
        }
        executor.execute(&plan, &frame, &world, &imports)?;
    }
    let texture = executor.texture(&plan, wanted).ok_or("the frame left no picture")?;
    Ok(read_texture(gpu, texture)?)
}

/// Uniform light needs only a small cube; the DFG table determines the result.
fn lighting(gpu: &Gpu, environment: &Environment, shading: &Shading) -> Result<Lighting, Box<dyn Error>> {
    let settings = LightSettings {
        image: IblSettings { cube_texels: 64, ..IblSettings::default() },
        dfg: DfgSettings { texels: 64, visibility: shading.table },
    };
    Ok(Lighting::new(gpu, environment, &settings, &light_cache(), &mut progress::silent)?)
}

/// Returns the shading settings of `shade`, with the stated specular anti-aliasing.
fn shading(document: &Document, shade: Shade) -> Shading {
    let [variance, threshold] = document.scene.specular_aa.map(|x| x as f32);
    let specular_aa = (variance > 0.0 && threshold > 0.0).then_some(SpecularAa { variance, threshold });
    Shading { specular_aa, ..shade.shading() }
}

/// Creates the environment with the sun; other lights are added to the scene.
fn surroundings(document: &Document, sources: &Sources, scene: &mut Scene) -> Result<Environment, Box<dyn Error>> {
    let stated = &document.scene;
    if stated.clear_color.iter().any(|c| !(0.0..=MAX_LUX).contains(c)) {
        return Err("scene.clear_color: needs four channels from 0 to 1e10".into());
    }
    if stated.specular_aa.iter().any(|x| !(0.0..=1.0).contains(x)) {
        return Err("scene.specular_aa: needs a variance and a threshold from 0 to 1".into());
    }
    let mut environment = around(stated.ibl.as_ref(), sources.light.as_deref())?;
    let sun = stated.lights.iter().position(|light| light.cast_shadows).unwrap_or(0);
    for (index, light) in stated.lights.iter().enumerate() {
        let finite = |v: [f64; 3]| Some(DVec3::from_array(v)).filter(|v| v.is_finite());
        let wrong = |key: &str, needed: &str| format!("scene.lights[{index}].{key}: {needed} is needed");
        if !(0.0..=MAX_LUX).contains(&light.intensity) {
            return Err(wrong("intensity", "an illuminance from 0 to 1e10 lux").into());
        }
        let direction = finite(light.direction).and_then(DVec3::try_normalize);
        let direction = direction.ok_or_else(|| wrong("direction", "a finite vector with a length"))?;
        let color = finite(light.color)
            .filter(|c| c.min_element() >= 0.0)
            .ok_or_else(|| wrong("color", "a color of finite channels, none below 0,"))?;
        let illuminance_lux = light.intensity as f32;
        let light = Light {
            kind: LightKind::Directional { illuminance_lux, angular_radius_rad: 0.0 },
            color: color.as_vec3(),
            ..Light::directional("stated", direction.as_vec3(), illuminance_lux)
        };
        if index == sun { environment.sun = Some(light) } else { scene.lights.push(light) }
    }
    Ok(environment)
}

/// Returns the camera, exposure and shadow map of a statement.
fn view_settings(document: &Document) -> Result<ViewSettings, Box<dyn Error>> {
    let stated = &document.scene;
    let ev100 = (1.0 / (1.2 * stated.exposure.direct)).log2() as f32;
    if !(stated.exposure.direct > 0.0 && (EV100_RANGE.0..=EV100_RANGE.1).contains(&ev100)) {
        return Err(format!("scene.exposure.direct: {} is out of range", stated.exposure.direct).into());
    }
    Ok(ViewSettings {
        camera: camera(document)?,
        size_px: stated.resolution,
        ev100,
        environment_intensity: stated.ibl.as_ref().map_or(1.0, |ibl| ibl.intensity as f32),
        shadows: shadows(document),
        ..ViewSettings::default()
    })
}

/// An orthographic camera looks through the center of its window, regardless of the eye.
fn camera(document: &Document) -> Result<Camera, String> {
    let stated = &document.scene.camera;
    let missing = |key: &str, needed: &str| format!("scene.camera.{key}: {needed} is needed");
    let (near_m, far_m) = (stated.near, stated.far);
    if !(near_m.is_finite() && far_m > near_m) {
        return Err(missing("near", "a distance below `far`"));
    }
    let mut middle = [0.0; 2];
    let projection = match stated.r#type {
        CameraType::Perspective => {
            let degrees = stated
                .fov_y_deg
                .filter(|d| *d > 0.0 && *d < 180.0)
                .ok_or_else(|| missing("fov_y_deg", "an angle between 0 and 180"))?;
            if near_m <= 0.0 {
                return Err(missing("near", "a distance above 0"));
            }
            Projection::Perspective { fov_y_rad: degrees.to_radians(), near_m, far_m: None }
        }
        CameraType::Ortho => {
            let window = stated.ortho.filter(|w| w.iter().all(|c| c.is_finite()) && w[1] > w[0] && w[3] > w[2]);
            let [left, right, bottom, top] = window.ok_or_else(|| {
                missing("ortho", "a window [left, right, bottom, top] with left < right and bottom < top")
            })?;
            middle = [0.5 * (left + right), 0.5 * (bottom + top)];
            let (half_width_m, half_height_m) = (Some(0.5 * (right - left)), 0.5 * (top - bottom));
            Projection::Orthographic { half_width_m, half_height_m, near_m, far_m }
        }
    };
    let [eye, target, up] = [stated.eye, stated.center, stated.up].map(DVec3::from_array);
    if up.try_normalize().is_none() {
        return Err(missing("up", "a finite vector with a length"));
    }
    let mut camera = Camera::look_at(eye, target, up, projection).map_err(|why| format!("scene.camera.eye: {why}"))?;
    camera.eye += camera.world_from_view * DVec3::new(middle[0], middle[1], 0.0);
    Ok(camera)
}

/// Returns the positions of points in the picture, x and y in 0…1 from the top left.
///
/// # Errors
/// An invalid camera.
pub fn seen_at(document: &Document, points: &[[f64; 3]]) -> Result<Vec<[f64; 2]>, String> {
    let camera = camera(document)?;
    let [width, height] = document.scene.resolution.map(f64::from);
    let clip_from_world = camera.clip_from_view(width / height) * camera.view_from_world();
    let place = |point: &[f64; 3]| {
        let DVec4 { x, y, w, .. } = clip_from_world * DVec3::from_array(*point).extend(1.0);
        [0.5 + 0.5 * x / w, 0.5 - 0.5 * y / w]
    };
    Ok(points.iter().map(place).collect())
}

/// Returns the shadow settings of the light that casts shadows, if any; missing options have Filament's defaults.
fn shadows(document: &Document) -> Option<ShadowSettings> {
    let light = document.scene.lights.iter().find(|light| light.cast_shadows)?;
    let options = &light.shadow_options;
    let number = |value: Option<f64>, default: f64| value.unwrap_or(default) as f32;
    let usual = ShadowSettings::DEFAULT;
    Some(ShadowSettings {
        map_texels: options.map_size.unwrap_or(SHADOW_MAP_TEXELS),
        filter: match document.shadow_type.unwrap_or(ShadowType::Pcf) {
            ShadowType::Pcf => ShadowFilter::Pcf,
            ShadowType::Vsm => ShadowFilter::Vsm,
            ShadowType::Dpcf => ShadowFilter::Dpcf,
            ShadowType::Pcss => ShadowFilter::Pcss,
        },
        cascades: options.shadow_cascades.unwrap_or(1).clamp(1, MAX_CASCADES as u32) as u8,
        splits: options.cascade_split_positions.map_or(usual.splits, Splits::At),
        fit: match options.stable {
            Some(true) => Fit::Stable,
            _ => Fit::Tight { lispsm: options.lispsm.unwrap_or(true) },
        },
        far_m: options.shadow_far.filter(|far| *far > 0.0),
        bias: ShadowBias {
            constant_m: number(options.constant_bias, 0.001),
            normal: number(options.normal_bias, 1.0),
            ..usual.bias
        },
        bulb_m: Some(number(options.shadow_bulb_radius, 0.02)),
        contact: (options.screen_space_contact_shadows == Some(true)).then(|| ContactShadows {
            steps: options.step_count.unwrap_or(ContactShadows::FILAMENT.steps),
            distance_m: number(options.max_shadow_distance, 0.3),
        }),
        ..usual
    })
}

fn reflections(stated: &Ssr) -> ReflectionSettings {
    let own = ReflectionSettings::DEFAULT;
    let number = |value: Option<f64>, default: f32| value.map_or(default, |value| value as f32);
    ReflectionSettings {
        thickness_m: number(stated.thickness, own.thickness_m),
        bias_m: number(stated.bias, own.bias_m),
        reach_m: number(stated.max_distance, own.reach_m).max(1e-3),
        stride_texels: number(stated.stride, own.stride_texels).max(1.0),
        ..own
    }
}

fn settings(document: &Document, shade: Shade) -> Settings {
    let view = &document.scene.view;
    let neutral = ColorGrading::default();
    let graded = view.color_grading.as_ref().unwrap_or(&neutral);
    Settings {
        shading: shading(document, shade),
        occlusion: view.ao.as_ref().and_then(|ao| occlusion::settings(ao, shade == Shade::Maker)),
        reflections: view.ssr.as_ref().filter(|ssr| ssr.enabled).map(reflections),
        bloom: view.bloom.as_ref().and_then(|bloom| bloom::settings(bloom, shade == Shade::Maker)),
        fog: view.fog.as_ref().and_then(|fog| fog::settings(fog, &document.scene)),
        taa: view.taa.as_ref().filter(|taa| taa.enabled).map(temporal::settings),
        samples: if view.msaa.as_ref().map_or(1, Msaa::samples) > 1 { 4 } else { 1 },
        shadows: shadows(document),
        fxaa: view.post_processing && view.anti_aliasing == AntiAliasing::Fxaa,
        post: PostSettings {
            look: color::look(graded),
            by: color::by(graded),
            edge_fade: view.vignette.as_ref().and_then(color::edge_fade),
            dither: f32::from(u8::from(document.dithering)),
            ..PostSettings::DEFAULT
        },
        ..Settings::default()
    }
}

/// Applies our FXAA to a finished picture, for rules that start from another program's picture.
///
/// # Errors
/// The device fails.
pub fn antialiased(gpu: &Gpu, picture: &Picture) -> Result<Picture, Box<dyn Error>> {
    let codes = filtered(gpu, &with_luma(picture), picture.size_px, |frame, ldr| {
        let filter = Fxaa { ldr, into: Target::New, settings: FxaaUniforms::default() };
        Ok(frame.add("fxaa", filter)?.output)
    })?;
    Ok(Picture::from_codes(picture.size_px, &codes))
}

/// Returns 8-bit colors with the luma of the encoded color (Rec.709) in alpha, as FXAA reads it.
fn with_luma(picture: &Picture) -> Vec<u8> {
    let code = |c: f32| (c * 255.0).round() as u8;
    let texel = |[r, g, b]: &[f32; 3]| [*r, *g, *b, 0.2126 * r + 0.7152 * g + 0.0722 * b].map(code);
    picture.encoded.iter().flat_map(texel).collect()
}
