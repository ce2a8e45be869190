//! `--offsets`: packs intervals from a file into one heap.

use crate::args::OffsetsArgs;
use crate::output;
use crate::run::read;
use framegraph::pack::{Effort, Options, Scratch, pack};
use framegraph::testing::csv;

/// Reads, packs with the exact search, and writes the offsets; top and bound go to standard error.
///
/// # Errors
/// One line that names the file, the line, and what it must hold.
pub fn run(args: &OffsetsArgs) -> Result<(), String> {
    let OffsetsArgs { file, budget_steps, out } = args;
    let outputs = output::prepare(out.as_deref(), [file.as_path()])?;
    let shown = file.display();
    let table = csv::read(&read(file)?).map_err(|e| format!("{shown}: {e}"))?;
    let options = Options { effort: Effort::Exact, budget_steps: *budget_steps };
    let mut offsets = Vec::new();
    let packing = pack(&table.items, None, &options, &mut Scratch::default(), &mut offsets)
        .map_err(|e| format!("{shown}: {e}"))?;
    output::write(outputs, out.as_deref(), &csv::write(&table, &offsets))?;
    let proof = if packing.optimal {
        "optimal".to_owned()
    } else {
        format!("not proved optimal in {} steps; --budget-steps allows more", packing.steps)
    };
    program::note(format_args!("top {}, lower bound {}, {proof}", packing.top, packing.lower_bound));
    Ok(())
}
