//! Facts: which effects a frame's scene calls for, proved on the CPU before the frame is declared.
//!
//! ```text
//! Scene ──> SceneSummary ─┐
//! cameras, light ───┼─> decide ──> Facts (a row an effect) ──> apply ──> Settings ──> stages ──> Plan
//! Settings asked ───┤      └── FactMemory, kept from frame to frame
//! Measurement ──────┘      of frames before (`measure.rs`), where they are measured
//! ```
//!
//! | file | what |
//! | --- | --- |
//! | `effect.rs`, `fact.rs` | the effects; a row: kept or dropped, the class of its proof, the reason |
//! | `case.rs`, `decided.rs` | what rules look at; what they decide |
//! | `survey.rs` | what is known of meshes and materials whatever the camera is |
//! | `seen.rs`, `cover.rs` | what cameras may see; what covers the whole picture |
//! | `shadows.rs`, `shading.rs`, `screen.rs`, `picture.rs`, `lens.rs`, `overdraw.rs`, `late.rs` | the rules |
//! | `memory.rs` | effects do not flicker at thresholds |
//! | `apply.rs` | facts into settings |
//! | `savings.rs`, `told.rs` | what each drop saves; text and JSON |
//!
//! Rules are conservative: bounds are of boxes and factors, what is unknown is kept, and what is dropped is dropped with its
//! readers: shaders are other variants then, so that nothing reads a texture that nobody wrote. `docs/design/feature-culling.md` has every rule
//! with its bound.

mod apply;
mod decided;
mod effect;
mod fact;
mod lens;
mod memory;
mod occluders;
mod overdraw;
mod picture;
mod readback_rules;
mod report;
mod rule_input;
mod savings;
mod scene_summary;
mod screen;
mod shading;
mod shadows;
mod visibility;

pub use decided::Facts;
pub use effect::{Effect, EffectSet};
pub use fact::{Decision, Fact, Proof};
pub use memory::FactMemory;
pub use report::FACTS_VERSION;
pub use rule_input::{EnvironmentSummary, FactInput};
pub use savings::{Cost, CostError, Saved, costs, savings};
pub use scene_summary::SceneSummary;

use rule_input::RuleInput;

/// Decides which effects the frame needs. `memory` is that of the frame before, or a new one.
#[must_use]
pub fn decide(input: &FactInput<'_>, memory: &mut FactMemory) -> Facts {
    let case = RuleInput::new(input, memory);
    let mut facts = Facts { always: case.always(), ..Facts::default() };
    shadows::rules(&case, &mut facts);
    screen::rules(&case, &mut facts);
    shading::rules(&case, &mut facts);
    picture::rules(&case, &mut facts);
    lens::rules(&case, &mut facts);
    overdraw::rules(&case, &mut facts);
    facts.rows.sort_by_key(|row| row.effect);
    let unneeded = facts.dropped();
    for row in &mut facts.rows {
        let too_much = matches!(row.proof, Proof::Codes(codes) if codes.is_nan() || codes > input.max_steps);
        if row.decision == Decision::Dropped && input.forced.contains(row.effect) {
            (row.decision, row.reason) = (Decision::Kept, format!("forced; {}", row.reason));
        } else if row.decision == Decision::Dropped && too_much {
            row.decision = Decision::Kept;
            row.reason = format!("{}, but the picture may change by more than {} codes", row.reason, input.max_steps);
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
