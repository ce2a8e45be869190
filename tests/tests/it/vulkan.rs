//! A second backend: command streams (`framegraph_queues::stream`) replayed on Vulkan with synchronization validation.
//! The replayer knows only the plan's tables and the stream; passes access what they declare. The layers report nothing
//! for the streams, and something for streams without some barriers.

mod device;
mod memory;
mod pipeline;
mod replay;
mod shader;
mod states;
mod work;

use crate::cases;
use crate::stage;
use device::{Device, Trouble};
use framegraph::file::GraphFile;
use framegraph::{Alias, Caps, Desc, Extent, Graph, Options, Placement, Plan, Scratch, compile};
use framegraph_check::generate::{self, Entropy, Profile};
use framegraph_passes::Settings;
use framegraph_passes::effects::occlusion::OcclusionSettings;
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_queues::{Command, PlanStream, QueueId, QueueLayout, Schedule, SharedMemory, schedule, share_memory};
use replay::Replay;

/// Small, since the validation layers also cost time per texel; shadow maps keep their size.
const FRAME: [u32; 2] = [160, 90];

/// Opens a device, or reports a skip with the reason.
fn device(test: &str) -> Option<Device> {
    match Device::open() {
        Ok(device) => {
            test_report::adapter(&device.name);
            Some(device)
        }
        Err(error) => {
            test_report::skip(test, &format!("streams are replayed on Vulkan with its layers: {error}"));
            None
        }
    }
}

/// Returns the replayer's capabilities: no tiles, fixed slots, separate histories, one heap for textures and one for
/// buffers.
fn caps() -> Caps {
    let base = Caps { slot_mapping: false, placed_histories: false, separate_heaps: true, ..Caps::desktop() };
    Caps { separate_planes: false, ..base }
}

/// Plans a graph with the driver's sizes of textures.
fn planned(device: &Device, graph: &Graph, options: &Options) -> Result<Plan, Trouble> {
    let (mut caps, mut plan) = (caps(), Plan::new());
    compile(graph, &caps, options, &mut Scratch::new(), &mut plan)?;
    if options.alias != Alias::Pool {
        for (id, row) in graph.resource_ids().zip(plan.resources()) {
            let Desc::Texture(mut desc) = memory::shaped(&plan, id) else { continue };
            if matches!(row.placement, Placement::Heap { .. } | Placement::Slot(_)) {
                let asked = memory::asked(device, &plan, id)?;
                assert!(caps.texture_alignment_bytes.is_multiple_of(asked.alignment), "{asked:?}");
                let [width, height] = desc.extent.texels(options.frame);
                desc.extent = Extent::Absolute { width, height };
                caps.padded.push((desc, asked.size));
            }
        }
        compile(graph, &caps, options, &mut Scratch::new(), &mut plan)?;
    }
    Ok(plan)
}

/// Returns the forward and the deferred frame, and the standard frame with four samples, ambient occlusion and
/// cascades.
fn frames() -> Vec<(String, Graph)> {
    let files = cases::files().into_iter().filter(|(path, _)| path == "forward.ron" || path == "deferred.ron");
    let mut frames: Vec<_> = files
        .map(|(path, text)| {
            let file = GraphFile::parse(&path, &text).unwrap_or_else(|e| panic!("{e}"));
            let graph = file.graph(&[]).unwrap_or_else(|e| panic!("{e}"));
            (path.clone(), graph)
        })
        .collect();
    let settings = Settings {
        samples: 4,
        occlusion: Some(OcclusionSettings::default()),
        shadows: Some(ShadowSettings::default()),
        ..Settings::DEFAULT
    };
    let (frame, _) = stage::declared(&settings);
    frames.push(("standard".to_owned(), frame.graph().clone()));
    frames
}

