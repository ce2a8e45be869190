//! The tile heap, checked by a simulation that shares no code with the choice: memory is cells with owners, steps run
//! in order, and traffic is counted access by access.

use framegraph::{
    Access, Aspect, Caps, Desc, Extent, Format, Graph, Intent, Join, Kind, LoadOp, Options, Plan, ResourceId, Scratch,
    StoreOp, TextureDesc, TileHeap, compile, pack,
};
use framegraph_check::generate::{self, Entropy, Profile};

/// Size of a cell in bytes.
const CELL: u64 = 256;

fn planned(graph: &Graph, options: &Options, tile_heap_bytes: u64) -> Plan {
    let caps = Caps { tile_heap_bytes, texture_alignment_bytes: CELL, ..Caps::tiler() };
    let mut plan = Plan::new();
    compile(graph, &caps, options, &mut Scratch::new(), &mut plan).expect("a valid graph");
    plan
}

/// External bytes of a frame by resource, counted from the declarations of the passes and the operations of the plan.
fn external(plan: &Plan, id: ResourceId) -> u64 {
    let Desc::Texture(desc) = plan.graph().resources()[id.index()].desc else { return 0 };
    let texels = |mip: u32, layers: u64| {
        let [width, height] = desc.mip_extent(plan.frame(), mip);
        u64::from(width) * u64::from(height) * layers * u64::from(desc.samples)
    };
    let planes = [(Aspect::Depth, desc.format.has_depth()), (Aspect::Stencil, desc.format.has_stencil())];
    let mut sum = 0;
    for step in plan.step_ids() {
        for row in plan.attachments_of(step).iter().filter(|row| row.resource == id) {
            let each = texels(row.mip.into(), row.layers.into());
            let count =
                |load: LoadOp, store: StoreOp| u64::from(load == LoadOp::Load) + u64::from(store == StoreOp::Store);
            if desc.format.planes() == 1 {
                sum += each * u64::from(desc.format.block_bytes()) * count(row.load, row.store);
            } else {
                sum += each * u64::from(desc.format.texel_bytes(Aspect::Depth)) * count(row.load, row.store);
                let stencil = count(row.stencil_load, row.stencil_store);
                sum += each * u64::from(desc.format.texel_bytes(Aspect::Stencil)) * stencil;
            }
        }
        for (samples, _) in plan.full_screen_resolves(step).filter(|(samples, _)| samples.resource == id) {
            let texel = match desc.format.planes() {
                1 => desc.format.block_bytes(),
                _ => desc.format.texel_bytes(Aspect::Depth),
            };
            sum += texels(samples.range.mip.into(), 1) * u64::from(texel);
        }
        for member in plan.passes_of(step).iter().filter(|m| m.join != Join::Inlined && m.join != Join::Resolve) {
            let other = |a: &&Access| a.resource == id && !a.kind.is_attachment();
            for access in plan.graph().accesses_of(member.pass).iter().filter(other) {
                if access.kind == framegraph::AccessKind::SamePixel && member.join == Join::SamePixel {
                    continue;
                }
                let selected = planes.iter().filter(|(plane, has)| {
                    *has && (access.range.aspect == Aspect::All || access.range.aspect == *plane)
                });
                let texel: u32 = match desc.format.planes() {
                    1 => desc.format.block_bytes(),
                    _ => selected.map(|(plane, _)| desc.format.texel_bytes(*plane)).sum(),
                };
                let layers = access.range.layer_range(desc.layers.into()).len() as u64;
                for mip in access.range.mip_range(desc.mip_count(plan.frame())) {
                    sum += texels(mip, layers) * u64::from(texel);
                }
            }
        }
    }
    sum
}

