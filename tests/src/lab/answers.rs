//! Answers to common questions from a record: the gain of more samples, the options of each preset, the frames within a
//! budget.

use super::record::{ChoiceRecord, Record};
use super::statistics::number;
use framegraph_passes::quality::{Choices, Chosen, Measured, MeasuredShare, Offers};
use framegraph_passes::{Facts, FrameSettings, Preset};
use std::fmt::Write as _;

/// Compares two options of a technique in one sentence: error, time, and the presets that use them.
pub fn taps(record: &Record) -> String {
    let taps = record.techniques.iter().find(|technique| technique.name == "ao-taps");
    let of = |count: &str| taps?.choices.iter().find(|choice| choice.name.starts_with(count));
    let (Some(few), Some(many), Some(technique)) = (of("7 "), of("16 "), taps) else { return String::new() };
    let told = |choice: &ChoiceRecord| {
        let ms = choice.ms.map_or_else(
            || "it was not timed".to_owned(),
            |ms| format!("a frame with it takes {} ms", number(ms.median)),
        );
        let step = choice.steps.iter().find(|step| step.passes.split(" + ").any(|pass| pass == "occlusion"));
        let step = step
            .map_or_else(String::new, |step| format!(", of which {} ms are the step `occlusion`", number(step.median)));
        let noise = choice.noise.map_or_else(String::new, |noise| format!(", of which {} are noise", number(noise)));
        let presets = choice.presets.join(" and ");
        let presets =
            if presets.is_empty() { "no preset uses it".to_owned() } else { format!("preset {presets} uses it") };
        format!(
            "**{}** have an error of {} ({}{noise}), {ms}{step}, and {presets}",
            choice.name,
            number(choice.error),
            technique.unit
        )
    };
    let same = few.ms.zip(many.ms).is_some_and(|(a, b)| !a.differs_from(&b));
    let same = if same { " The two times are not distinguishable in this record." } else { "" };
    format!(
        "What does ambient occlusion with 7 taps cost against 16? {}; {}.{same} More under [ao-taps](#ao-taps).\n\n",
        told(few),
        told(many)
    )
}

/// Returns a table of the options in which presets differ.
pub fn presets(record: &Record) -> String {
    let mut text = String::from("| setting | low | medium | high | ultra |\n| --- | --- | --- | --- | --- |\n");
    for technique in &record.techniques {
        let of = |preset: Preset| {
            let has = |choice: &&ChoiceRecord| choice.presets.iter().any(|own| own == preset.name());
            technique.choices.iter().find(has).map_or("–", |choice| choice.name.as_str())
        };
        let row = Preset::ALL.map(of);
        if row.iter().any(|cell| *cell != row[0]) {
            let _ = writeln!(text, "| [{0}](#{0}) | {1} |", technique.name, row.join(" | "));
        }
    }
    text
}

/// Returns the frame's option in each group; `None` if its value is not among the options.
fn set_of(choices: &Choices, frame: &FrameSettings) -> Vec<Option<usize>> {
    let has = |options: &Vec<&framegraph_passes::quality::FrameOption>| {
        options.iter().position(|option| {
            let mut changed = *frame;
            (option.apply)(&mut changed);
            changed == *frame
        })
    };
    choices.iter().map(|(_, options)| has(options)).collect()
}

