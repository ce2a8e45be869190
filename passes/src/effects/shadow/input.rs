//! The shadow maps as passes that shade take them.

use crate::gpu_scene::shadow_views::ShadowFilter;
use crate::gpu_scene::view::GpuView;
use framegraph::{DeclareError, PassBuilder, Texture, View};
use framegraph_shaders::{Feature, Features};
use framegraph_wgpu::{Binding, Cx, RecordError, SamplerDesc, ViewPart};
use wgpu::TextureViewDimension;

/// The shadow maps of a view, declared to be read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadowInput {
    view: View,
    layers: u16,
}

impl ShadowInput {
    /// Declares that the pass reads the maps, where there are any.
    pub fn declare(maps: Option<Texture>, pass: &mut PassBuilder<'_>) -> Result<Option<Self>, DeclareError> {
        let Some(maps) = maps else { return Ok(None) };
        let layers = pass.desc(maps)?.layers;
        Ok(Some(Self { view: pass.sampled(maps)?, layers }))
    }
}

/// What is bound of the shadow maps, and what shaders are compiled with to read them.
#[derive(Debug, Default)]
pub(crate) struct ShadowBindings {
    /// In the order of [`ShadowBindings::NAMES`].
    pub bindings: [Option<Binding>; Self::NAMES.len()],
    pub features: Features,
    /// In the order of [`ShadowBindings::CONSTANTS`].
    pub constants: [f64; Self::CONSTANTS.len()],
}

impl ShadowBindings {
    /// Names of the variables.
    pub const NAMES: [&'static str; 6] =
        ["shadow", "local_maps", "shadow_map", "shadow_sampler", "shadow_depth", "shadow_moments"];

    /// Names of the `override` constants: steps of the ray of contact shadows, what there are maps of, whether shadows of the
    /// sun have an end, and whether any are weaker than 1.
    pub const CONSTANTS: [&'static str; 6] =
        ["CONTACT_STEPS", "CASCADES", "SHADOWS_END", "LAMP_SHADOWS", "WEAK_SHADOWS", "SHOW_CASCADES"];

    /// The bindings for a view: none where it has no maps.
    pub fn new(input: Option<ShadowInput>, view: &GpuView, cx: &mut Cx<'_>) -> Result<Self, RecordError> {
        let Some(ShadowInput { view: maps, layers }) = input else { return Ok(Self::default()) };
        let shadows = view.shadows(layers)?;
        let feature = match shadows.settings.filter {
            ShadowFilter::Pcf => Feature::SHADOWS,
            ShadowFilter::Dpcf | ShadowFilter::Pcss => Feature::SHADOW_SOFT,
            ShadowFilter::Vsm | ShadowFilter::Evsm => Feature::SHADOW_MOMENTS,
        };
        let part = ViewPart::as_dimension(TextureViewDimension::D2Array);
        let texture: Binding = cx.view_part(maps, part)?.into();
        let bindings = [
            cx.uniform(&shadows.uniforms),
            view.local_maps.clone().into(),
            texture.clone(),
            cx.sampler(SamplerDesc::SHADOW).into(),
            texture.clone(),
            texture,
        ];
        let constants = [
            shadows.settings.contact.map_or(0, |contact| contact.steps.max(1)),
            shadows.cascades as u32,
            u32::from(shadows.settings.far_m.is_some()),
            u32::from(shadows.maps.len() > shadows.cascades),
            u32::from(shadows.are_weak),
            u32::from(shadows.settings.show_cascades),
        ];
        let features = Features::NONE.with(feature);
        Ok(Self { bindings: bindings.map(Some), features, constants: constants.map(f64::from) })
    }
}
