//! Feature culling: decides on the CPU, before a frame is declared, which effects its scene needs.
//!
//! ```text
//! Scene ──> SceneSummary ──────┐
//! cameras, light ──────────────┼─> decide ──> Facts (one row per effect) ──> apply ──> Settings ──> stages ──> Plan
//! requested Settings ──────────┤      └── FactMemory, kept across frames
//! Measurement ─────────────────┘      of previous frames, if they are measured
//! ```
//!
//! | file | content |
//! | --- | --- |
//! | `effect.rs`, `fact.rs` | effects; a decision: kept or dropped, its bound, its reason |
//! | `rule_input.rs`, `decided.rs` | input and output of the rules |
//! | `scene_summary.rs` | camera-independent properties of meshes and materials |
//! | `visibility.rs`, `occluders.rs` | visible instances; occluders that cover the whole picture |
//! | `shadows.rs`, `shading.rs`, `screen.rs`, `picture.rs`, `lens.rs`, `overdraw.rs`, `readback_rules.rs` | rules |
//! | `memory.rs` | hysteresis, so that effects do not flicker at thresholds |
//! | `apply.rs` | applies decisions to settings |
//! | `savings.rs`, `report.rs` | savings of each dropped effect; report as text and JSON |
//!
//! Rules are conservative: they use bounds, and keep an effect if a value is unknown. A dropped effect declares no
//! pass, and shaders are compiled without it. `docs/design/feature-culling.md` has every rule with its bound.
//!
//! This folder may use [`frame`](crate::frame), [`effects`](crate::effects) and every folder that these use. Only
//! [`quality`](crate::quality) may use it.

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

/// Decides which effects the frame needs. Pass the `memory` of the previous frame, or a new one.
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
    // Effects that depend on another effect stay while that effect stays.
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
