//! Packings with a known optimum: distance of the searches from it.

use crate::document::Document;
use crate::instances::overlaps;
use crate::table::{Table, excess};
use framegraph::pack::{Effort, Options, Scratch, pack_watched};
use framegraph_check::planted::{Cuts, Planted};
use std::ops::ControlFlow;
use std::time::Instant;

/// A rectangle, and the maximum excess of the top over its height, in percent.
#[derive(Clone, Copy, Debug)]
struct Row(Planted, u64);

/// Search steps in the quick run.
const QUICK_STEPS: u64 = 3 << 20;

/// Search steps in the long run, about one minute.
const LONG_STEPS: u64 = 450_000_000;

const fn row(items: usize, [times, units]: [u32; 2], cuts: Cuts, most: u64) -> Row {
    Row(Planted { items, times, units, ..Planted::square(cuts) }, most)
}

const QUICK: [Row; 5] = [
    row(240, [200, 400], Cuts::Even, 5),
    row(240, [200, 400], Cuts::Long, 5),
    row(240, [200, 400], Cuts::Brief, 5),
    row(240, [200, 400], Cuts::Pinwheels, 5),
    Row(Planted { items: 240, unit_bytes: 4096, left_out_percent: 15, ..Planted::square(Cuts::Even) }, 0),
];

const LONG: [Row; 16] = [
    row(400, [1024, 1024], Cuts::Even, 5),
    row(400, [1024, 1024], Cuts::Long, 5),
    row(400, [1024, 1024], Cuts::Brief, 5),
    row(400, [1024, 1024], Cuts::Pinwheels, 5),
    row(1000, [1024, 1024], Cuts::Even, 5),
    row(1000, [1024, 1024], Cuts::Long, 5),
    row(1000, [1024, 1024], Cuts::Brief, 5),
    row(1000, [1024, 1024], Cuts::Pinwheels, 5),
    row(1000, [1024, 1024], Cuts::Rows, 5),
    row(1000, [64, 65536], Cuts::Even, 5),
    row(10000, [65536, 65536], Cuts::Long, 10),
    row(10000, [65536, 65536], Cuts::Pinwheels, 10),
    row(10000, [64, 65536], Cuts::Brief, 10),
    row(10000, [1024, 1024], Cuts::Even, 10),
    row(10000, [1024, 65536], Cuts::Rows, 10),
    row(10000, [1024, 65536], Cuts::Long, 10),
];

/// Prints the table of the quick run.
pub fn quick(document: &mut Document) -> Result<(), String> {
    section(document, &QUICK, QUICK_STEPS, "")
}

/// Prints the table of the long run, with times.
pub fn long(document: &mut Document) -> Result<(), String> {
    section(document, &LONG, LONG_STEPS, ", long run")
}

fn section(document: &mut Document, rows: &[Row], budget_steps: u64, note: &str) -> Result<(), String> {
    let timed = !note.is_empty();
    let mut columns =
        vec!["cuts", "items", "times", "units", "left out", "top", "lower bound", "above it", "proved", "steps"];
    columns.extend(timed.then_some("seconds"));
    let mut table = Table::new(&columns);
    let mut scratch = Scratch::default();
    for (index, Row(plan, most)) in rows.iter().enumerate() {
        let (items, height) = (plan.items(1), plan.height_bytes());
        let (mut offsets, start) = (Vec::new(), Instant::now());
        let options = Options { effort: Effort::Exact, budget_steps };
        let packing = pack_watched(&items, None, &options, &mut scratch, &mut offsets, &mut |progress| {
            let above = excess(progress.top as f64 / progress.lower_bound as f64);
            document.at(&format!("planted packings, the next {above} above its bound"), index, rows.len());
            ControlFlow::Continue(())
        });
        let seconds = start.elapsed().as_secs_f64();
        let packing = packing.map_err(|error| error.to_string())?;
        let top = items.iter().zip(&offsets).map(|(item, offset)| offset + item.size).max().unwrap_or(0);
        let near = top * 100 <= height * (100 + most);
        let sound = top == packing.top && !overlaps(&items, &offsets);
        document.claim(near && sound, || format!("{plan:?}: {top}, not {most} % above {height} at most"));
        let mut cells = vec![
            plan.cuts.word().to_owned(),
            items.len().to_string(),
            plan.times.to_string(),
            plan.units.to_string(),
            format!("{} %", plan.left_out_percent),
            top.to_string(),
            packing.lower_bound.to_string(),
            excess(top as f64 / packing.lower_bound as f64),
            if packing.optimal { "yes" } else { "open" }.into(),
            packing.steps.to_string(),
        ];
        cells.extend(timed.then(|| format!("{seconds:.1}")));
        table.row(cells);
    }
    document.section(
        &format!("Planted packings{note}"),
        &format!(
            "A rectangle, `times` wide and `units` bytes high, is cut into items that fill it, so its height is the optimal \
             top.\nIf pieces are left out, the height is still reachable, and the lower bound may be lower. The search has at \
             most\n{budget_steps} steps; offsets are checked pair by pair.\n\n{}",
            table.text()
        ),
    );
    Ok(())
}
