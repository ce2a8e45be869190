//! Runs a plan on symbols, from entry to exit.

use super::case::Case;
use super::machine::Machine;
use super::memory::{Memory, StoreRecord};
use super::reference::Value;
use super::stores;
use super::tile::{self, Tile};

/// What a run leaves for the phases that judge the decision log.
pub(super) struct Trace {
    /// Every op at the end of a step, with what became of it.
    pub(super) records: Vec<StoreRecord>,
    /// Every value that a load op brought into the tile: attachment of the plan, value.
    pub(super) loaded: Vec<(usize, Value)>,
}

/// Runs the plan from entry to exit.
pub(super) fn run(case: &Case<'_>) -> Trace {
    let mut machine = Machine { case, memory: Memory::on_entry(case.plan, &case.parts), loaded: Vec::new() };
    let mut tile = Tile::new(case.parts.total());
    for step in case.plan.step_ids() {
        if case.is_raster(step) {
            tile::raster(&mut machine, &mut tile, step);
            stores::store(&mut machine, &mut tile, step);
            tile.close();
        } else {
            for member in case.plan.passes_of(step) {
                machine.reads(step, *member, |_| true);
                machine.writes(step, *member);
            }
        }
    }
    machine.exit();
    machine.wasted();
    Trace { records: machine.memory.records, loaded: machine.loaded }
}
