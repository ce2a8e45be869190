//! `measure bounds`: adversarial search for scenes that break a proved bound.

use crate::{Outcome, adapter};
use program::progress::Shown;
use tests::measure::bounds::search;

/// Searches N random scenes (default 200), from scene FROM (default 0).
pub fn run(words: &[&str]) -> Outcome {
    let number = |word: &&str| word.parse::<u64>().map_err(|_| format!("{word}: expected a whole number"));
    let given = words.iter().map(number).collect::<Result<Vec<_>, _>>()?;
    let (count, from) = match given[..] {
        [] => (200, 0),
        [count] => (count, 0),
        [count, from] => (count, from),
        _ => return Err("usage: measure bounds [N [FROM]]".into()),
    };
    let gpu = adapter()?;
    let mut shown = Shown::default();
    let step = &mut |number| shown.step("scenes", (number - from) as usize, count as usize, "");
    let found = search(&gpu, from..from + count, &|_, _| None, step)?;
    shown.clear();
    program::line(&found);
    Ok(found.broken == 0)
}
