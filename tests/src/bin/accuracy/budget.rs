//! Budgets: chooses settings from a record, and verifies the choice.

use framegraph_passes::Facts;
use framegraph_passes::quality::{Bound, Measured};
use framegraph_wgpu::{AdapterRequest, Gpu};
use program::outputs::Outputs;
use program::progress::Shown;
use std::path::Path;
use tests::lab::budget::{Bench, verify};
use tests::lab::markdown::number;
use tests::lab::record::Record;
use tests::lab::studio::Studio;
use tests::lab::technique::Outcome;

/// Share of budgets that the chosen frames must meet.
const ENOUGH: f64 = 0.95;

/// Returns the measurements for budgets in a record.
pub fn measured(record: &Record) -> Outcome<&Measured> {
    record.budget.as_ref().ok_or_else(|| "accuracy.json: no measurements for budgets; run `accuracy` to the end".into())
}

/// Prints the settings that the record chooses for a frame that uses every effect.
pub fn chosen(record: &Record, bound: Bound) -> Outcome<()> {
    let measured = measured(record)?;
    let choices = measured.choices(&Facts::default(), |_| true)?;
    let offers = measured.offers(&choices, measured.fastest_ms, measured.reference_ms);
    let set = match bound {
        Bound::Ms(ms) => offers.within_ms(ms).ok_or_else(|| {
            format!("--budget-ms {ms}: the fastest frame takes {} ms; use a larger budget", number(offers.fastest_ms))
        })?,
        Bound::Codes(codes) => {
            offers.within_codes(codes).ok_or("--max-error: no set of options is as accurate; use a larger error")?
        }
    };
    for ((group, options), index) in choices.iter().zip(&set.options) {
        program::line(format_args!("{}: {}", group.name, options[*index].name));
    }
    program::line(format_args!(
        "{} ms, error {} 8-bit steps, on {}",
        number(set.ms),
        number(set.codes()),
        record.adapter
    ));
    Ok(())
}

/// Measures the errors of the options in a record again, and writes it with the times it had.
pub fn renewed(record: &mut Record, file: &Path) -> Outcome<()> {
    program::interrupt::watch();
    let gpu = Gpu::open(&AdapterRequest::from_env())?;
    let studio = Studio::new(&gpu, record.size_px, record.rounds());
    measured(record)?;
    if let Some(measured) = &mut record.budget {
        Bench::new(&studio).renew_errors(measured)?;
    }
    Ok(Outputs::one(file, record.json()?.as_bytes())?)
}

/// Chooses settings for random budgets, then draws and times them and every change of one option.
pub fn verified(record: &Record, count: usize) -> Outcome<()> {
    program::interrupt::watch();
    let gpu = Gpu::open(&AdapterRequest::from_env())?;
    let studio = Studio::new(&gpu, record.size_px, record.rounds());
    let mut shown = Shown::default();
    let found = verify(
        &mut Bench::new(&studio),
        measured(record)?,
        count,
        &mut |bench, frame, _, _| bench.ms(tests::lab::budget::SCENES[0], frame),
        &mut |done| shown.step("budgets", done, count, ""),
    )?;
    shown.clear();
    let share = found.within as f64 / found.budgets.max(1) as f64;
    found.better.iter().for_each(program::line);
    program::line(format_args!(
        "{} of {} frames met their budgets ({:.0} %, {:.0} % required). Of {} sets with {} changes of one option within \
         the budget, {} changes reduce the error by more than 5 %.",
        found.within,
        found.budgets,
        100.0 * share,
        100.0 * ENOUGH,
        found.sets,
        found.swaps,
        found.better.len()
    ));
    if share < ENOUGH || !found.better.is_empty() {
        return Err("chosen frames miss their budgets, or are not the most accurate".into());
    }
    Ok(())
}
