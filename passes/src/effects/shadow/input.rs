//! Bindings of the shadow maps for shading passes.

use crate::error::PassError;
use crate::gpu_scene::shadow_views::{ShadowFilter, ShadowMaps};
use crate::gpu_scene::view::{GpuView, ViewId, Views};
use framegraph::{DeclareError, PassBuilder, View};
use framegraph_shaders::{Feature, Features};
use framegraph_wgpu::{Binding, Cx, RecordError, SamplerDesc, ViewPart};
use wgpu::TextureViewDimension;

/// Shadow maps of a view, declared as read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadowInput {
    view: View,
    layers: u16,
    /// View that the maps are drawn for.
    drawn: ViewId,
}

impl ShadowInput {
    /// Declares the maps as read, if there are any.
    pub fn declare(maps: Option<ShadowMaps>, pass: &mut PassBuilder<'_>) -> Result<Option<Self>, DeclareError> {
        let Some(maps) = maps else { return Ok(None) };
        let layers = pass.desc(maps.texture)?.layers;
        Ok(Some(Self { view: pass.sampled(maps.texture)?, layers, drawn: maps.view }))
    }
}

/// Bindings of the shadow maps, and the features and constants of shaders that read them.
#[derive(Debug, Default)]
pub(crate) struct ShadowBindings {
    /// Bindings in the order of [`ShadowBindings::NAMES`].
    pub bindings: [Option<Binding>; Self::NAMES.len()],
    pub features: Features,
    /// Values in the order of [`ShadowBindings::CONSTANTS`].
    pub constants: [f64; Self::CONSTANTS.len()],
}

impl ShadowBindings {
    /// Names of the variables.
    pub const NAMES: [&'static str; 6] =
        ["shadow", "local_maps", "shadow_map", "shadow_sampler", "shadow_depth", "shadow_moments"];

    /// Names of the `override` constants: steps of contact shadows, whether the sun and punctual lights have maps, and
    /// whether the sun's shadows end. Then whether any shadow is weaker than 1, and whether cascades are displayed.
    pub const CONSTANTS: [&'static str; 6] =
        ["CONTACT_STEPS", "CASCADES", "SHADOWS_END", "LAMP_SHADOWS", "WEAK_SHADOWS", "SHOW_CASCADES"];

    /// Creates the bindings for a view; empty without maps.
    pub fn new(
        input: Option<ShadowInput>,
        (view, views): (&GpuView, &Views),
        cx: &mut Cx<'_>,
    ) -> Result<Self, RecordError> {
        let Some(ShadowInput { view: maps, layers, drawn }) = input else { return Ok(Self::default()) };
        let shadows = view.shadows(layers)?;
        if drawn != view.id && !views.get(drawn)?.shadows(layers)?.fits(shadows) {
            return Err(PassError::ShadowMapsApart { view: view.id.0, drawn: drawn.0 }.into());
        }
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
