//! Schedules of random and of selected graphs are correct, not slower than one queue, and close to the optimum. The
//! checker notices everything that is left out.

use framegraph::{
    Alias, Caps, Extent, Format, Graph, Intent, Options, PassKind, Plan, Scratch, StepId, TextureDesc, compile,
};
use framegraph_check::generate::{self, Entropy, Profile};
use framegraph_queues::{
    QueueError, QueueId, QueueLayout, Violation, check, check_memory, replan, schedule, schedule_with, share_memory,
    svg, text,
};

type TestResult = Result<(), Box<dyn std::error::Error>>;

/// Returns random costs, most of them small.
fn costs(plan: &Plan, seed: u64) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    plan.step_ids()
        .map(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let unit = (state >> 40) as f64 / (1_u64 << 24) as f64;
            (unit * unit * 1000.0).floor()
        })
        .collect()
}

/// Returns plans of random graphs with all options, for three kinds of devices, with slots and heaps.
fn plans(count: u64) -> impl Iterator<Item = (u64, Plan)> {
    let mut scratch = Scratch::new();
    (0..count).filter_map(move |seed| {
        let graph = generate::graph(&mut Entropy::seeded(seed), &Profile::default());
        let mut plan = Plan::new();
        let options = generate::options_of(seed as u32 % 64);
        let caps =
            [Caps::wgpu(), Caps::desktop(), Caps { separate_heaps: true, ..Caps::tiler() }].map(generate::capable);
        compile(&graph, &caps[seed as usize % 3], &options, &mut scratch, &mut plan).ok()?;
        Some((seed, plan))
    })
}

fn layouts() -> [QueueLayout; 3] {
    [QueueLayout::one(), QueueLayout::async_compute(), QueueLayout::async_compute_and_copy()]
}

#[test]
fn schedules_are_sound_and_never_slower() -> TestResult {
    let (mut moved, mut shorter, mut transfers, mut shared) = (0, 0, 0, 0);
    for (seed, plan) in plans(600) {
        let costs = costs(&plan, seed);
        for layout in layouts() {
            let found = schedule(&plan, &layout, &costs)?;
            assert_eq!(check(&plan, &found), [], "seed {seed}: {}", text(&plan, &found));
            assert!(
                found.total_us <= found.alone_us,
                "seed {seed}: {} µs, {} on one queue",
                found.total_us,
                found.alone_us
            );
            let elsewhere = found.lanes.iter().filter(|lane| **lane != QueueId::MAIN).count();
            assert_eq!(elsewhere > 0, found.total_us < found.alone_us, "seed {seed}: steps leave only for a gain");
            assert_eq!(found, schedule(&plan, &layout, &costs)?, "schedules are deterministic");
            moved += elsewhere;
            shorter += usize::from(found.total_us < found.alone_us);
            transfers += found.transfers.len();
            shared += found.concurrent.len();
        }
    }
    println!("{shorter} frames got shorter, {moved} steps moved, {transfers} transfers, {shared} concurrent resources");
    assert!(shorter > 100 && moved > 200 && transfers > 100 && shared > 20);
    Ok(())
}

/// Tries every assignment to two queues: the chosen one is usually optimal, otherwise close to it.
#[test]
fn the_choice_is_near_the_best_of_all() -> TestResult {
    let layout = QueueLayout::async_compute();
    let (mut tried, mut best, mut worst) = (0, 0, 1.0_f64);
    for (seed, plan) in plans(500) {
        let costs = costs(&plan, seed);
        let kind = |step: &StepId| plan.steps()[step.index()].kind != PassKind::Raster;
        let movable: Vec<StepId> = plan.step_ids().filter(kind).collect();
        if !(2..=9).contains(&movable.len()) {
            continue;
        }
        let chosen = schedule(&plan, &layout, &costs)?.total_us;
        let least = (0..1_u32 << movable.len())
            .map(|set| {
                let leaves =
                    |step: StepId| movable.iter().position(|m| *m == step).is_some_and(|at| set >> at & 1 == 1);
                forced_us(&plan, &layout, &costs, &leaves)
            })
            .fold(f64::INFINITY, f64::min);
        assert!(chosen >= least - 1e-9, "seed {seed}: {chosen} is below the minimum, {least}");
        tried += 1;
        best += usize::from(chosen <= least + 1e-9);
        worst = worst.max(chosen / least);
    }
    println!("{best} of {tried} are optimal, the worst ratio is {worst:.3}");
    assert!(tried > 100 && best * 10 >= tried * 9 && worst < 1.15, "{best} of {tried}, {worst}");
    Ok(())
}