/// Simulates the heap. Returns the first fault.
fn fault(plan: &Plan, heap: &TileHeap, bytes: u64) -> Option<String> {
    let mut cells: Vec<Option<ResourceId>> = vec![None; (bytes / CELL) as usize];
    for step in plan.step_ids() {
        for kept in &heap.kept {
            // Attachments are those of the plan: a resolve that the device cannot do runs in a later step.
            let running = plan.passes_of(step).iter().filter(|m| m.join != Join::Resolve);
            let mut own = running.flat_map(|m| plan.graph().accesses_of(m.pass));
            let touched = own.any(|a| a.resource == kept.resource && !a.kind.is_attachment())
                || plan.full_screen_resolves(step).any(|(samples, _)| samples.resource == kept.resource)
                || plan.attachments_of(step).iter().any(|a| a.resource == kept.resource);
            if !touched {
                continue;
            }
            let end = kept.offset + kept.bytes;
            if end > bytes {
                return Some(format!("{:?} ends at {end} of {bytes}", kept.resource));
            }
            let range = (kept.offset / CELL) as usize..end.div_ceil(CELL) as usize;
            let is_first = plan.resources()[kept.resource.index()].first == step;
            for cell in &mut cells[range] {
                if !is_first && *cell != Some(kept.resource) {
                    return Some(format!("{:?} was overwritten before {step:?}", kept.resource));
                }
                *cell = Some(kept.resource);
            }
        }
    }
    let saved: u64 = heap.kept.iter().map(|kept| external(plan, kept.resource)).sum();
    (saved != heap.saved_bytes).then(|| format!("{saved} bytes are saved, not {}", heap.saved_bytes))
}

/// The most that a subset saves beyond `at_least`, by packing all subsets; `None` if no subset saves more.
fn better(plan: &Plan, bytes: u64, at_least: u64) -> Option<u64> {
    let fits = |id: &ResourceId| {
        let row = &plan.resources()[id.index()];
        let placed = matches!(row.placement, framegraph::Placement::Slot(_) | framegraph::Placement::Heap { .. });
        let is_texture = plan.graph().resources()[id.index()].desc.texture().is_some();
        plan.graph().resources()[id.index()].kind == Kind::Transient && placed && is_texture && !row.first.is_none()
    };
    let all: Vec<ResourceId> = plan.graph().resource_ids().filter(fits).collect();
    assert!(all.len() <= 10, "{}", all.len());
    let size = |id: ResourceId| plan.graph().resources()[id.index()].desc.bytes(plan.frame()).next_multiple_of(CELL);
    let live = |set: u32| {
        let members = || (0..all.len()).filter(move |at| set >> at & 1 == 1).map(|at| all[at]);
        plan.step_ids().all(|step| {
            let here = members().filter(|id| {
                let row = &plan.resources()[id.index()];
                row.first <= step && step <= row.last
            });
            here.map(size).sum::<u64>() <= bytes
        })
    };
    let members = |set: u32| (0..all.len()).filter(move |at| set >> at & 1 == 1);
    let saved = |set: u32| members(set).map(|at| external(plan, all[at])).sum::<u64>();
    let packs = |set: u32| {
        let interval = |at: usize| {
            let row = &plan.resources()[all[at].index()];
            let (lower, upper) = (row.first.index() as u32, row.last.index() as u32 + 1);
            pack::Interval { lower, upper, size: size(all[at]), align: CELL }
        };
        let items: Vec<_> = members(set).map(interval).collect();
        let (options, mut scratch) = (pack::Options::default(), pack::Scratch::default());
        let packing = pack::pack(&items, None, &options, &mut scratch, &mut Vec::new()).expect("valid intervals");
        assert!(packing.optimal, "a few items are packed with a proof");
        packing.top <= bytes
    };
    let all_sets = 0..1_u32 << all.len();
    all_sets.filter(|set| live(*set) && saved(*set) > at_least && packs(*set)).map(saved).max()
}

