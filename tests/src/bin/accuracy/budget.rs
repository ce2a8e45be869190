//! Frames within a budget: what the record would choose, and how what it chooses turns out.

use framegraph_passes::Facts;
use framegraph_passes::budget::{Bound, Measured};
use framegraph_wgpu::{AdapterRequest, Gpu};
use program::progress::Shown;
use tests::lab::budget::{Bench, verify};
use tests::lab::markdown::number;
use tests::lab::record::Record;
use tests::lab::studio::Studio;
use tests::lab::technique::Outcome;

/// The share of budgets that chosen frames must be within.
const ENOUGH: f64 = 0.95;

/// What the record has for it.
pub fn measured(record: &Record) -> Outcome<&Measured> {
    record.budget.as_ref().ok_or_else(|| "the record has no `budget` yet: run it to the end".into())
}

/// Prints the set that the record chooses, of a frame that calls for everything.
pub fn chosen(record: &Record, bound: Bound) -> Outcome<()> {
    let measured = measured(record)?;
    let choices = measured.choices(&Facts::default(), |_| true)?;
    let offers = measured.offers(&choices, measured.fastest_ms, measured.reference_ms);
    let set = match bound {
        Bound::Ms(ms) => offers.within_ms(ms).ok_or_else(|| {
            format!("--budget-ms {ms}: the fastest frame takes {} ms; give more", number(offers.fastest_ms))
        })?,
        Bound::Codes(codes) => offers.within_codes(codes).ok_or("--max-error: no set is as accurate")?,
    };
    for ((group, options), index) in choices.iter().zip(&set.options) {
        program::line(format_args!("{}: {}", group.name, options[*index].name));
    }
    program::line(format_args!(
        "{} ms, {} codes from the reference, on {}",
        number(set.ms),
        number(set.codes()),
        record.adapter
    ));
    Ok(())
}

/// Chooses for random budgets, draws and times what was chosen, and every swap of one option.
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
        "{} of {} frames within their budgets ({:.0} %, {:.0} % asked); {} sets, {} swaps of one option within the budget, of \
         which {} err less by more than a twentieth",
        found.within,
        found.budgets,
        100.0 * share,
        100.0 * ENOUGH,
        found.sets,
        found.swaps,
        found.better.len()
    ));
    if share < ENOUGH || !found.better.is_empty() {
        return Err("frames are not what they should be".into());
    }
    Ok(())
}