/// Replays two frames of commands. Returns the layers' messages, and the counts of replayed passes, barriers and
/// submissions.
fn told(device: &Device, plan: &Plan, commands: &[Command]) -> Result<(Vec<String>, [usize; 3]), Trouble> {
    let mut replay = Replay::new(device, plan)?;
    let ran = (0..2).try_for_each(|_| replay.frame(commands));
    let counts = [replay.passes, replay.barriers, replay.submissions];
    device.clear();
    ran?;
    Ok((device.told(), counts))
}

#[test]
fn streams_of_whole_frames_are_replayed_and_the_layers_are_silent() -> Result<(), Trouble> {
    let Some(device) = device("streams_of_whole_frames_are_replayed_and_the_layers_are_silent") else { return Ok(()) };
    for (name, graph) in frames() {
        for alias in [Alias::Heap, Alias::Pool, Alias::Off] {
            let options = Options { alias, ..Options::for_frame(FRAME[0], FRAME[1]) };
            let plan = planned(&device, &graph, &options)?;
            let commands = plan.stream();
            let (messages, [passes, barriers, submissions]) = told(&device, &plan, &commands)?;
            println!("{name}, {alias:?}: {passes} passes, {barriers} barriers, {submissions} submissions");
            assert!(messages.is_empty(), "{name}, {alias:?}: {}\n{}", messages.len(), messages[0]);
            assert_eq!((passes > 8, barriers), (true, 2 * plan.barriers().len()), "{name}");
        }
    }
    Ok(())
}

#[test]
fn barriers_that_are_left_out_are_noticed() -> Result<(), Trouble> {
    let Some(device) = device("barriers_that_are_left_out_are_noticed") else { return Ok(()) };
    let (mut all, mut noticed) = (0, 0);
    // An alias barrier also waits for all earlier writes, which would hide other missing barriers. With shared memory,
    // only alias barriers are left out.
    for ((name, graph), alias) in frames().iter().flat_map(|frame| [(frame, Alias::Off), (frame, Alias::Heap)]) {
        let options = Options { alias, ..Options::for_frame(FRAME[0], FRAME[1]) };
        let plan = planned(&device, graph, &options)?;
        let commands = plan.stream();
        let without = |left: &dyn Fn(u32) -> bool| -> Vec<Command> {
            let kept = |c: &&Command| !matches!(c, Command::Barrier { barrier, .. } if left(*barrier));
            commands.iter().filter(kept).copied().collect()
        };
        let (messages, _) = told(&device, &plan, &without(&|_| true))?;
        assert!(!messages.is_empty(), "{name}: nothing is said of a stream without barriers");
        let hazards = messages.iter().filter(|message| message.contains("SYNC-HAZARD")).count();
        assert!(hazards > 0, "{name}: {}", messages[0]);
        let apart = |barrier: &u32| alias == Alias::Off || !plan.barriers()[*barrier as usize].aliases.is_none();
        for left in test_report::share((0..plan.barriers().len() as u32).filter(apart)) {
            let (messages, _) = told(&device, &plan, &without(&|barrier| barrier == left))?;
            // Older layers allow two accesses to storage, or to an attachment, in the same layout without a barrier.
            let row = &plan.barriers()[left as usize];
            assert!(row.from == row.to || !messages.is_empty(), "{name}: barrier {left} is not missed: {row:?}");
            (all, noticed) = (all + 1, noticed + usize::from(!messages.is_empty()));
        }
    }
    println!("{noticed} of {all} barriers are missed when they are left out");
    assert!(all > 50, "{all}");
    Ok(())
}

