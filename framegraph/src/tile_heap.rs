//! Textures that stay in on-chip memory from step to step.
//!
//! Some tile-based GPUs offer a part of their tile memory as a heap whose contents persist across render passes and
//! dispatches (`VK_QCOM_tile_memory_heap`). A texture in this heap is loaded, stored and read without external memory.
//! The heap is small, so [`Plan::tile_heap`] chooses the textures that save the most traffic and fit together.
//!
//! The choice is an addition to a plan: steps, operations and other placements stay the same. A back end places the
//! chosen textures at their offsets of the tile heap instead of their planned memory.
//!
//! # Method
//!
//! Candidates are transient textures with memory. Each saves the bytes of its loads and stores, and of reads by
//! shaders, counting each accessed part once for each pass. A branch-and-bound search over subsets packs each of them
//! with [`crate::pack`]. The result has the packer's certificate, and an upper bound of the savings of any subset.

use crate::access::{Access, AccessKind, Range};
use crate::format::Aspect;
use crate::graph::PassKind;
use crate::id::{ResourceId, StepId};
use crate::options::Effort;
use crate::pack::{self, Interval, Packing, pack};
use crate::plan::{Join, Placement, Plan};
use crate::resource::{Desc, Kind};

/// A texture in the tile heap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kept {
    /// The texture.
    pub resource: ResourceId,
    /// Offset in the tile heap, in bytes.
    pub offset: u64,
    /// Size in bytes.
    pub bytes: u64,
    /// Bytes of external traffic that it avoids in a frame.
    pub saved_bytes: u64,
}

/// The textures of a plan that stay in the tile heap.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TileHeap {
    /// The textures, by resource.
    pub kept: Vec<Kept>,
    /// Certificate of the packer for these textures: the bytes in use, and a lower bound of any packing of them.
    pub packing: Packing,
    /// Bytes of external traffic that all of them avoid in a frame.
    pub saved_bytes: u64,
    /// No choice of textures that fits the heap saves more than this.
    pub bound_bytes: u64,
}

impl TileHeap {
    /// Returns `true` if the choice is proved to be the best one.
    #[must_use]
    pub const fn is_optimal(&self) -> bool {
        self.saved_bytes == self.bound_bytes
    }
}

/// Number of subsets that the search examines.
const BUDGET: u32 = 4096;

/// A texture that could be kept.
#[derive(Clone, Copy)]
struct Candidate {
    resource: ResourceId,
    interval: Interval,
    bytes: u64,
    saved: u64,
}

impl Plan {
    /// Chooses the textures to keep in the tile heap of the device ([`Caps::tile_heap_bytes`]). Empty for a device
    /// without one.
    ///
    /// [`Caps::tile_heap_bytes`]: crate::Caps::tile_heap_bytes
    #[must_use]
    pub fn tile_heap(&self) -> TileHeap {
        let heap = self.caps().tile_heap_bytes;
        let align = self.caps().texture_alignment_bytes.max(1);
        let mut candidates: Vec<Candidate> = self.graph().resource_ids().filter_map(|id| candidate(self, id)).collect();
        candidates.retain(|c| c.interval.size <= heap && c.saved > 0);
        // The densest first: saved bytes for each byte and step of the heap.
        let density = |c: &Candidate| c.saved as f64 / (c.interval.size as f64 * f64::from(width(c)));
        candidates.sort_by(|a, b| density(b).total_cmp(&density(a)).then(a.resource.cmp(&b.resource)));
        debug_assert!(candidates.iter().all(|c| c.interval.align == align));
        let mut search = Search {
            candidates: &candidates,
            heap,
            steps: self.steps().len() as u64,
            budget: BUDGET,
            scratch: pack::Scratch::default(),
            best: (0, Vec::new()),
            cut: 0,
        };
        search.extend(0, &mut Vec::new(), 0);
        let bound = search.cut.max(search.best.0);
        let chosen = search.best.1.clone();
        let (packing, offsets) = search.packed(&chosen).expect("the search packed these");
        let keep = |(at, offset): (&usize, &u64)| {
            let Candidate { resource, bytes, saved, .. } = candidates[*at];
            Kept { resource, offset: *offset, bytes, saved_bytes: saved }
        };
        let mut kept: Vec<Kept> = chosen.iter().zip(&offsets).map(keep).collect();
        kept.sort_by_key(|row| row.resource);
        TileHeap { saved_bytes: kept.iter().map(|row| row.saved_bytes).sum(), kept, packing, bound_bytes: bound }
    }
}

fn width(candidate: &Candidate) -> u32 {
    candidate.interval.upper - candidate.interval.lower
}

/// Search over subsets of candidates, in order: each is kept or not.
struct Search<'c> {
    candidates: &'c [Candidate],
    heap: u64,
    steps: u64,
    /// Number of subsets that may still be examined.
    budget: u32,
    scratch: pack::Scratch,
    /// Saved bytes, and the positions of the kept candidates.
    best: (u64, Vec<usize>),
    /// Largest bound of a branch that was given up.
    cut: u64,
}

