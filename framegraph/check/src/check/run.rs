//! Runs a plan on symbolic values.

use super::machine::Machine;
use super::memory::{Memory, StoreRecord};
use super::reference::Value;
use super::rule_input::RuleInput;
use super::stores;
use super::tile::{self, Tile};

/// Results of a run, used to check the decision log.
pub(super) struct Trace {
    /// Every store operation with the later uses of its contents.
    pub(super) records: Vec<StoreRecord>,
    /// Every value loaded into the tile, as (attachment of the plan, value).
    pub(super) loaded: Vec<(usize, Value)>,
}

/// Runs the plan from the start to the end of the frame.
pub(super) fn run(ctx: &RuleInput<'_>) -> Trace {
    let mut machine = Machine { ctx, memory: Memory::on_entry(ctx.plan, &ctx.parts), loaded: Vec::new() };
    let mut tile = Tile::new(ctx.parts.total());
    for step in ctx.plan.step_ids() {
        if ctx.is_raster(step) {
            tile::raster(&mut machine, &mut tile, step);
            stores::store(&mut machine, &mut tile, step);
            tile.close();
        } else {
            for member in ctx.plan.passes_of(step) {
                machine.reads(step, *member, |_| true);
                machine.writes(step, *member);
            }
        }
    }
    machine.exit();
    machine.wasted();
    Trace { records: machine.memory.records, loaded: machine.loaded }
}
