//! Facts into settings.

use super::decided::{Amounts, Facts};
use super::effect::{Effect, EffectSet};
use super::fact::Decision;
use crate::effects::bloom::BloomSettings;
use crate::effects::dof::DofSettings;
use crate::effects::fog::FogSettings;
use crate::effects::occlusion::OcclusionSettings;
use crate::effects::reflection::ReflectionSettings;
use crate::effects::taa::TaaSettings;
use crate::effects::transmission::MAX_GLASS_LAYERS;
use crate::frame::Settings;
use crate::gpu_scene::shadow_views::{ContactShadows, ShadowSettings};
use framegraph::{Format, Graph};
use framegraph_scene::environment::ShBands;
use framegraph_shaders::layout::EdgeFade;

impl Facts {
    /// The settings without what is dropped. Views are to be made with the same: `ViewSettings::shadows` is the result's
    /// [`Settings::shadows`].
    #[must_use]
    pub fn apply(&self, settings: &Settings) -> Settings {
        self.apply_but(settings, EffectSet::NONE)
    }

    /// Writes what is dropped, and why, beside the decisions of the plan that the graph will have.
    pub fn note(&self, graph: &mut Graph) {
        for row in self.rows.iter().filter(|row| row.decision == Decision::Dropped) {
            graph.note(row.effect.name(), format_args!("dropped [{}]: {}", row.proof, row.reason));
        }
        for (proof, reason) in &self.always {
            graph.note("scene", format_args!("left out [{proof}]: {reason}"));
        }
    }

    /// The same with some effects left as they were asked for.
    #[must_use]
    pub fn apply_but(&self, settings: &Settings, kept: EffectSet) -> Settings {
        let dropped = self.dropped().iter().filter(|effect| !kept.contains(*effect));
        let mut applied = dropped.fold(*settings, |settings, effect| less(settings, effect, &self.amounts));
        applied.shadows = applied.shadows.filter(|shadows| shadows.layers() > 0);
        applied.measure = self.measure;
        applied
    }
}

impl Settings {
    /// The settings without an effect, whatever the scene calls for.
    #[must_use]
    pub fn without(self, effect: Effect) -> Self {
        let none = Amounts { lamp_maps: 0, lamp_layers: 0, glass_layers: 1, bands: ShBands::Two };
        let mut settings = less(self, effect, &none);
        settings.shadows = settings.shadows.filter(|shadows| shadows.layers() > 0);
        settings
    }

    /// The settings with an effect in its default strength, if they do not ask for it. What only a scene can call for
    /// ([`Effect::Transmission`], [`Effect::Blending`]) and what has no default strength ([`Effect::Grading`]) stays as it
    /// is.
    #[must_use]
    pub fn with(self, effect: Effect) -> Self {
        let mut s = self;
        if s.has(effect) {
            return s;
        }
        let (default, none) = (Self::DEFAULT, ShadowSettings { cascades: 0, local_maps: 0, ..ShadowSettings::DEFAULT });
        match effect {
            Effect::SunShadows => s.shadows.get_or_insert(none).cascades = 1,
            Effect::LampShadows => s.shadows.get_or_insert(none).local_maps = 12,
            Effect::Cascades => s.shadows.get_or_insert(none).cascades = 4,
            Effect::ContactShadows => {
                s.shadows.get_or_insert(ShadowSettings::DEFAULT).contact = Some(ContactShadows::FILAMENT);
            }
            Effect::Occlusion => s.occlusion = Some(OcclusionSettings::SAO),
            Effect::Reflections => s.reflections = Some(ReflectionSettings::DEFAULT),
            Effect::GlassLayers => s.glass_layers = MAX_GLASS_LAYERS,
            Effect::EnergyCompensation => (s.shading.compensate_image, s.shading.compensate_punctual) = (true, true),
            Effect::SpecularAa => s.shading.specular_aa = default.shading.specular_aa,
            Effect::ShBands => s.shading.bands = ShBands::Three,
            Effect::OcclusionShading => (s.shading.multi_bounce, s.shading.specular_occlusion) = (true, true),
            Effect::MicroShadows => s.shading.micro_shadows = true,
            Effect::Sky => s.sky = true,
            Effect::Vignette => s.post.vignette_ev = 0.5,
            Effect::EdgeFade => s.post.edge_fade = Some(EdgeFade::DEFAULT),
            Effect::Dither => s.post.dither = 1.0,
            Effect::HdrTarget => s.hdr_format = default.hdr_format,
            Effect::Fxaa => s.fxaa = true,
            Effect::Msaa => s.samples = 4,
            Effect::Taa => s.taa = Some(TaaSettings::DEFAULT),
            Effect::Fog => s.fog = Some(FogSettings::DEFAULT),
            Effect::DepthOfField => s.dof = Some(DofSettings::DEFAULT),
            Effect::Bloom => s.bloom = Some(BloomSettings::DEFAULT),
            Effect::Prepass => s.prepass = true,
            Effect::Transmission | Effect::Blending | Effect::Grading => {}
        }
        s
    }