impl Search<'_> {
    fn extend(&mut self, at: usize, chosen: &mut Vec<usize>, saved: u64) {
        if saved > self.best.0 {
            self.best = (saved, chosen.clone());
        }
        let bound = saved.saturating_add(self.rest(at, chosen));
        if at == self.candidates.len() || bound <= self.best.0 {
            return;
        }
        if self.budget == 0 {
            self.cut = self.cut.max(bound);
            return;
        }
        self.budget -= 1;
        chosen.push(at);
        match self.packed(chosen) {
            Some((packing, _)) if packing.top <= self.heap => {
                self.extend(at + 1, chosen, saved + self.candidates[at].saved);
            }
            // Perhaps another packing of these would fit.
            Some((packing, _)) if packing.lower_bound <= self.heap => self.cut = self.cut.max(bound),
            _ => {}
        }
        chosen.pop();
        self.extend(at + 1, chosen, saved);
    }

    /// Returns an upper bound of what the candidates from `at` can save: the densest fill the free area of the heap, as
    /// if they were liquid. The area is bytes times steps.
    fn rest(&self, at: usize, chosen: &[usize]) -> u64 {
        let area = |c: &Candidate| u128::from(c.interval.size) * u128::from(width(c));
        let used: u128 = chosen.iter().map(|at| area(&self.candidates[*at])).sum();
        let mut free = (u128::from(self.heap) * u128::from(self.steps)).saturating_sub(used);
        let mut sum = 0;
        for candidate in &self.candidates[at..] {
            let own = area(candidate);
            if own > free {
                // Rounded up, so that it stays a bound.
                return sum + (u128::from(candidate.saved) * free).div_ceil(own.max(1)) as u64;
            }
            free -= own;
            sum += candidate.saved;
        }
        sum
    }

    /// Packs a subset; `None` if its sizes overflow.
    fn packed(&mut self, chosen: &[usize]) -> Option<(Packing, Vec<u64>)> {
        let items: Vec<Interval> = chosen.iter().map(|at| self.candidates[*at].interval).collect();
        let limits = pack::Options { effort: Effort::Exact, budget_steps: 1 << 14 };
        let mut offsets = Vec::new();
        let packing = pack(&items, None, &limits, &mut self.scratch, &mut offsets).ok()?;
        Some((packing, offsets))
    }
}

/// Returns a texture as a candidate; `None` if it must be in other memory.
fn candidate(plan: &Plan, id: ResourceId) -> Option<Candidate> {
    let (declared, row) = (&plan.graph().resources()[id.index()], &plan.resources()[id.index()]);
    let placed = matches!(row.placement, Placement::Slot(_) | Placement::Heap { .. });
    let Desc::Texture(desc) = declared.desc else { return None };
    if declared.kind != Kind::Transient || !placed || row.first.is_none() {
        return None;
    }
    let align = plan.caps().texture_alignment_bytes.max(1);
    let bytes = plan.caps().padded_bytes(&declared.desc, row.format, plan.frame(), desc.bytes(plan.frame()));
    let size = bytes.checked_next_multiple_of(align)?;
    let interval = Interval { lower: row.first.index() as u32, upper: row.last.index() as u32 + 1, size, align };
    let saved = plan.step_ids().map(|step| traffic(plan, step, id)).fold(0, u64::saturating_add);
    Some(Candidate { resource: id, interval, bytes, saved })
}

/// External bytes that a step moves for a texture: loads and stores, and what its passes read and write otherwise.
fn traffic(plan: &Plan, step: StepId, id: ResourceId) -> u64 {
    let own = plan.attachments_of(step).iter().filter(|a| a.resource == id);
    let resolved = plan.full_screen_resolves(step).filter(|(samples, _)| samples.resource == id);
    // Depth is resolved without stencil.
    let depth = |access: &Access| Access { range: Range { aspect: Aspect::Depth, ..access.range }, ..*access };
    let resolved = resolved.map(|(samples, _)| accessed_bytes(plan, &depth(samples))).fold(0, u64::saturating_add);
    let moved = own.map(|a| plan.attachment_traffic(a, plan.frame()).total_bytes());
    let attached = moved.fold(resolved, u64::saturating_add);
    let members = plan.passes_of(step).iter().filter(|member| !matches!(member.join, Join::Inlined | Join::Resolve));
    let read = members.flat_map(|member| {
        let is_raster = plan.graph().passes()[member.pass.index()].kind == PassKind::Raster;
        let in_tile = member.join == Join::SamePixel && is_raster;
        let accesses = plan.graph().accesses_of(member.pass).iter().filter(move |a| a.resource == id);
        // Same-pixel reads of a merged pass stay in the tile already.
        accesses.filter(move |a| !(a.kind.is_attachment() || in_tile && a.kind == AccessKind::SamePixel))
    });
    read.map(|access| accessed_bytes(plan, access)).fold(attached, u64::saturating_add)
}

/// Size of the accessed part of a texture, in bytes.
fn accessed_bytes(plan: &Plan, access: &Access) -> u64 {
    let Desc::Texture(desc) = plan.graph().resources()[access.resource.index()].desc else { return 0 };
    let format = plan.format(access.resource).unwrap_or(desc.format);
    let layers = access.range.layer_range(desc.layers.into()).len() as u64;
    let texel = u64::from(format.texel_bytes(if format.planes() > 1 { access.range.aspect } else { Aspect::All }));
    let mips = access.range.mip_range(desc.mip_count(plan.frame()));
    let level = |mip: u32| {
        let [width, height] = desc.mip_extent(plan.frame(), mip);
        let (block_width, block_height) = format.block_texels();
        u64::from(width.div_ceil(block_width)) * u64::from(height.div_ceil(block_height))
    };
    mips.map(|mip| level(mip).saturating_mul(texel * layers * u64::from(desc.samples))).fold(0, u64::saturating_add)
}
