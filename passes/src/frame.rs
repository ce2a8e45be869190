//! The standard frame: all effects as passes of one graph.
//!
//! [`stages`] returns the frame as named stages, which an application can extend and replace. [`standard`] declares
//! them unchanged.
//!
//! | stage | passes | reads | provides |
//! | --- | --- | --- | --- |
//! | `shadow` | `shadow`, or one pass for each layer | | shadow maps |
//! | `prepass` | `prepass`, `velocity`, if requested; `structure` for contact shadows and reflections | | depth, motion vectors, structure |
//! | `occlusion` | `structure`, `structure_level`…, `occlusion`, `occlusion_blur` twice | depth | structure, ambient occlusion |
//! | `reflection` | `reflection_depth`, `depth_bounds`…, `reflection`, `reflection_level`… | depth, radiance of the previous frame | structure, reflections, target of the radiance |
//! | `color` | `color` | depth (with a prepass), shadow maps, structure, ambient occlusion, reflections | radiance, depth |
//! | `scene` | `scene/copy`, `scene/level`… | radiance, depth | picture behind refractive surfaces |
//! | `transparent` | `transparent`; `blended/…` for order-independent transparency | all of the above | radiance, depth |
//! | `resolve` | `tone_resolve` | multisampled radiance | radiance |
//! | `taa` | `depth_resolve`, `taa`, `taa_sharpen` | radiance, depth, history | radiance |
//! | `measure` | `measure/light`, `measure/depth`, `measure/smaller` | radiance, depth | readback of luminance and depth |
//! | `dof` | `dof/coc`, `dof/level`…, `dof/tiles`, `dof/dilate`, `dof/gather`, `dof/median`, `dof/combine` | radiance, depth | radiance |
//! | `bloom` | `bloom/half`…, `bloom/first`, `bloom/down`…, `bloom/flare`, `bloom/flare_blur` twice, `bloom/up`… | radiance | bloom, lens flare |
//! | `post` | `post`, or one pass for each effect | radiance, bloom, lens flare, lens dirt | picture |
//! | `fxaa` | `fxaa` | picture | picture |
//! | `upscale` | `upscale`, `upscale_sharpen` | picture | picture |
//!
//! The *structure* is the depth pyramid of the visible surfaces, a copy of the depth of the prepass. With several
//! samples per texel the structure is drawn, and the color pass tests its own depth. Geometry is thus drawn twice for
//! the picture, and a third time for reflections or motion vectors. Every stage exists with every setting. A stage that a
//! frame does not need declares no pass.
//!
//! This folder may use every other folder of the crate. Only [`feature_culling`](crate::feature_culling) and
//! [`quality`](crate::quality) may use it.

mod before;
mod blended;
mod fields;
pub mod frame_settings;
mod glass;
mod lens;
mod picture;
#[cfg(feature = "files")]
pub mod plugins;
#[cfg(feature = "ibl")]
pub mod scene_loop;
#[cfg(feature = "files")]
pub mod settings_file;
mod shadows;
pub mod tables;
pub mod world;

use crate::effects::bloom::BloomSettings;
use crate::effects::color::surface::HDR_FORMAT;
use crate::effects::color::{Color, ColorDepth};
use crate::effects::depth::structure::{Resolution, structure_levels};
use crate::effects::dof::DofSettings;
use crate::effects::exposure::{Measure, MeasuredTextures, measure};
use crate::effects::fog::FogSettings;
use crate::effects::occlusion::OcclusionSettings;
use crate::effects::post::PostSettings;
use crate::effects::post::tone_resolve::ToneResolve;
use crate::effects::reflection::ReflectionSettings;
use crate::effects::taa::{TaaSettings, temporal};
use crate::effects::transmission::{MAX_GLASS_LAYERS, scene_levels};
use crate::effects::transparency::Transparency;
use crate::effects::upscale::{Upscale, enlarge};
use crate::gpu_scene::lighting::Lighting;
use crate::gpu_scene::shadow_views::ShadowSettings;
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::Views;
use crate::grading::GradingTables;
use crate::light::shading::{Quality, Shading};
use crate::program::Programs;
use crate::settings::frame_index::FrameIndex;
use crate::stages::{Handles, Slot, Stage, StageError, Stages};
use before::{full_structure, occlusion, prepass, reflection};
use blended::{Blended, blended};
use framegraph::{Extent, Format, Target, Texture};
use framegraph_scene::{AlphaMode, Lobe, MaterialId, Scene, TransparencyMode};
use framegraph_wgpu::{Frame, StoreRounding};
use glass::{Glass, scene, transparent};
use lens::{bloom, dof, mix_of};
use picture::{PostWay, fxaa};
use shadows::{maps_of, shadow};