#[test]
fn a_post_chain_stays_on_the_chip() -> Result<(), Box<dyn std::error::Error>> {
    let mut graph = Graph::new();
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let mut last = graph.texture("t0", desc);
    last = graph.add_fn("scene", |p| p.color(last, Intent::Overwrite))?;
    for pass in 1..4 {
        let next = graph.texture(&format!("t{pass}"), desc);
        last = graph.add_fn(&format!("blur{pass}"), |p| {
            p.sampled(last)?;
            p.color(next, Intent::Overwrite)
        })?;
    }
    graph.export(last)?;
    let bytes = 64 * 32 * 4;
    // Two textures are live at once: three stay, each with a store and a read less.
    let plan = planned(&graph, &Options::for_frame(64, 32), 2 * bytes);
    let heap = plan.tile_heap();
    assert_eq!((heap.kept.len(), heap.saved_bytes, heap.packing.top), (3, 3 * 2 * bytes, 2 * bytes));
    assert!(heap.is_optimal() && heap.packing.optimal);
    assert_eq!(fault(&plan, &heap, 2 * bytes), None);
    // One fits: either the first and the last, or the middle one.
    let heap = planned(&graph, &Options::for_frame(64, 32), bytes).tile_heap();
    assert_eq!((heap.kept.len(), heap.saved_bytes), (2, 2 * 2 * bytes));
    assert!(planned(&graph, &Options::for_frame(64, 32), 0).tile_heap().kept.is_empty());
    Ok(())
}

#[test]
fn random_plans_keep_textures_that_fit_and_save_what_they_state() {
    let (mut kept, mut optimal, mut exact) = (0, 0, 0);
    for seed in 0..400 {
        let graph = generate::graph(&mut Entropy::seeded(seed), &Profile::default());
        let bytes = [8, 24, 64, 256][seed as usize % 4] * 1024;
        let plan = planned(&graph, &generate::options_of(seed as u32), bytes);
        let heap = plan.tile_heap();
        assert_eq!(fault(&plan, &heap, bytes), None, "seed {seed}");
        assert!(heap.saved_bytes <= heap.bound_bytes && heap.packing.top <= bytes, "seed {seed}");
        (kept, optimal) = (kept + heap.kept.len(), optimal + usize::from(heap.is_optimal()));
        let transient = plan.graph().resources().iter().filter(|row| row.kind == Kind::Transient).count();
        if transient <= 10 {
            let better = better(&plan, bytes, heap.saved_bytes);
            assert!(better.is_none() || !heap.is_optimal(), "seed {seed}: {better:?} exceeds {}", heap.saved_bytes);
            assert!(better.is_none_or(|saved| saved <= heap.bound_bytes), "seed {seed}: {better:?}");
            exact += usize::from(better.is_none());
        }
    }
    println!("{kept} textures kept, {optimal} of 400 choices proved optimal, {exact} are the best of all subsets");
    assert!(kept > 200 && optimal > 300 && exact > 100, "{kept} {optimal} {exact}");
}

/// Negative control: the simulation detects offsets that overlap, a heap that is too small, and wrong savings.
#[test]
fn broken_heaps_are_detected() {
    let (mut overlaps, mut ends, mut savings) = (0, 0, 0);
    for seed in 0..200 {
        let graph = generate::graph(&mut Entropy::seeded(seed), &Profile::default());
        let plan = planned(&graph, &generate::options_of(0), 64 << 10);
        let heap = plan.tile_heap();
        for at in 1..heap.kept.len() {
            let mut broken = heap.clone();
            broken.kept[at].offset = broken.kept[0].offset;
            overlaps += usize::from(fault(&plan, &broken, 64 << 10).is_some());
            broken = heap.clone();
            broken.kept[at].offset = 64 << 10;
            ends += usize::from(fault(&plan, &broken, 64 << 10).is_some());
        }
        let broken = TileHeap { saved_bytes: heap.saved_bytes + 1, ..heap.clone() };
        savings += usize::from(fault(&plan, &broken, 64 << 10).is_some());
    }
    assert!(overlaps > 20 && ends > 50 && savings == 200, "{overlaps} {ends} {savings}");
}