/// Returns the duration of a frame with the given steps on the second queue, with an independent model: each step
/// begins when all conflicting steps have ended.
fn forced_us(plan: &Plan, layout: &QueueLayout, costs: &[f64], leaves: &dyn Fn(StepId) -> bool) -> f64 {
    let lanes: Vec<QueueId> = plan.step_ids().map(|step| QueueId(u8::from(leaves(step)))).collect();
    // Without semaphores, the pairs that the checker reports are those that must be ordered.
    let mut bare = schedule(plan, &QueueLayout::one(), costs).unwrap_or_else(|error| panic!("{error}"));
    (bare.layout, bare.lanes) = (layout.clone(), lanes.clone());
    let mut waits = Vec::new();
    for violation in check(plan, &bare) {
        if let Violation::Unordered { first, second, .. } | Violation::Memory { first, second, .. } = violation {
            waits.push((first.index(), second.index()));
        }
    }
    let (mut free, mut ends) = ([0.0_f64; 2], Vec::new());
    for (step, lane) in lanes.iter().enumerate() {
        let ready_us =
            waits.iter().filter(|(_, second)| *second == step).map(|(first, _)| ends[*first] + layout.semaphore_us);
        let begin = ready_us.fold(free[lane.index()], f64::max);
        free[lane.index()] = begin + costs[step];
        ends.push(begin + costs[step]);
    }
    let joined = if free[1] > 0.0 { free[1] + layout.semaphore_us } else { 0.0 };
    free[0].max(joined)
}

/// Memory is shared according to the schedule: resources in use at the same time do not overlap, and removing the
/// semaphores is noticed.
#[test]
fn memory_is_shared_by_what_is_over() -> TestResult {
    let (mut bytes, mut unaliased, mut noticed) = (0, 0, 0);
    let mut scratch = Scratch::new();
    for seed in 0..300 {
        let graph = generate::graph(&mut Entropy::seeded(seed), &Profile::default());
        let options = Options { alias: Alias::Off, ..generate::options_of(0) };
        let mut plan = Plan::new();
        if compile(&graph, &generate::capable(Caps::wgpu()), &options, &mut scratch, &mut plan).is_err() {
            continue;
        }
        let found = schedule(&plan, &QueueLayout::async_compute(), &costs(&plan, seed))?;
        let memory = share_memory(&plan, &found, 256);
        assert_eq!(check_memory(&plan, &found, &memory), [], "seed {seed}");
        assert!(memory.bytes() <= memory.unaliased_bytes);
        assert!(memory.offsets.iter().flatten().all(|offset| offset.is_multiple_of(256)));
        bytes += memory.bytes();
        unaliased += memory.unaliased_bytes;
        let mut broken = found;
        broken.waits.clear();
        noticed += usize::from(!check_memory(&plan, &broken, &memory).is_empty());
    }
    println!("{bytes} bytes of {unaliased}; {noticed} schedules without semaphores were reported");
    assert!(bytes * 10 < unaliased * 9 && noticed > 3, "{bytes} of {unaliased}, {noticed}");
    Ok(())
}

/// Every element that is left out of a schedule is noticed.
#[test]
fn the_judge_notices_what_is_left_out() -> TestResult {
    let (mut waits, mut transfers, mut joins) = (0, 0, 0);
    for (seed, plan) in plans(300) {
        let found = schedule(&plan, &QueueLayout::async_compute_and_copy(), &costs(&plan, seed))?;
        for left_out in 0..found.waits.len() {
            let mut broken = found.clone();
            broken.waits.remove(left_out);
            assert_ne!(check(&plan, &broken), [], "seed {seed}: wait {left_out} is unnecessary");
            waits += 1;
        }
        for left_out in 0..found.transfers.len() {
            let mut broken = found.clone();
            broken.transfers.remove(left_out);
            let missed = check(&plan, &broken);
            assert!(
                missed.iter().all(|v| matches!(v, Violation::NotOwned { .. })) && !missed.is_empty(),
                "seed {seed}"
            );
            transfers += 1;
        }
        for left_out in 0..found.joins.len() {
            let mut broken = found.clone();
            broken.joins.remove(left_out);
            assert!(matches!(check(&plan, &broken)[..], [Violation::NotJoined { .. }]));
            joins += 1;
        }
        let mut broken = found.clone();
        if let Some(raster) = plan.step_ids().find(|step| plan.steps()[step.index()].kind == PassKind::Raster) {
            broken.lanes[raster.index()] = QueueId(1);
            assert!(check(&plan, &broken).contains(&Violation::WrongQueue { step: raster }));
        }
        broken.lanes.push(QueueId::MAIN);
        assert_eq!(check(&plan, &broken), [Violation::OtherPlan]);
    }
    assert!(waits > 100 && transfers > 50 && joins > 50, "{waits} {transfers} {joins}");
    Ok(())
}

