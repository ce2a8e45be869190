//! What a newcomer asks, answered from a record: what more taps cost, what each preset has, what a budget buys.

use super::record::{ChoiceRecord, Record};
use super::statistics::number;
use framegraph_passes::budget::{Choices, Chosen, Measured, Offers};
use framegraph_passes::{Facts, FrameSettings, Preset};
use std::fmt::Write as _;

/// What one of two options costs against the other, in a sentence: error, time, and who has them.
pub fn taps(record: &Record) -> String {
    let taps = record.techniques.iter().find(|technique| technique.name == "ao-taps");
    let of = |count: &str| taps?.choices.iter().find(|choice| choice.name.starts_with(count));
    let (Some(few), Some(many), Some(technique)) = (of("7 "), of("16 "), taps) else { return String::new() };
    let told = |choice: &ChoiceRecord| {
        let ms = choice.ms.map_or_else(|| "was not timed".to_owned(), |ms| format!("takes {} ms", number(ms.median)));
        let step = choice.steps.iter().find(|step| step.passes.split(" + ").any(|pass| pass == "occlusion"));
        let step =
            step.map_or_else(String::new, |step| format!(", {} of them the step `occlusion`", number(step.median)));
        let noise = choice.noise.map_or_else(String::new, |noise| format!(", of which noise {}", number(noise)));
        let presets = choice.presets.join(" and ");
        let presets =
            if presets.is_empty() { "no preset has it".to_owned() } else { format!("preset {presets} has it") };
        format!(
            "**{}** errs by {} ({}{noise}), a frame {ms}{step}, and {presets}",
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

/// What each preset has of each choice that presets differ in.
pub fn presets(record: &Record) -> String {
    let mut text = String::from("| choice | low | medium | high | ultra |\n| --- | --- | --- | --- | --- |\n");
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

/// The option that a frame has of each group; none where it has one of its own.
fn set_of(choices: &Choices, frame: &FrameSettings) -> Vec<Option<usize>> {
    let has = |options: &Vec<&framegraph_passes::budget::FrameOption>| {
        options.iter().position(|option| {
            let mut changed = *frame;
            (option.apply)(&mut changed);
            changed == *frame
        })
    };
    choices.iter().map(|(_, options)| has(options)).collect()
}

/// What options take and err by as parts of one frame, what a budget buys, and where presets are against that.
pub fn budget(measured: &Measured) -> String {
    let Ok(choices) = measured.choices(&Facts::default(), |_| true) else { return String::new() };
    let offers = measured.offers(&choices, measured.fastest_ms, measured.reference_ms);
    let mut text = format!(
        "\n## budget\n\nWhat options take and err by as parts of one frame: each is changed alone of the *reference*, the finest \
        preset with the finest option of each, and compared with the reference's picture. The reference takes {} ms, the frame \
        with the cheapest option of each {} ms. `render --budget-ms` and `--max-error` choose from this table; scenes leave out \
        groups that they do not call for. *Saved* is what a frame takes less with the option than the reference.\n\n\
        | group | scene | option | codes, RMS | ms | saved, ms |\n| --- | --- | --- | --- | --- | --- |\n",
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
        text.push_str("\nErrors of independent options add up as squares. These do not, by so many codes squared:\n\n");
        text.push_str("| one | other | beyond the sum |\n| --- | --- | --- |\n");
        for pair in &measured.pairs {
            let [one, other] = pair.options.each_ref().map(|[group, option]| format!("{group}: {option}"));
            let _ = writeln!(text, "| {one} | {other} | {} |", number(pair.squares));
        }
    }
    text.push_str(&preset_rows(&choices, &offers));
    text
}

/// Presets as sets of the groups, and the most accurate set in the same time.
fn preset_rows(choices: &Choices, offers: &Offers) -> String {
    let mut text = String::from(
        "\nPresets as sets of these groups, on a frame that calls for all of them; beside each the most accurate set that is \
        predicted to take no more, and in which groups it is another one.\n\n\
        | preset | codes | ms | best in that time: codes | where it differs |\n| --- | --- | --- | --- | --- |\n",
    );
    for preset in Preset::ALL {
        let own = set_of(choices, &preset.frame());
        // What no option stands for is taken for the finest below it: none of the presets has such.
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
    use framegraph_passes::budget::{FrameOption, GROUPS};

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