/// Parts of the world that the standard frame reads.
pub trait StandardWorld:
    AsRef<Programs> + AsRef<GpuScene> + AsRef<Lighting> + AsRef<Views> + AsRef<FrameIndex> + AsRef<GradingTables> + 'static
{
}

impl<W> StandardWorld for W where
    W: AsRef<Programs>
        + AsRef<GpuScene>
        + AsRef<Lighting>
        + AsRef<Views>
        + AsRef<FrameIndex>
        + AsRef<GradingTables>
        + ?Sized
        + 'static
{
}

/// Settings of the standard frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Settings {
    /// Samples per texel of the color pass: 1 or 4.
    pub samples: u8,
    /// Resolves multisampled radiance with tone-mapped weights, in a separate pass ([`ToneResolve`]). Edges in front
    /// of bright surfaces stay smooth if an effect reads radiance before it is graded. False by default, as in
    /// Filament.
    pub tone_resolve: bool,
    /// Settings of surface shading.
    pub shading: Shading,
    /// Settings of shadow maps; `None` disables shadows.
    pub shadows: Option<ShadowSettings>,
    /// Screen-space ambient occlusion; `None` by default, as in Filament.
    pub occlusion: Option<OcclusionSettings>,
    /// Screen-space reflections, traced in the radiance of the previous frame; `None` by default, as in Filament. The
    /// radiance becomes a history, and a separate pass grades it. Declare each view of a graph with reflections in its
    /// own scope.
    pub reflections: Option<ReflectionSettings>,
    /// Number of levels of the reflections, which blur them for rough surfaces; at most [`scene_levels`] of the size.
    #[cfg_attr(feature = "files", serde(skip))]
    pub reflection_levels: u8,
    /// Number of levels of the structure for ambient occlusion, at most [`structure_levels`] of its size. Fewer levels are slower, but as
    /// accurate.
    #[cfg_attr(feature = "files", serde(skip))]
    pub structure_levels: u8,
    /// Height fog in front of surfaces and sky; `None` by default, as in Filament.
    pub fog: Option<FogSettings>,
    /// Depth of field; `None` by default, as in Filament.
    pub dof: Option<DofSettings>,
    /// Bloom and lens flare; `None` by default, as in Filament. Post-processing is then a separate pass.
    pub bloom: Option<BloomSettings>,
    /// Picture size for which the levels of bloom and depth of field are chosen, in texels. At another size, blur
    /// radii keep their fraction of this size. [`Settings::for_scene`] sets it.
    #[cfg_attr(feature = "files", serde(skip))]
    pub size_texels: [u32; 2],
    /// True if a surface blends. The color pass then cannot be graded in place.
    #[cfg_attr(feature = "files", serde(skip))]
    pub blended: bool,
    /// True if a material tests or writes stencil. The depth texture then has stencil, as with Filament's
    /// `View::setStencilBufferEnabled`.
    #[cfg_attr(feature = "files", serde(skip))]
    pub stencil: bool,
    /// True if a blended surface writes depth
    /// ([`TransparencyMode::TwoPassesOneSide`](framegraph_scene::TransparencyMode)).
    #[cfg_attr(feature = "files", serde(skip))]
    pub blended_depth: bool,
    /// True if a blended surface tests or writes stencil. Its result depends on the order of draws, so
    /// order-independent techniques fall back to sorting.
    #[cfg_attr(feature = "files", serde(skip))]
    pub blended_stencil: bool,
    /// Technique for blended surfaces: sorted, or order-independent.
    pub transparency: Transparency,
    /// Number of levels of the picture behind refractive surfaces, at most [`scene_levels`] of the frame's size. 0 if
    /// no surface is refractive.
    #[cfg_attr(feature = "files", serde(skip))]
    pub scene_levels: u8,
    /// Number of refractive layers visible through each other, 1 to [`MAX_GLASS_LAYERS`]. With 1, refractive surfaces
    /// show only opaque ones. The last layer includes everything farther back.
    pub glass_layers: u8,
    /// Draws depth before shading, so that each pixel is shaded once. Without a prepass, hidden surfaces may be shaded
    /// too, and triangles are drawn once less. Motion vectors require the prepass. The picture does not change.
    pub prepass: bool,
    /// Draws the background. Without it, uncovered pixels are black.
    pub sky: bool,
    /// Temporal anti-aliasing; `None` by default, as in Filament. The caller jitters the view
    /// ([`TaaSettings::jitter_px`]). Declare each view of a graph with TAA in its own scope.
    pub taa: Option<TaaSettings>,
    /// True if something moves. TAA then draws motion vectors.
    #[cfg_attr(feature = "files", serde(skip))]
    pub moving: bool,
    /// Values measured in the frame for feature culling in later frames; set by [`Facts::apply`](crate::Facts::apply).
    #[cfg_attr(feature = "files", serde(skip))]
    pub measure: Measure,
    /// Fast approximate anti-aliasing of the finished picture.
    pub fxaa: bool,
    /// Renders at a lower resolution and upscales the picture. Make the view at the size of [`Upscale::extent`].
    pub upscale: Option<Upscale>,
    /// Exposure compensation, vignette, grading, tone curve and dither.
    pub post: PostSettings,
    /// Format of the radiance between shading and post-processing.
    pub hdr_format: Format,
    /// Declares a pass for each point-wise effect, instead of one for all.
    pub split_post: bool,
    /// Rounding of the radiance if post-processing is inlined into the color pass, as this device rounds a stored
    /// texture. The picture then equals the one without inlining bit for bit, at one sample per texel. `None` grades
    /// 32-bit radiance.
    #[cfg_attr(feature = "files", serde(skip))]
    pub stored: Option<StoreRounding>,
}

