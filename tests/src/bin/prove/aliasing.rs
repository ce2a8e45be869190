//! Memory of heaps compared to the peak of live bytes, which is a lower bound.

use crate::document::Document;
use crate::frames::{self, FRAME, Shape};
use crate::table::{Table, excess, percent};
use framegraph::{Alias, Caps, Effort, Options, Placement, Plan, Scratch, compile};
use framegraph_check::{check, generate};
use std::time::Instant;

/// Graphs of each shape in the quick run.
pub const QUICK: usize = 25;

/// Graphs of each shape in the long run.
pub const LONG: usize = 500;

/// Minimum percentage of graphs that must be packed to the peak, and proven optimal.
const SHARE: usize = 97;

/// Minimum and maximum number of resources.
const RESOURCES: (usize, usize) = (10, 60);

/// Sums over the plans of many graphs.
#[derive(Debug, Default)]
struct Sum {
    plans: usize,
    reached: usize,
    proved: usize,
    wrong: usize,
    ratios: f64,
    largest: f64,
}

impl Sum {
    fn add(&mut self, plan: &Plan) {
        let (bytes, peak) = (plan.memory().bytes, peak(plan));
        let ratio = if peak == 0 { 1.0 } else { bytes as f64 / peak as f64 };
        self.plans += 1;
        self.reached += usize::from(bytes == peak);
        self.proved += usize::from(plan.memory().optimal);
        self.wrong += usize::from(check(plan).is_err() || bytes < peak);
        self.ratios += ratio;
        self.largest = self.largest.max(ratio);
    }
}

/// Returns the largest sum of live bytes in one step. Each resource is rounded up to the device's alignment, as in the
/// heap. Only lifetimes are used.
fn peak(plan: &Plan) -> u64 {
    let placed = |p| matches!(p, Placement::Heap { .. } | Placement::Slot(_));
    let rows: Vec<_> = plan.resources().iter().filter(|r| placed(r.placement)).collect();
    let heap = plan.options().alias == Alias::Heap;
    let align = if heap { plan.caps().texture_alignment_bytes } else { 1 };
    let alive = |step| {
        let live = rows.iter().filter(|r| r.first <= step && step <= r.last);
        live.map(|r| r.bytes.next_multiple_of(align)).sum::<u64>()
    };
    plan.step_ids().map(alive).max().unwrap_or(0)
}

/// Aliasing modes, the simplest first.
const WAYS: [(&str, Alias, Effort); 3] = [
    ("pool", Alias::Pool, Effort::Greedy),
    ("heap, greedy", Alias::Heap, Effort::Greedy),
    ("heap, exact search", Alias::Heap, Effort::Exact),
];

/// Returns the graph from which all plans of the section are made.
fn graph(shape: Shape, seed: usize) -> framegraph::Graph {
    let (least, most) = RESOURCES;
    let resources = least + seed * 7919 % (most - least + 1);
    frames::graph(shape, seed as u64, resources).unwrap_or_else(|error| panic!("{error}"))
}

