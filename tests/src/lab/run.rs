//! Measures techniques and records the results.

use super::html::strip;
use super::record::{ChoiceRecord, TechniqueRecord};
use super::studio::{Ready, Studio, compared, times};
use super::technique::{Choice, Measured, Outcome, Subject, Technique};
use crate::reference::picture::Picture;
use framegraph_shader_mirrors::cases;
use framegraph_shaders::reflect::Operations;
use program::outputs::Outputs;
use std::path::Path;

/// Measures a technique; writes one picture per option into `pictures`.
///
/// # Errors
/// Any error of the device, or a picture that cannot be written.
pub fn measure(studio: &Studio<'_>, technique: &Technique, pictures: &Path) -> Outcome<TechniqueRecord> {
    let truth = technique.picture.as_ref().map(|truth| studio.truth(truth)).transpose()?;
    let mut choices = Vec::new();
    let (mut timed, mut ready) = (Vec::new(), Vec::new());
    for (index, choice) in technique.choices.iter().enumerate() {
        if let Some(setup) = &choice.setup {
            timed.push(index);
            ready.push(studio.prepare(setup, studio.size_px)?);
        }
        let drawn = ready.last_mut().filter(|_| choice.setup.is_some());
        let mut record = judged(studio, technique, choice, drawn, truth.as_ref(), pictures)?;
        record.operations = operations(choice);
        choices.push(record);
        program::interrupt::check()?;
    }
    let times = times(studio.gpu, &mut ready, studio.rounds)?;
    for ((index, times), mut ready) in timed.into_iter().zip(times).zip(ready) {
        (choices[index].ms, choices[index].steps) = (Some(times), ready.steps()?);
    }
    let Technique { name, what, truth, unit, .. } = technique;
    let mut record =
        TechniqueRecord { name: name.clone(), what: what.clone(), truth: truth.clone(), unit: unit.clone(), choices };
    technique.note_presets(&mut record);
    Ok(record)
}

fn judged(
    studio: &Studio<'_>,
    technique: &Technique,
    choice: &Choice,
    drawn: Option<&mut Ready>,
    truth: Option<&(Picture, f64)>,
    pictures: &Path,
) -> Outcome<ChoiceRecord> {
    let (measured, picture) = match &choice.subject {
        Subject::Formula(measure) => (measure(studio.gpu)?, None),
        Subject::Picture => {
            let (truth, truth_error) = truth.ok_or("a picture with nothing to compare it with")?;
            let drawn = drawn.ok_or("a picture of no frame")?;
            let (ours, noise) = (drawn.picture(studio.gpu)?, drawn.trembles(studio.gpu)?);
            let (error, bias, picture) = compared(&ours, truth)?;
            let file = pictures.join(format!("{}.{}.png", technique.name, file_name(&choice.name)));
            Outputs::one(&file, &strip(&ours, truth)?)?;
            let truth_error = *truth_error;
            (Measured { error, bias: Some(bias), noise, truth_error }, Some(picture))
        }
    };
    let Measured { error, bias, noise, truth_error } = measured;
    if !error.is_finite() {
        return Err(format!("{}, {}: the error is {error}", technique.name, choice.name).into());
    }
    let name = choice.name.clone();
    let (ms, steps, operations, presets) = (None, Vec::new(), None, Vec::new());
    Ok(ChoiceRecord { name, error, bias, noise, truth_error, picture, ms, steps, operations, presets })
}

/// Returns an option's name as part of a file name.
pub fn file_name(choice: &str) -> String {
    choice.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' }).collect()
}

fn operations(choice: &Choice) -> Option<[u32; 4]> {
    let mut sum = None;
    for (function, in_half) in &choice.functions {
        let known = |case: &cases::Case| case.function == *function;
        let case = if *in_half { cases::half().find(known)? } else { *cases::all().find(|case| known(case))? };
        let found = Operations::of(&case.shader().ok()?.wgsl, function)?;
        let all = sum.get_or_insert([0; 4]);
        for (all, own) in all.iter_mut().zip([found.arithmetic, found.transcendental, found.texture, found.conversion])
        {
            *all += own;
        }
    }
    sum
}