/// Returns a frame with ambient occlusion that can run in parallel with a shadow map.
fn frame(alias: Alias) -> Result<Plan, Box<dyn std::error::Error>> {
    let mut graph = Graph::new();
    let color = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let depth = TextureDesc::new(Extent::FRAME, Format::Depth32Float);
    let depth = graph.texture("depth", depth);
    let [occlusion, blurred, map, picture] =
        ["occlusion", "blurred", "map", "picture"].map(|name| graph.texture(name, color));
    let depth = graph.add_fn("prepass", |p| p.depth(depth, Intent::Clear(framegraph::ClearValue::FAR_REVERSED)))?;
    let occlusion = graph.add_fn("occlusion", |p| {
        p.sampled(depth)?;
        p.storage_write(occlusion, Intent::Overwrite)
    })?;
    let blurred = graph.add_fn("blur", |p| {
        p.sampled(occlusion)?;
        p.storage_write(blurred, Intent::Overwrite)
    })?;
    let map = graph.add_fn("shadow", |p| {
        p.sampled(depth)?;
        p.color(map, Intent::Overwrite)
    })?;
    let picture = graph.add_fn("color", |p| {
        p.sampled(blurred)?;
        p.sampled(map)?;
        p.color(picture, Intent::Overwrite)
    })?;
    graph.export(picture)?;
    let mut plan = Plan::new();
    let options = Options { alias, ..Options::for_frame(64, 64) };
    compile(&graph, &Caps::wgpu(), &options, &mut Scratch::new(), &mut plan)?;
    Ok(plan)
}

/// In a plan for one queue, the map reuses the memory of the unblurred occlusion and waits for it, so nothing runs in
/// parallel.
#[test]
fn shared_memory_is_waited_for() -> TestResult {
    let costs = [100.0, 200.0, 150.0, 500.0, 300.0];
    let found = schedule(&frame(Alias::Pool)?, &QueueLayout::async_compute(), &costs)?;
    assert_eq!((found.alone_us, found.total_us), (1250.0, 1250.0));
    Ok(())
}

/// Two consecutive steps move together, and resources read by both queues are concurrent.
#[test]
fn occlusion_runs_beside_shadows() -> TestResult {
    let plan = frame(Alias::Off)?;
    let costs = [100.0, 200.0, 150.0, 500.0, 300.0];
    let found = schedule(&plan, &QueueLayout::async_compute(), &costs)?;
    assert_eq!(found.lanes, [0, 1, 1, 0, 0].map(QueueId));
    assert_eq!((found.alone_us, found.total_us), (1250.0, 900.0), "350 µs run in parallel with the map");
    let pairs: Vec<_> = found.waits.iter().map(|wait| (wait.after.index(), wait.before.index())).collect();
    assert_eq!(pairs, [(0, 1), (2, 4)]);
    assert!(found.is_before(StepId::at(0), StepId::at(4)) && !found.is_before(StepId::at(1), StepId::at(3)));
    let name = |r| plan.graph().resource_name(r);
    assert_eq!(found.concurrent.iter().map(|r| name(*r)).collect::<Vec<_>>(), ["depth"]);
    let moved: Vec<_> = found.transfers.iter().map(|t| (name(t.resource), t.from.0.0, t.to.0.0)).collect();
    assert_eq!(moved, [("blurred", 1, 0)]);
    let shown = text(&plan, &found);
    assert!(shown.contains("frame: 900.0 µs, 1250.0 µs on one queue; 2 semaphores, 1 joins, 1 transfers"), "{shown}");
    assert!(shown.contains("blurred: compute (after step 2) to graphics (before step 4)"), "{shown}");
    let drawn = svg(&plan, &found);
    assert!(drawn.matches("<rect").count() == 6 && drawn.matches("<line").count() == 2, "{drawn}");
    // Pinned steps stay, and a map that takes little longer than a semaphore leaves nothing to gain.
    let stays = schedule_with(&plan, &QueueLayout::async_compute(), &costs, &|step| step.index() != 1)?;
    assert_eq!(stays.lanes[1], QueueId::MAIN);
    let short = schedule(&plan, &QueueLayout::async_compute(), &[100.0, 200.0, 150.0, 15.0, 300.0])?;
    assert_eq!((short.total_us, short.waits.len()), (short.alone_us, 0));
    Ok(())
}

