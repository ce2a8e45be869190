//! Proved bounds of options hold on random scenes.

use crate::stage::gpu;
use framegraph_passes::quality::StepBound;
use std::error::Error;
use tests::measure::bounds::search;

#[test]
fn random_scenes_keep_proved_bounds_and_break_a_planted_one() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu("random_scenes_keep_proved_bounds_and_break_a_planted_one") else { return Ok(()) };
    let found = search(&gpu, 0..8, &|_, _| None, &mut |_| {})?;
    assert!(found.broken == 0 && found.worst.0 < 1.0 && found.proved[0] > 3, "{found}");
    let wrong = |group: &framegraph_passes::quality::Group, option: &str| {
        let planted = (group.name, option) == ("sun-shadows", "none");
        planted.then(|| StepBound { steps: 1.0, proof: "planted".into() })
    };
    let found = search(&gpu, 0..8, &wrong, &mut |_| {})?;
    assert!(found.broken > 0 && found.worst.0 > 1.0, "a wrong bound is found: {found}");
    // The rounding of radiance without the factor of exposure compensation.
    let dark = |group: &framegraph_passes::quality::Group, option: &str| {
        let planted = (group.name, option) == ("radiance", "Rg11b10Ufloat");
        planted.then(|| StepBound { steps: 8.0, proof: "planted".into() })
    };
    let found = search(&gpu, 28..29, &dark, &mut |_| {})?;
    assert!(found.broken == 1, "compensation is searched: {found}");
    Ok(())
}