impl Default for Settings {
    /// [`Settings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Settings {
    /// One sample per texel, shadows, the ACES curve, FXAA, and the high quality of shading.
    pub const DEFAULT: Self = Self {
        samples: 1,
        tone_resolve: false,
        shading: Quality::High.shading(),
        shadows: Some(ShadowSettings::DEFAULT),
        occlusion: None,
        reflections: None,
        reflection_levels: 1,
        structure_levels: 1,
        fog: None,
        dof: None,
        bloom: None,
        size_texels: [1280, 720],
        blended: false,
        stencil: false,
        blended_depth: false,
        blended_stencil: false,
        transparency: Transparency::Sorted,
        scene_levels: 0,
        glass_layers: 1,
        moving: false,
        measure: Measure::NONE,
        prepass: true,
        sky: true,
        taa: None,
        fxaa: true,
        upscale: None,
        post: PostSettings::DEFAULT,
        hdr_format: HDR_FORMAT,
        split_post: false,
        stored: None,
    };

    /// Returns the frame with the passes that the scene's materials need, for a picture of this size.
    #[must_use]
    pub fn for_scene(self, scene: &Scene, size_texels: [u32; 2]) -> Self {
        let transmits = scene.lobes().contains(Lobe::Transmission);
        Self {
            blended: scene.materials.iter().any(|m| m.alpha == AlphaMode::Blend),
            stencil: scene.uses_stencil(),
            blended_depth: scene.materials.iter().any(|m| m.transparency == TransparencyMode::TwoPassesOneSide),
            blended_stencil: scene.materials.iter().any(|m| m.alpha == AlphaMode::Blend && m.stencil.is_some()),
            scene_levels: if transmits { scene_levels(size_texels) } else { 0 },
            glass_layers: self.glass_layers.min(glass_instances(scene)),
            size_texels,
            reflection_levels: scene_levels(size_texels),
            structure_levels: self.occlusion.map_or(1, |o| structure_levels(size_texels, o.resolution)),
            ..self
        }
    }