#[test]
fn streams_of_random_graphs_are_replayed_and_the_layers_are_silent() -> Result<(), Trouble> {
    let Some(device) = device("streams_of_random_graphs_are_replayed_and_the_layers_are_silent") else { return Ok(()) };
    let (mut replayed, mut barriers, mut refused) = (0, 0, std::collections::BTreeMap::<String, usize>::new());
    for seed in 0..60 {
        let graph = generate::graph(&mut Entropy::seeded(seed), &Profile::default());
        let alias = [Alias::Heap, Alias::Pool][seed as usize % 2];
        let options = Options { alias, ..generate::options_of(seed as u32 % 64) };
        let outcome = planned(&device, &graph, &options).and_then(|plan| {
            let outcome = told(&device, &plan, &plan.stream())?;
            Ok((plan, outcome))
        });
        match outcome {
            Ok((plan, (messages, _))) => {
                let text = || framegraph::dump::text(&plan);
                assert!(messages.is_empty(), "seed {seed}: {}\n{}", messages[0], text());
                (replayed, barriers) = (replayed + 1, barriers + plan.barriers().len());
            }
            Err(why) => {
                device.clear();
                drop(device.told());
                *refused.entry(why.to_string().lines().next().unwrap_or_default().to_owned()).or_default() += 1;
            }
        }
    }
    println!("{replayed} random graphs replayed with {barriers} barriers; the others: {refused:#?}");
    assert!(replayed >= 15 && barriers > 100, "{replayed} {barriers} {refused:?}");
    Ok(())
}

/// Returns a plan without aliasing, its schedule on two queues, and its shared memory.
fn on_two_queues(device: &Device, graph: &Graph) -> Result<(Plan, Schedule, SharedMemory), Trouble> {
    let options = Options { alias: Alias::Off, ..Options::for_frame(FRAME[0], FRAME[1]) };
    let plan = planned(device, graph, &options)?;
    let costs: Vec<f64> = (0..plan.steps().len()).map(|step| (step * 101) as f64 % 400.0).collect();
    let found = schedule(&plan, &QueueLayout::async_compute(), &costs)?;
    let memory = share_memory(&plan, &found, plan.caps().texture_alignment_bytes);
    Ok((plan, found, memory))
}

#[test]
fn streams_on_two_queues_are_replayed_and_the_layers_are_silent() -> Result<(), Trouble> {
    let Some(device) = device("streams_on_two_queues_are_replayed_and_the_layers_are_silent") else { return Ok(()) };
    let mut elsewhere = 0;
    for (name, graph) in frames() {
        let (plan, found, memory) = on_two_queues(&device, &graph)?;
        for (shares, commands) in [(false, plan.stream_on(&found)), (true, plan.stream_in(&found, &memory))] {
            let (messages, [_, _, submissions]) = told(&device, &plan, &commands)?;
            assert!(messages.is_empty(), "{name}, shared {shares}: {}", messages[0]);
            let moved = found.lanes.iter().filter(|lane| **lane != QueueId::MAIN).count();
            println!(
                "{name}, shared {shares}: {moved} steps on the second queue, {submissions} submissions of two frames"
            );
            assert!(moved == 0 || submissions > 2, "{name}");
            elsewhere += moved;
        }
    }
    assert!(elsewhere > 6, "{elsewhere}");
    Ok(())
}

/// Negative control: missing alias barriers within one queue are reported.
#[test]
fn memory_that_is_not_handed_over_is_noticed() -> Result<(), Trouble> {
    let Some(device) = device("memory_that_is_not_handed_over_is_noticed") else { return Ok(()) };
    let mut all = 0;
    for (name, graph) in frames() {
        let (plan, found, memory) = on_two_queues(&device, &graph)?;
        let commands = plan.stream_in(&found, &memory);
        let is_first = |barrier: u32| plan.barriers()[barrier as usize].after.is_none();
        let alone = |command: &Command| match *command {
            Command::AliasingBarrier { .. } => None,
            Command::Barrier { queue, barrier, .. } if is_first(barrier) => {
                Some(Command::Barrier { queue, barrier, behind_semaphore: false })
            }
            other => Some(other),
        };
        let alone: Vec<_> = commands.iter().filter_map(alone).collect();
        let count = commands.len() - alone.len();
        let (messages, _) = told(&device, &plan, &alone)?;
        println!("{name}: {count} hand-overs, {} messages without them", messages.len());
        assert!(messages.iter().any(|message| message.contains("SYNC-HAZARD")), "{name}: {messages:?}");
        all += count;
    }
    assert!(all > 50, "{all}");
    Ok(())
}