/// Prints the table over all graphs.
pub fn section(document: &mut Document, graphs: usize, note: &str) {
    let columns =
        ["shape", "device", "memory", "plans", "at the peak", "proved optimal", "mean excess", "largest excess"];
    let mut table = Table::new(&columns);
    let (mut scratch, mut plan, mut wrong) = (Scratch::new(), Plan::new(), 0);
    for shape in Shape::ALL {
        for caps in [Caps::desktop(), Caps::tiler()].map(generate::capable) {
            let mut sums: [Sum; WAYS.len()] = Default::default();
            for seed in 0..graphs {
                document.at("memory", seed, graphs);
                let graph = graph(shape, seed);
                for ((_, alias, effort), sum) in WAYS.iter().zip(&mut sums) {
                    let [width, height] = FRAME;
                    let options = Options { alias: *alias, effort: *effort, ..Options::for_frame(width, height) };
                    compile(&graph, &caps, &options, &mut scratch, &mut plan)
                        .unwrap_or_else(|errors| panic!("{errors}"));
                    sum.add(&plan);
                }
            }
            for ((name, alias, effort), sum) in WAYS.iter().zip(&sums) {
                let plans = sum.plans;
                wrong += sum.wrong;
                let enough = sum.reached.min(sum.proved) * 100 >= plans * SHARE;
                document.claim(*alias == Alias::Pool || *effort != Effort::Exact || enough, || {
                    format!("{name} of {} on {}: under {SHARE} % at the peak or proved", shape.word(), caps.name)
                });
                table.row(vec![
                    shape.word().into(),
                    caps.name.clone(),
                    (*name).into(),
                    plans.to_string(),
                    percent(sum.reached, plans),
                    percent(sum.proved, plans),
                    excess(sum.ratios / plans as f64),
                    excess(sum.largest),
                ]);
            }
        }
    }
    let (least, most) = RESOURCES;
    let count = graphs * Shape::ALL.len();
    document.claim(wrong == 0, || format!("the oracle rejects {wrong} plans of {count} graphs"));
    document.section(
        &format!("Memory of {count} random graphs{note}"),
        &format!(
            "Graphs of {least} to {most} resources, each planned for two devices. The peak is the largest sum of live \
             bytes\nin one step, aligned as on the device, computed from the lifetimes alone. No heap can be smaller. A pool \
             is\nproved optimal among pools. The independent checker (the oracle) rejects {wrong} plans.\n\n{}",
            table.text()
        ),
    );
}

/// Graphs of each shape and size in the table of times.
const LARGE_GRAPHS: usize = 250;

/// Number of runs; the minimum time counts, to exclude other load.
const RUNS: usize = 3;

/// Measures the compile time of large graphs.
pub fn large(document: &mut Document) {
    let mut table =
        Table::new(&["shape", "device", "resources", "plans", "at the peak", "proved", "median ms", "longest ms"]);
    let (mut scratch, mut plan) = (Scratch::new(), Plan::new());
    for shape in Shape::ALL {
        for caps in [Caps::desktop(), Caps::tiler()].map(generate::capable) {
            let (mut sum, mut times) = (Sum::default(), Vec::new());
            for seed in 0..LARGE_GRAPHS {
                document.at("160 resources", seed, LARGE_GRAPHS);
                let graph = frames::graph(shape, seed as u64, 160).unwrap_or_else(|error| panic!("{error}"));
                let options = Options { alias: Alias::Heap, ..Options::for_frame(FRAME[0], FRAME[1]) };
                let mut fastest = f64::INFINITY;
                for _ in 0..RUNS {
                    let start = Instant::now();
                    compile(&graph, &caps, &options, &mut scratch, &mut plan)
                        .unwrap_or_else(|errors| panic!("{errors}"));
                    fastest = fastest.min(start.elapsed().as_secs_f64() * 1e3);
                }
                times.push(fastest);
                sum.add(&plan);
            }
            times.sort_by(f64::total_cmp);
            let enough = sum.reached * 100 >= sum.plans * SHARE && sum.wrong == 0;
            document.claim(enough, || format!("160 resources, {} on {}: not at the peak", shape.word(), caps.name));
            table.row(vec![
                shape.word().into(),
                caps.name.clone(),
                "160".into(),
                sum.plans.to_string(),
                percent(sum.reached, sum.plans),
                percent(sum.proved, sum.plans),
                format!("{:.2}", times[times.len() / 2]),
                format!("{:.2}", times[times.len() - 1]),
            ]);
        }
    }
    document.section(
        "Graphs of 160 resources, long run",
        &format!(
            "All phases, heap with exact search, default budget; the minimum of {RUNS} runs. The goal is to reach the \
             peak within 100 ms.\nIf the budget ends the search, the plan is not marked as proved.\n\n{}",
            table.text()
        ),
    );
}
