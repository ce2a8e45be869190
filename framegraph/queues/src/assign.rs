//! Assigns steps to queues.

use crate::layout::{QueueId, QueueLayout};
use crate::simulate::simulate;
use framegraph::{PassFlags, PassKind, Plan, StepId, StepPass};

/// Maximum number of rounds of moves. Few are needed, because each must shorten the frame.
const ROUNDS: usize = 8;

/// Assigns a queue to each step so that the frame is short.
///
/// Starts from two assignments: all steps on the first queue, and all movable steps on the last queue that can run
/// them. Then steps and chains of steps move to other queues as long as the frame gets shorter. Returns the shorter
/// result; of equal ones, the one with fewer steps on other queues.
pub fn assign(
    plan: &Plan,
    layout: &QueueLayout,
    dependencies: &[Vec<u32>],
    costs_us: &[f64],
    may_leave: &dyn Fn(StepId) -> bool,
) -> Vec<QueueId> {
    let kind = |step: usize| plan.steps()[step].kind;
    // Barriers order passes whose imports may alias, so they stay on one queue.
    let aliased = |pass| plan.graph().accesses_of(pass).iter().any(|access| plan.graph().has_alias(access.resource));
    let asks_to_stay = |member: &StepPass| {
        plan.graph().passes()[member.pass.index()].flags.has(PassFlags::MAIN_QUEUE) || aliased(member.pass)
    };
    let stays = |step: usize| plan.passes_of(StepId::at(step)).iter().any(asks_to_stay);
    let movable = |step: usize| kind(step) != PassKind::Raster && !stays(step) && may_leave(StepId::at(step));
    let mut groups = chains(dependencies, &movable);
    groups.extend((0..dependencies.len()).filter(|step| movable(*step)).map(|step| vec![step]));
    let total_us = |lanes: &[QueueId]| simulate(layout, lanes, dependencies, costs_us).total_us;
    let runs = |queue: QueueId, step: usize| layout.queues[queue.index()].runs(kind(step));
    let last = |step: usize| layout.ids().rev().find(|queue| runs(*queue, step)).filter(|_| movable(step));
    let starts = [
        vec![QueueId::MAIN; dependencies.len()],
        (0..dependencies.len()).map(|step| last(step).unwrap_or(QueueId::MAIN)).collect(),
    ];
    let found = starts.map(|mut lanes| {
        let mut best_us = total_us(&lanes);
        for _ in 0..ROUNDS {
            let before_us = best_us;
            for group in &groups {
                for queue in layout.ids() {
                    let there = group.iter().all(|step| lanes[*step] == queue);
                    if there || !group.iter().all(|step| runs(queue, *step)) {
                        continue;
                    }
                    let old: Vec<QueueId> = group.iter().map(|step| lanes[*step]).collect();
                    group.iter().for_each(|step| lanes[*step] = queue);
                    let found_us = total_us(&lanes);
                    // Without a gain, steps stay on the first queue.
                    if found_us < best_us || found_us == best_us && queue == QueueId::MAIN {
                        best_us = found_us;
                    } else {
                        group.iter().zip(old).for_each(|(step, old)| lanes[*step] = old);
                    }
                }
            }
            if best_us >= before_us {
                break;
            }
        }
        (best_us, lanes)
    });
    let [(alone_us, alone), (apart_us, apart)] = found;
    if apart_us < alone_us { apart } else { alone }
}

/// Returns groups of movable steps connected by dependencies. Separating them would need semaphores in both directions.
fn chains(dependencies: &[Vec<u32>], movable: &dyn Fn(usize) -> bool) -> Vec<Vec<usize>> {
    let mut of: Vec<Option<usize>> = vec![None; dependencies.len()];
    let mut chains: Vec<Vec<usize>> = Vec::new();
    for step in (0..dependencies.len()).filter(|step| movable(*step)) {
        let mut own = chains.len();
        chains.push(vec![step]);
        for before in dependencies[step].iter().filter_map(|before| of[*before as usize]).collect::<Vec<_>>() {
            if before != own && !chains[before].is_empty() {
                let moved = std::mem::take(&mut chains[own]);
                moved.iter().for_each(|step| of[*step] = Some(before));
                chains[before].extend(moved);
                own = before;
            }
        }
        of[step] = Some(own);
    }
    chains.retain(|chain| chain.len() > 1);
    chains.iter_mut().for_each(|chain| chain.sort_unstable());
    chains
}