#[test]
fn no_control_character_is_shown() -> TestResult {
    let mut graph = Graph::new();
    graph.add_fn("a\u{1b}[31m", |pass| {
        pass.side_effect();
        Ok(())
    })?;
    let mut plan = Plan::new();
    compile(&graph, &Caps::wgpu(), &Options::default(), &mut Scratch::new(), &mut plan)?;
    let mut layout = QueueLayout::one();
    layout.queues[0].name = "q\u{7}".into();
    let found = schedule(&plan, &layout, &[1.0])?;
    for shown in [text(&plan, &found), svg(&plan, &found)] {
        assert!(shown.contains(r"a\u{1b}[31m") && shown.contains(r"q\u{7}"), "{shown:?}");
        assert!(!shown.contains(|c: char| c.is_control() && c != '\n'), "{shown:?}");
    }
    Ok(())
}

#[test]
fn what_cannot_be_scheduled_is_told() -> TestResult {
    let (plan, layout) = (frame(Alias::Off)?, QueueLayout::async_compute());
    assert_eq!(schedule(&plan, &layout, &[1.0]), Err(QueueError::Costs { given: 1, steps: 5 }));
    for wrong in [-1.0, f64::NAN, f64::INFINITY] {
        let costs = [1.0, 1.0, wrong, 1.0, 1.0];
        assert!(matches!(schedule(&plan, &layout, &costs), Err(QueueError::Cost { step: 2, .. })));
    }
    let mut no_raster = layout.clone();
    no_raster.queues.remove(0);
    assert_eq!(schedule(&plan, &no_raster, &[1.0; 5]), Err(QueueError::Layout));
    assert_eq!(schedule(&plan, &QueueLayout { queues: vec![], ..layout }, &[1.0; 5]), Err(QueueError::Layout));
    Ok(())
}

#[test]
fn a_pass_that_asks_for_the_first_queue_stays_there() -> TestResult {
    let planned = |stays: bool| -> Result<Plan, Box<dyn std::error::Error>> {
        let mut graph = Graph::new();
        let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
        let [map, fog, picture] = ["map", "fog", "picture"].map(|name| graph.texture(name, desc));
        let map = graph.add_fn("shadow", |p| p.color(map, Intent::Overwrite))?;
        let fog = graph.add_fn("fog", |p| {
            if stays {
                p.main_queue();
            }
            p.storage_write(fog, Intent::Overwrite)
        })?;
        let picture = graph.add_fn("color", |p| {
            p.sampled(map)?;
            p.sampled(fog)?;
            p.color(picture, Intent::Overwrite)
        })?;
        graph.export(picture)?;
        let mut plan = Plan::new();
        compile(&graph, &Caps::desktop(), &Options::for_frame(64, 64), &mut Scratch::new(), &mut plan)?;
        Ok(replan(&plan)?)
    };
    let costs_us = [400.0, 300.0, 900.0];
    let (free, staying) = (planned(false)?, planned(true)?);
    let layout = QueueLayout::of_device(free.caps());
    assert_eq!(layout, QueueLayout::async_compute_and_copy());
    assert_eq!(QueueLayout::of_device(&Caps::tiler()), QueueLayout::async_compute());
    assert_eq!(QueueLayout::of_device(&Caps::wgpu()), QueueLayout::one());
    let left = schedule(&free, &layout, &costs_us)?;
    let stayed = schedule(&staying, &layout, &costs_us)?;
    assert_eq!((left.total_us, stayed.total_us), (1300.0, 1600.0));
    assert!(stayed.lanes.iter().all(|lane| *lane == QueueId::MAIN));
    // The checker reports a schedule that ignores the pinned pass.
    assert!(check(&free, &left).is_empty() && check(&staying, &stayed).is_empty());
    assert!(check(&staying, &left).iter().any(|found| matches!(found, Violation::WrongQueue { .. })));
    Ok(())
}