    /// Returns the frame without effects that stereo views lack: those that read other pixels, several samples, fog,
    /// blended and refractive surfaces. Shadow maps, the depth prepass, shading, the background and post-processing
    /// remain. The plan must inline post-processing into shading
    /// ([`Caps::inline`](framegraph::Caps::inline)).
    #[must_use]
    pub fn for_stereo(self) -> Self {
        let Self { shading, shadows, size_texels, stencil, sky, post, hdr_format, stored, split_post, .. } = self;
        let shadows = shadows.map(|shadows| ShadowSettings { contact: None, ..shadows });
        let (prepass, fxaa) = (true, false);
        let kept =
            Self { shading, shadows, size_texels, stencil, sky, post, hdr_format, stored, split_post, ..Self::DEFAULT };
        Self { prepass, fxaa, ..kept }
    }

    /// Returns handles of the main view in the size that it is drawn in ([`extent`](Self::extent)), without textures.
    pub fn handles(&self) -> Handles {
        Handles::for_view(crate::gpu_scene::view::ViewId::MAIN, self.extent())
    }

    /// Returns the size of the view's pictures: the frame's, or the share of it that [`Settings::upscale`] names.
    pub fn extent(&self) -> Extent {
        self.upscale.map_or(Extent::FRAME, |upscale| upscale.extent())
    }

    /// Returns the width and height in which the view is drawn, in texels, for a picture of `shown_px`. [`ViewSettings::size_px`]
    /// and [`Settings::for_scene`] take this size.
    ///
    /// [`ViewSettings::size_px`]: crate::gpu_scene::view::ViewSettings::size_px
    pub fn drawn_px(&self, shown_px: [u32; 2]) -> [u32; 2] {
        self.extent().texels(shown_px)
    }

    /// Returns true if motion vectors are drawn.
    pub(crate) fn draws_velocity(&self) -> bool {
        self.moving && self.taa.is_some()
    }

    /// Returns true if depth is drawn before the color pass. With several samples per texel, effects that read depth
    /// draw it with one sample; a prepass would draw all geometry a third time.
    fn draws_prepass(&self) -> bool {
        (self.prepass && (self.samples == 1 || !self.reads_structure())) || self.draws_velocity()
    }

    /// Returns true if contact shadows of the sun are traced.
    fn has_contact_shadows(&self) -> bool {
        self.shadows.is_some_and(|shadows| shadows.contact.is_some())
    }

    /// Returns the number of levels of the structure at full resolution.
    fn full_levels(&self) -> u8 {
        let occluded = self.occlusion.is_some_and(|own| own.occludes() && own.resolution == Resolution::Full);
        if occluded { self.structure_levels } else { 1 }
    }

    /// Returns true if an effect reads the depth of the scene before the color pass.
    pub(crate) fn reads_structure(&self) -> bool {
        self.occlusion.is_some_and(|own| own.occludes()) || self.reflections.is_some() || self.has_contact_shadows()
    }

    /// Returns true if blended surfaces have separate passes.
    fn draws_blended_apart(&self) -> bool {
        self.declared_transparency().is_unordered()
    }

    /// Returns true if drawing blended surfaces after depth of field was requested.
    fn wants_blending_after_blur(&self) -> bool {
        self.blended && self.dof.is_some_and(|dof| dof.blended_after && dof.is_seen())
    }

    /// Returns true if blended surfaces are drawn after depth of field.
    fn blends_after_blur(&self) -> bool {
        self.wants_blending_after_blur() && self.draws_blended_apart() && self.samples == 1 && self.taa.is_none()
    }

