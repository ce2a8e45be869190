//! Runs a plan on symbolic values.

use super::case::Case;
use super::machine::Machine;
use super::memory::{Memory, StoreRecord};
use super::reference::Value;
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
