//! `--offsets`: packs intervals from a file into one heap.

use crate::args::OffsetsArgs;
use crate::output;
use crate::run::read;
use framegraph::pack::{Effort, Options, Progress, Scratch, pack_watched};
use framegraph_check::csv;
use program::interrupt;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Packs the intervals of `args.file` and writes the best offsets found.
///
/// The search ends at the step budget, the time limit or a signal. Progress goes to standard error once a second. The
/// final top and lower bound follow.
///
/// # Errors
/// One line that names the file, the line, and the expected content.
pub fn run(args: &OffsetsArgs) -> Result<(), String> {
    let OffsetsArgs { file, budget_steps, seconds, out } = args;
    let outputs = output::prepare([out.as_deref(), None], [file.as_path()])?;
    let shown = file.display();
    let table = csv::read(&read(file)?).map_err(|e| format!("{shown}: {e}"))?;
    let options = Options { effort: Effort::Exact, budget_steps: *budget_steps };
    let (mut offsets, start, mut reported_s) = (Vec::new(), Instant::now(), 0);
    let mut watch = |progress: Progress| {
        let passed = start.elapsed();
        if passed.as_secs() > reported_s {
            reported_s = passed.as_secs();
            let Progress { top, lower_bound, steps } = progress;
            program::note(format_args!("{reported_s} s, {steps} steps: top {top}, lower bound {lower_bound}"));
        }
        let over = seconds.is_some_and(|seconds| passed >= Duration::from_secs(seconds.into()));
        if over { ControlFlow::Break(()) } else { interrupt::flow() }
    };
    interrupt::end_in_order();
    let packing = pack_watched(&table.items, None, &options, &mut Scratch::default(), &mut offsets, &mut watch)
        .map_err(|e| format!("{shown}: {e}"))?;
    output::write(outputs, out.as_deref(), None, &csv::write(&table, &offsets))?;
    let proof = if packing.optimal {
        "optimal".to_owned()
    } else {
        format!("not proved optimal in {} steps; raise --budget-steps or --seconds to search longer", packing.steps)
    };
    program::note(format_args!("top {}, lower bound {}, {proof}", packing.top, packing.lower_bound));
    Ok(())
}