    /// Returns true if blended surfaces are sorted although an order-independent technique was requested.
    fn sorts_for_stencil(&self) -> bool {
        self.blended && self.blended_stencil && self.transparency.is_unordered()
    }

    /// Returns the technique for blended surfaces; `Sorted` if there are none, or if stencil needs their order.
    fn declared_transparency(&self) -> Transparency {
        if self.blended && !self.sorts_for_stencil() { self.transparency } else { Transparency::Sorted }
    }
}

/// Returns the number of refractive instances, clamped to 1…[`MAX_GLASS_LAYERS`].
fn glass_instances(scene: &Scene) -> u8 {
    let transmits = |m: MaterialId| scene.materials[m.index()].lobes().contains(Lobe::Transmission);
    let count = scene.instances.iter().filter(|instance| transmits(instance.material)).count();
    count.clamp(1, MAX_GLASS_LAYERS.into()) as u8
}

/// The frame's results.
#[derive(Clone, Copy, Debug)]
pub struct FrameIo {
    /// Scene-referred radiance times exposure, linear Rec.709, single-sampled.
    pub hdr: Texture,
    /// The finished picture.
    pub output: Texture,
    /// Readbacks of the measured values.
    pub measured: MeasuredTextures,
}

/// Declares the standard frame of the main view and writes its picture to `into`.
///
/// # Errors
/// Fails if `into` is of another graph, or of a format that cannot be rendered to.
pub fn standard<W: StandardWorld + ?Sized>(
    frame: &mut Frame<W>,
    settings: &Settings,
    into: Target,
) -> Result<FrameIo, StageError> {
    let handles = stages(settings).declare(frame, settings.handles(), into)?;
    let (hdr, output) = (handles.get(Slot::HDR)?, handles.get(Slot::PICTURE)?);
    Ok(FrameIo { hdr, output, measured: MeasuredTextures::of(&handles) })
}

/// Returns the stages of the standard frame. See the [module](self).
pub fn stages<W: StandardWorld + ?Sized>(settings: &Settings) -> Stages<W> {
    let s = *settings;
    let fxaa = match s.fxaa {
        true => Stage::picture("fxaa", move |frame, handles| fxaa(frame, handles, s.upscale)),
        false => Stage::new("fxaa", |_, _| Ok(())),
    };
    let upscale = match s.upscale {
        Some(own) => Stage::picture("upscale", move |frame, handles| enlarge(frame, handles, &own)),
        None => Stage::new("upscale", |_, _| Ok(())),
    };
    let Settings { samples, scene_levels, glass_layers, shading, fog, .. } = s;
    let transparency = s.declared_transparency();
    let after_blur = s.blends_after_blur();
    let apart = Blended { transparency, samples, shading, fog, after_blur };
    let glass = Glass { levels: scene_levels, layers: glass_layers, samples, shading, fog, transparency };
    Stages::of([
        Stage::new("shadow", move |frame, handles| shadow(frame, handles, s.shadows)),
        Stage::new("prepass", move |frame, handles| {
            prepass(frame, handles, s.samples, [s.draws_prepass(), s.draws_velocity(), s.stencil])?;
            full_structure(frame, handles, (s.has_contact_shadows() || s.reflections.is_some(), s.full_levels()))
        }),
        // If these stages declare no pass, prepass and color pass share a step.
        Stage::new("occlusion", move |frame, handles| {
            occlusion(frame, handles, s.occlusion, (s.structure_levels, s.shading.precision))
        }),
        Stage::new("reflection", move |frame, handles| {
            reflection(frame, handles, s.reflections, s.full_levels(), (s.reflection_levels, s.hdr_format))
        }),
        Stage::new("color", move |frame, handles| color(frame, handles, &s)),
        Stage::new("scene", move |frame, handles| scene(frame, handles, s.scene_levels)),
        Stage::new("transparent", move |frame, handles| {
            transparent(frame, handles, &glass)?;
            if s.sorts_for_stencil() {
                let requested = s.transparency.name();
                let note =
                    format_args!("blended surfaces are sorted instead of {requested}: their stencil needs an order");
                frame.graph_mut().note("blended", note);
            }
            if after_blur { Ok(()) } else { blended(frame, handles, &apart) }
        }),
        Stage::new("resolve", move |frame, handles| resolve(frame, handles, s.tone_resolve && s.samples > 1)),
        Stage::new("taa", move |frame, handles| s.taa.as_ref().map_or(Ok(()), |own| temporal(frame, handles, own))),
        Stage::new("measure", move |frame, handles| measure(frame, handles, s.measure)),
        Stage::new("dof", move |frame, handles| {
            dof(frame, handles, s.dof, s.size_texels)?;
            if s.wants_blending_after_blur() && !after_blur {
                let note = "blended surfaces are drawn before the blur: drawing them after it needs an order-independent \
                            technique, one sample and no temporal anti-aliasing";
                frame.graph_mut().note("dof", note);
            }
            if after_blur { blended(frame, handles, &apart) } else { Ok(()) }
        }),
        Stage::new("bloom", move |frame, handles| bloom(frame, handles, s.bloom, (s.size_texels, s.taa.is_some()))),
        Stage::picture("post", move |frame, handles| post(frame, handles, &s)),
        fxaa,
        upscale,
    ])
}