    /// Returns true if the settings request an effect.
    #[must_use]
    pub fn has(&self, effect: Effect) -> bool {
        *self != self.without(effect)
    }
}

/// Returns settings without an effect, or with the reduced amounts.
fn less(settings: Settings, effect: Effect, amounts: &Amounts) -> Settings {
    let mut s = settings;
    match effect {
        Effect::SunShadows => s.shadows.iter_mut().for_each(|shadows| shadows.cascades = 0),
        Effect::LampShadows => s.shadows.iter_mut().for_each(|shadows| {
            shadows.local_maps = amounts.lamp_maps;
            shadows.local_layers = if amounts.lamp_maps > 0 { amounts.lamp_layers } else { shadows.local_layers };
        }),
        Effect::Cascades => s.shadows.iter_mut().for_each(|shadows| shadows.cascades = shadows.cascades.min(1)),
        Effect::ContactShadows => s.shadows.iter_mut().for_each(|shadows| shadows.contact = None),
        Effect::Occlusion => s.occlusion = None,
        Effect::Reflections => s.reflections = None,
        Effect::Transmission => s.scene_levels = 0,
        Effect::GlassLayers => s.glass_layers = amounts.glass_layers,
        Effect::Blending => s.blended = false,
        Effect::EnergyCompensation => (s.shading.compensate_image, s.shading.compensate_punctual) = (false, false),
        Effect::SpecularAa => s.shading.specular_aa = None,
        Effect::ShBands => s.shading.bands = amounts.bands,
        Effect::OcclusionShading => (s.shading.multi_bounce, s.shading.specular_occlusion) = (false, false),
        Effect::MicroShadows => s.shading.micro_shadows = false,
        Effect::Sky => s.sky = false,
        Effect::Vignette => s.post.vignette_ev = 0.0,
        Effect::EdgeFade => s.post.edge_fade = None,
        Effect::Grading => s.post.look.grading = framegraph_shaders::layout::Grading::NEUTRAL,
        Effect::Dither => s.post.dither = 0.0,
        Effect::HdrTarget => s.hdr_format = Format::Rgba8UnormSrgb,
        Effect::Fxaa => s.fxaa = false,
        Effect::Msaa => s.samples = 1,
        Effect::Taa => s.taa = None,
        Effect::Fog => s.fog = None,
        Effect::DepthOfField => s.dof = None,
        Effect::Bloom => s.bloom = None,
        Effect::Prepass => s.prepass = false,
    }
    s
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PostSettings;
    use framegraph_shaders::layout::Grading;

    /// Each effect is one difference of the settings, and taking one leaves the others.
    #[test]
    fn every_effect_can_be_left_out_alone() {
        let shadows = ShadowSettings {
            cascades: 4,
            local_maps: 6,
            contact: Some(ContactShadows::FILAMENT),
            ..ShadowSettings::DEFAULT
        };
        let mut post = PostSettings { vignette_ev: 1.0, edge_fade: Some(EdgeFade::DEFAULT), ..PostSettings::DEFAULT };
        post.look.grading = Grading { contrast: 1.2, ..Grading::NEUTRAL };
        let all = Settings {
            samples: 4,
            shadows: Some(shadows),
            occlusion: Some(OcclusionSettings::SAO),
            reflections: Some(ReflectionSettings::DEFAULT),
            taa: Some(TaaSettings::DEFAULT),
            fog: Some(FogSettings::DEFAULT),
            dof: Some(DofSettings::DEFAULT),
            bloom: Some(BloomSettings::DEFAULT),
            scene_levels: 4,
            glass_layers: 3,
            blended: true,
            post,
            ..Settings::DEFAULT
        };
        for effect in Effect::ALL {
            let without = all.without(effect);
            assert!(all.has(effect) && !without.has(effect), "{effect:?}");
            // The sun's maps are one, several, or none.
            let beside = |other: &Effect| (effect, *other) != (Effect::SunShadows, Effect::Cascades);
            let others = Effect::ALL.into_iter().filter(|other| *other != effect).filter(beside);
            assert!(others.clone().all(|other| without.has(other)), "{effect:?}");
        }
        let bare = Effect::ALL.into_iter().fold(all, Settings::without);
        let of_scenes = [Effect::Transmission, Effect::Blending, Effect::Grading];
        for effect in Effect::ALL {
            assert_eq!(bare.with(effect).has(effect), !of_scenes.contains(&effect), "{effect:?}");
            assert_eq!(all.with(effect), all, "{effect:?}");
        }
        assert!(bare.shadows.is_none() && Effect::ALL.into_iter().all(|effect| !bare.has(effect)));
    }
}
