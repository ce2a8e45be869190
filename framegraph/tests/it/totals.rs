//! Compares counts and traffic of random plans with sums over the operations of their attachments.

use framegraph::*;
use framegraph_check::generate::{self, Entropy, Profile};

/// Returns the operations and bytes per texel of each plane of an attachment. Depth has the bytes that stencil does
/// not.
fn planes(plan: &Plan, a: &Attachment) -> Vec<(LoadOp, StoreOp, u64)> {
    let format = plan.format(a.resource).expect("an attachment is a texture");
    let texel = u64::from(format.block_bytes());
    let both = format.has_depth() && format.has_stencil();
    let first = (a.load, a.store, texel - u64::from(both));
    let stencil = both.then_some((a.stencil_load, a.stencil_store, 1));
    std::iter::once(first).chain(stencil).collect()
}

/// Returns the number of samples that an attachment covers.
fn texels(plan: &Plan, a: &Attachment) -> u64 {
    let texture = plan.graph().resources()[a.resource.index()].desc.texture().expect("an attachment is a texture");
    let side = |side: u32| u64::from((side >> a.mip).max(1));
    let [width, height] = texture.extent.texels(plan.frame());
    side(width) * side(height) * u64::from(texture.samples) * u64::from(a.layers)
}

/// Counts the operations of the plan, using only its arrays.
fn counted(plan: &Plan) -> (Counts, Traffic) {
    let placed = |wanted: Placement| plan.resources().iter().filter(|r| r.placement == wanted).count() as u32;
    let mut counts = Counts {
        memoryless: placed(Placement::Memoryless),
        inlined: placed(Placement::Inlined),
        steps: plan.steps().len() as u32,
        render_passes: plan.steps().iter().filter(|s| s.kind == PassKind::Raster).count() as u32,
        passes: plan.running().count() as u32,
        culled: (plan.graph().passes().len() - plan.running().count()) as u32,
        ..Counts::default()
    };
    let mut traffic = Traffic::default();
    for attachment in plan.attachments() {
        let (planes, texels) = (planes(plan, attachment), texels(plan, attachment));
        let loaded = |op: LoadOp| u32::from(planes.iter().any(|(load, ..)| *load == op));
        let left = |op: StoreOp| planes.iter().any(|(_, store, _)| *store == op);
        let stored = left(StoreOp::Store);
        // A resolve target that is not stored stands for a resolve that is not performed.
        let resolve = attachment.role.is_resolve();
        counts.unresolves += loaded(LoadOp::Load);
        counts.clears += loaded(LoadOp::Clear);
        counts.resolves += u32::from(stored);
        counts.discards += u32::from(!stored && !resolve && left(StoreOp::Discard));
        counts.multisample_resolves += u32::from(resolve && stored);
        for (load, store, texel_bytes) in planes {
            let if_so = |so: bool| if so { texels * texel_bytes } else { 0 };
            traffic.loaded_bytes += if_so(load == LoadOp::Load);
            traffic.stored_bytes += if_so(store == StoreOp::Store);
            traffic.multisample_resolve_bytes += if_so(store == StoreOp::Store && resolve);
        }
    }
    (counts, traffic)
}

#[test]
fn counts_and_traffic_are_what_the_operations_make_of_them() {
    let (mut sum, mut culls) = (Traffic::default(), [0; 2]);
    for seed in 0..600 {
        let graph = generate::graph(&mut Entropy::seeded(seed), &Profile::default());
        let caps = Caps::preset(Caps::PRESETS[seed as usize % 3]).expect("each preset has its name");
        let mut plan = Plan::new();
        let outcome = compile(&graph, &caps, &generate::options_of(seed as u32), &mut Scratch::new(), &mut plan);
        assert_eq!(outcome, Ok(()), "seed {seed}");
        let (counts, traffic) = counted(&plan);
        assert_eq!((plan.counts(), plan.traffic(plan.frame())), (counts, traffic), "seed {seed}");
        let by_step: u64 = plan.step_ids().map(|s| plan.step_traffic(s, plan.frame()).total_bytes()).sum();
        assert_eq!(by_step, traffic.total_bytes(), "seed {seed}");
        sum.loaded_bytes += traffic.loaded_bytes;
        sum.multisample_resolve_bytes += traffic.multisample_resolve_bytes;
        culls[usize::from(counts.culled > 0)] += 1;
    }
    assert!(
        sum.loaded_bytes > 0 && sum.multisample_resolve_bytes > 0 && culls[0] > 0 && culls[1] > 0,
        "{sum:?}, {culls:?}"
    );
}
