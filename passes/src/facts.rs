//! Facts: which effects a frame's scene calls for, proved on the CPU before the frame is declared.
//!
//! ```text
//! Scene ──> Survey ─┐
//! cameras, light ───┼─> decide ──> Facts (a row an effect) ──> apply ──> Settings ──> stages ──> Plan
//! Settings asked ───┘      └── FactMemory, kept from frame to frame
//! ```
//!
//! | file | what |
//! | --- | --- |
//! | `effect.rs`, `fact.rs` | the effects; a row: kept or dropped, the class of its proof, the reason |
//! | `survey.rs` | what is known of meshes and materials whatever the camera is |
//! | `seen.rs`, `cover.rs` | what cameras may see; what covers the whole picture |
//! | `shadows.rs`, `shading.rs`, `screen.rs`, `picture.rs`, `lens.rs` | the rules |
//! | `memory.rs` | effects do not flicker at thresholds |
//! | `apply.rs` | facts into settings |
//! | `savings.rs`, `told.rs` | what each drop saves; text and JSON |
//!
//! Rules are conservative: bounds are of boxes and factors, what is unknown is kept, and what is dropped is dropped with its
//! readers: shaders are other variants then, so that nothing reads a texture that nobody wrote. `docs/facts.md` has every rule
//! with its bound.

mod apply;
mod cover;
mod effect;
mod fact;
mod lens;
mod memory;
mod picture;
mod savings;
mod screen;
mod seen;
mod shading;
mod shadows;
mod survey;
mod told;

pub use effect::{Effect, EffectSet};
pub use fact::{Decision, Fact, Proof};
pub use memory::FactMemory;
pub use savings::{Cost, CostError, Saved, costs, savings};
pub use survey::Survey;
pub use told::FACTS_VERSION;

use crate::frame::Settings;
use crate::ibl::{IRRADIANCE_COEFFICIENTS, ImageLight};
use crate::punctual::{DropReason, select};
use crate::shadow::ShadowNeed;
use crate::sun::sun_of;
use crate::view::{Background, ViewSettings};
use framegraph_scene::environment::ShBands;
use framegraph_scene::{Light, Scene};
use glam::Vec4;
use seen::{Seen, Surfaces, fit_camera};

/// Light from all around, as far as facts look at it.
#[derive(Clone, Copy, Debug)]
pub struct Around<'a> {
    /// [`ImageLight::irradiance`].
    pub irradiance: &'a [Vec4; IRRADIANCE_COEFFICIENTS],
    /// [`ImageLight::bands`].
    pub bands: ShBands,
    /// [`ImageLight::luminance_nits`].
    pub luminance_nits: f32,
    /// [`ImageLight::sun`].
    pub sun: Option<&'a Light>,
}

impl<'a> From<&'a ImageLight> for Around<'a> {
    fn from(light: &'a ImageLight) -> Self {
        let ImageLight { irradiance, bands, luminance_nits, sun, .. } = light;
        Self { irradiance, bands: *bands, luminance_nits: *luminance_nits, sun: sun.as_ref() }
    }
}

/// What is decided about.
#[derive(Clone, Copy, Debug)]
pub struct FactInput<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// What is known of its surfaces, of the same scene.
    pub survey: &'a Survey,
    /// Light from all around.
    pub around: Around<'a>,
    /// What stands behind everything.
    pub background: &'a Background,
    /// Cameras with sizes and exposures: of one view, or of all that share a frame's settings. Their shadows are not looked
    /// at: those of `settings` count.
    pub views: &'a [ViewSettings],
    /// The frame as it is asked for.
    pub settings: &'a Settings,
    /// Effects that stay whatever the facts are.
    pub forced: EffectSet,
    /// Drops that may change a pixel by more codes of 255 than this are not made.
    pub most_codes: f32,
}

impl FactInput<'_> {
    /// The usual tolerance: what a drop may change, in codes of 255.
    pub const MOST_CODES: f32 = 2.0;
}

/// What was decided about a frame.
#[derive(Clone, Debug, Default)]
pub struct Facts {
    /// A row for each effect that the settings ask for, in the order of [`Effect::ALL`].
    pub rows: Vec<Fact>,
    /// What the frame leaves out by its structure, whatever is forced: lights that reach nothing, variants of shaders that
    /// nothing in view needs. The class of the proof, and a sentence.
    pub always: Vec<(Proof, String)>,
    /// Of what is not left out altogether, how much is made.
    amounts: Amounts,
}

/// How much is made of an effect that is dropped in part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Amounts {
    lamp_maps: u8,
    lamp_layers: u8,
    glass_layers: u8,
    bands: ShBands,
}

impl Facts {
    /// What is dropped.
    pub fn dropped(&self) -> EffectSet {
        self.rows.iter().filter(|row| row.decision == Decision::Dropped).map(|row| row.effect).collect()
    }

    /// The row of an effect; none where the settings do not ask for it.
    pub fn of(&self, effect: Effect) -> Option<&Fact> {
        self.rows.iter().find(|row| row.effect == effect)
    }
}

