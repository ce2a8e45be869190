//! Fault injection: plans with one decision broken on purpose, to see whether a back end, or whatever judges it, notices.
//!
//! A test that compares pictures, contents or counts proves nothing until it fails on a wrong plan. [`Plan::with_fault`]
//! makes one; nothing else can, because a plan's fields cannot be written from outside.

use crate::id::ResourceId;
use crate::plan::{LoadOp, Placement, Plan, StoreOp};
use crate::resource::{Desc, Extent};

/// One broken decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The planes of an attachment (a row of [`Plan::attachments`]) that are loaded from memory begin with this instead.
    Load {
        /// The row.
        attachment: usize,
        /// What they begin with.
        op: LoadOp,
    },
    /// The planes of an attachment that are stored are dropped instead.
    Discard {
        /// The row.
        attachment: usize,
    },
    /// A resource is put in the place of another one, whether or not that is still in use.
    Share {
        /// What is moved.
        resource: ResourceId,
        /// Whose place it gets.
        with: ResourceId,
    },
}

impl Plan {
    /// Every fault of these kinds that this plan can have: each load as a clear and as don't-care, each store dropped, and
    /// each pair of resources of one shape that are in use at once and do not share a place yet.
    pub fn faults(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        for (attachment, row) in self.attachments.iter().enumerate() {
            if row.loads() {
                faults.extend([LoadOp::Clear, LoadOp::DontCare].map(|op| Fault::Load { attachment, op }));
            }
            if row.stores() {
                faults.push(Fault::Discard { attachment });
            }
        }
        let rows: Vec<_> = self.graph.resource_ids().zip(self.graph.resources().iter().zip(&self.resources)).collect();
        for (at, (resource, (declared, row))) in rows.iter().enumerate() {
            let movable = |p: Placement| matches!(p, Placement::Slot(_) | Placement::Heap { .. });
            for (with, (other, second)) in &rows[at + 1..] {
                let at_once = row.first <= second.last && second.first <= row.last;
                let apart = movable(row.placement) && movable(second.placement) && row.placement != second.placement;
                if at_once && apart && self.solid(declared.desc) == self.solid(other.desc) {
                    faults.push(Fault::Share { resource: *resource, with: *with });
                }
            }
        }
        faults
    }

    /// A shape with its size counted out.
    fn solid(&self, desc: Desc) -> Desc {
        let Desc::Texture(texture) = desc else { return desc };
        let [width, height] = texture.extent.resolve(self.frame());
        let mips = texture.mip_count(self.frame()).min(255) as u8;
        Desc::Texture(texture.extent(Extent::absolute(width, height)).mips(mips))
    }

    /// The plan with one decision broken. Its counts and its log stay as they were.
    ///
    /// # Panics
    /// When the fault names a row that the plan does not have.
    #[must_use]
    pub fn with_fault(&self, fault: Fault) -> Self {
        let mut broken = self.clone();
        match fault {
            Fault::Load { attachment, op } => {
                let row = &mut broken.attachments[attachment];
                for load in [&mut row.load, &mut row.stencil_load] {
                    if *load == LoadOp::Load {
                        *load = op;
                    }
                }
            }
            Fault::Discard { attachment } => {
                let row = &mut broken.attachments[attachment];
                for store in [&mut row.store, &mut row.stencil_store] {
                    if *store == StoreOp::Store {
                        *store = StoreOp::Discard;
                    }
                }
            }
            Fault::Share { resource, with } => {
                broken.resources[resource.index()].placement = broken.resources[with.index()].placement;
            }
        }
        broken
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::check;
    use crate::generate::{self, Entropy, Profile};
    use crate::{Caps, Scratch, compile};

    #[test]
    fn every_fault_is_a_violation() {
        let (mut plan, mut kinds) = (Plan::new(), [0; 3]);
        for seed in 0..200 {
            let graph = generate::graph(&mut Entropy::seeded(seed), &Profile::default());
            let options = generate::options_of(seed as u32);
            let compiled = compile(&graph, &Caps::wgpu(), &options, &mut Scratch::new(), &mut plan);
            assert_eq!((compiled, check(&plan)), (Ok(()), Ok(())), "seed {seed}");
            for fault in plan.faults() {
                kinds[match fault {
                    Fault::Load { .. } => 0,
                    Fault::Discard { .. } => 1,
                    Fault::Share { .. } => 2,
                }] += 1;
                assert!(
                    check(&plan.with_fault(fault)).is_err(),
                    "seed {seed}: {fault:?}\n{}",
                    crate::dump::text(&plan)
                );
            }
        }
        assert!(kinds.iter().all(|k| *k > 20), "{kinds:?}");
    }
}