type Declared = Result<(), StageError>;

fn color<W: StandardWorld + ?Sized>(frame: &mut Frame<W>, handles: &mut Handles, settings: &Settings) -> Declared {
    let Settings { samples, shading, fog, blended, stencil, scene_levels, sky, hdr_format, .. } = *settings;
    let pass = Color {
        view: handles.view(),
        depth: match settings.draws_prepass() {
            true => ColorDepth::Prepass(handles.get(Slot::DEPTH)?),
            false => ColorDepth::Own(handles.extent()),
        },
        shadow: maps_of(handles),
        occlusion: handles.find(Slot::OCCLUSION),
        structure: handles.find(Slot::HALF_STRUCTURE),
        contact_depth: handles.find(Slot::STRUCTURE).filter(|_| settings.has_contact_shadows()),
        reflections: match handles.find(Slot::REFLECTIONS) {
            Some(found) => Some([found, handles.get(Slot::HIT_DISTANCE)?]),
            None => None,
        },
        samples,
        stencil,
        blended,
        transparency: settings.declared_transparency(),
        blended_depth: settings.blended_depth,
        opaque_only: scene_levels > 0,
        sky,
        format: hdr_format,
        into: match handles.find(Slot::HDR_HISTORY) {
            // The last pass that draws blended surfaces writes into it.
            Some(history) if !settings.draws_blended_apart() || settings.blends_after_blur() => history.into(),
            _ => Target::New,
        },
        shading,
        fog,
    };
    let io = frame.add("color", pass)?;
    handles.set(Slot::DEPTH, io.depth);
    handles.set(Slot::HDR, io.hdr);
    if samples > 1 {
        handles.set(Slot::HDR_SAMPLES, io.samples);
    }
    Ok(())
}

fn resolve<W: StandardWorld + ?Sized>(frame: &mut Frame<W>, handles: &mut Handles, wanted: bool) -> Declared {
    if wanted {
        let samples = handles.get(Slot::HDR_SAMPLES)?;
        handles.set(Slot::HDR, frame.add("tone_resolve", ToneResolve { samples })?.hdr);
    }
    Ok(())
}

fn post<W: StandardWorld + ?Sized>(frame: &mut Frame<W>, handles: &mut Handles, settings: &Settings) -> Declared {
    let bloom = mix_of(handles, settings.bloom, settings.size_texels);
    let Settings { fxaa, stored, split_post: split, upscale, .. } = *settings;
    let way = PostWay { fxaa, stored, split, upscale };
    picture::post(frame, handles, (settings.post, bloom), way)
}