/// Decides which effects the frame needs. `memory` is that of the frame before, or a new one.
#[must_use]
pub fn decide(input: &FactInput<'_>, memory: &mut FactMemory) -> Facts {
    let case = Case::new(input, memory);
    let mut facts = Facts { always: case.always(), ..Facts::default() };
    shadows::rules(&case, &mut facts);
    screen::rules(&case, &mut facts);
    shading::rules(&case, &mut facts);
    picture::rules(&case, &mut facts);
    lens::rules(&case, &mut facts);
    facts.rows.sort_by_key(|row| row.effect);
    let unneeded = facts.dropped();
    for row in &mut facts.rows {
        let too_much = matches!(row.proof, Proof::Codes(codes) if codes.is_nan() || codes > input.most_codes);
        if row.decision == Decision::Dropped && input.forced.contains(row.effect) {
            (row.decision, row.reason) = (Decision::Kept, format!("forced; {}", row.reason));
        } else if row.decision == Decision::Dropped && too_much {
            row.decision = Decision::Kept;
            row.reason = format!("{}, but the picture may change by more than {} codes", row.reason, input.most_codes);
        }
    }
    let settled = memory.settle(facts.dropped());
    for row in facts.rows.iter_mut().filter(|row| row.decision == Decision::Dropped && !settled.contains(row.effect)) {
        row.decision = Decision::Kept;
        row.reason = format!("{}; it goes in {} frames", row.reason, memory.waits(row.effect));
    }
    // What goes because another does stays while that stays.
    for (effect, with) in [
        (Effect::OcclusionShading, Effect::Occlusion),
        (Effect::Cascades, Effect::SunShadows),
        (Effect::ContactShadows, Effect::SunShadows),
    ] {
        let held = unneeded.contains(with) && !facts.dropped().contains(with);
        if let Some(row) = facts.rows.iter_mut().find(|row| held && row.effect == effect) {
            row.decision = Decision::Kept;
            row.reason = format!("`{}` stays", with.name());
        }
    }
    facts
}

/// What rules look at.
struct Case<'a> {
    input: &'a FactInput<'a>,
    settings: &'a Settings,
    memory: &'a FactMemory,
    seen: Seen<'a>,
    surfaces: Surfaces,
    /// The sun, if it is on and something in view may turn toward it.
    sun: Option<&'a Light>,
    /// The sun, if it is on.
    risen: Option<&'a Light>,
    need: ShadowNeed,
    /// Lights of the scene but the sun: how many count, and why the others do not.
    lights: (usize, Vec<(usize, DropReason)>),
}

impl<'a> Case<'a> {
    fn new(input: &'a FactInput<'a>, memory: &'a FactMemory) -> Self {
        let FactInput { scene, survey, views, settings, .. } = *input;
        let seen = Seen::new(scene, survey, views);
        let risen = sun_of(scene, input.around.sun);
        let sun = risen.filter(|sun| seen.may_face(-sun.direction.as_dvec3()));
        let cameras: Vec<_> = views.iter().map(fit_camera).collect();
        let selection = select(scene, &seen.renderables, risen, &cameras);
        let need = match &settings.shadows {
            Some(shadows) => ShadowNeed::of(&seen.renderables, sun, &selection.kept, &cameras, shadows),
            None => ShadowNeed::default(),
        };
        let lights = (selection.kept.len(), selection.dropped);
        Self { input, settings, memory, surfaces: seen.surfaces(), seen, sun, risen, need, lights }
    }

    /// What the frame leaves out by its structure.
    fn always(&self) -> Vec<(Proof, String)> {
        let mut told = Vec::new();
        let (kept, dropped) = &self.lights;
        if !dropped.is_empty() {
            let mut reasons: Vec<(String, usize)> = Vec::new();
            for reason in dropped.iter().map(|(_, reason)| reason.to_string()) {
                match reasons.iter_mut().find(|(known, _)| *known == reason) {
                    Some((_, count)) => *count += 1,
                    None => reasons.push((reason, 1)),
                }
            }
            let reasons: Vec<_> = reasons.into_iter().map(|(reason, count)| format!("{count} {reason}")).collect();
            let all = kept + dropped.len();
            told.push((
                Proof::Exact,
                format!("{} of {all} lights are not looked at: {}", dropped.len(), reasons.join(", ")),
            ));
        }
        let (scene, seen) = (self.seen.scene.lobes(), self.surfaces.lobes);
        let unused: Vec<_> =
            framegraph_scene::Lobe::ALL.iter().filter(|l| scene.contains(**l) && !seen.contains(**l)).collect();
        if !unused.is_empty() {
            told.push((Proof::Variant, format!("no shader of the lobes {unused:?}: nothing in view has them")));
        }
        let dark = self.input.survey.surfaces.iter().filter(|surface| surface.dark_emission).count();
        if dark > 0 {
            told.push((Proof::Exact, format!("{dark} textures of emission are not fetched: their factor is 0")));
        }
        told
    }

    /// Whether no light comes from all around.
    fn is_dark(&self) -> bool {
        let Around { irradiance, luminance_nits, .. } = self.input.around;
        let none = luminance_nits == 0.0 && irradiance.iter().all(|c| *c == Vec4::ZERO);
        none || self.input.views.iter().all(|view| view.environment_intensity == 0.0)
    }
}