/// Describes the cost and error of options as parts of one frame, the frames within a budget, and the position of the
/// presets.
pub fn budget(measured: &Measured) -> String {
    let Ok(choices) = measured.choices(&Facts::default(), |_| true) else { return String::new() };
    let offers = measured.offers(&choices, measured.fastest_ms, measured.reference_ms);
    let mut text = format!(
        "\n## budget\n\nCost and error of options as parts of one frame. The *reference* is the finest preset with the finest option \
        of each group. One option at a time is changed, and the picture is compared with the reference's. The reference takes \
        {} ms, the frame with the cheapest option of each group {} ms. `render --budget-ms` and `--max-error` choose from this \
        table, without the groups that a scene does not use. *Saved* is the time of the reference minus the time with the \
        option.\n\n\
        | group | scene | option | 8-bit steps, RMS | ms | saved, ms |\n| --- | --- | --- | --- | --- | --- |\n",
        number(measured.reference_ms),
        number(measured.fastest_ms)
    );
    for group in &measured.groups {
        let finest = group.options.last().map_or(0.0, |option| option.ms);
        for option in &group.options {
            let cells = [number(option.codes), number(option.ms), number(finest - option.ms)].join(" | ");
            let _ = writeln!(text, "| {} | {} | {} | {cells} |", group.name, group.scene, option.name);
        }
    }
    if !measured.pairs.is_empty() {
        text.push_str("\nSquared errors of independent options add up. These pairs deviate from the sum, in squared 8-bit steps:\n\n");
        text.push_str("| option | option | beyond the sum |\n| --- | --- | --- |\n");
        for pair in &measured.pairs {
            let [one, other] = pair.options.each_ref().map(|[group, option]| format!("{group}: {option}"));
            let _ = writeln!(text, "| {one} | {other} | {} |", number(pair.squares));
        }
    }
    text.push_str(&share_rows(measured));
    text.push_str(&preset_rows(&choices, &offers));
    text
}

/// Lists the shares of a frame that the own passes of options take.
fn share_rows(measured: &Measured) -> String {
    let mut text = String::new();
    if measured.shares.is_empty() {
        return text;
    }
    let _ = write!(
        text,
        "\nShare of a frame that the passes of an option take. The frame is that of a preset with this option, in the scene \
        where the share is largest. Times are the shortest of each step, as printed by \
        `render SCENE --preset PRESET --size 640x360 --timing`. Presets below ultra exclude options above {}. Options without a row have not been measured and are not excluded.\n\n\
        | preset | group | option | scene | share |\n| --- | --- | --- | --- | --- |\n",
        number(Preset::MAX_PASSES)
    );
    for MeasuredShare { preset, option: [group, option], scene, share } in &measured.shares {
        let _ = writeln!(text, "| {preset} | {group} | {option} | {scene} | {} |", number(*share));
    }
    text
}

/// Compares each preset, as a set of options, with the most accurate set of the same cost.
fn preset_rows(choices: &Choices, offers: &Offers) -> String {
    let mut text = String::from(
        "\nPresets as sets of these options, for a frame that uses all groups. The last columns are the most accurate set with \
        at most the same predicted time, and the options in which it differs.\n\n\
        | preset | 8-bit steps | ms | best in that time: 8-bit steps | differences |\n| --- | --- | --- | --- | --- |\n",
    );
    for preset in Preset::ALL {
        let own = set_of(choices, &preset.frame());
        // A value without an option counts as the finest option below it; no preset has one.
        let set: Vec<usize> = own.iter().map(|index| index.unwrap_or(0)).collect();
        let Chosen { ms, .. } = offers.predicted(&set);
        let codes = offers.predicted(&set).codes();
        let (best, differs) = offers.within_ms(ms + 1e-9).map_or_else(
            || (codes, String::new()),
            |best| {
                let other = choices.iter().zip(best.options.iter().zip(&set)).filter(|(_, (a, b))| a != b);
                let names =
                    other.map(|((group, options), (index, _))| format!("{}: {}", group.name, options[*index].name));
                (best.codes(), names.collect::<Vec<_>>().join("; "))
            },
        );
        let _ =
            writeln!(text, "| {} | {} | {} | {} | {differs} |", preset.name(), number(codes), number(ms), number(best));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_passes::quality::{FrameOption, GROUPS};

    #[test]
    fn every_preset_is_a_set_of_the_groups() {
        let all: Choices =
            GROUPS.iter().map(|group| (group, group.options.iter().collect::<Vec<&FrameOption>>())).collect();
        for preset in Preset::ALL {
            let set = set_of(&all, &preset.frame());
            assert!(set.iter().all(Option::is_some), "{}: {set:?}", preset.name());
        }
    }
}
