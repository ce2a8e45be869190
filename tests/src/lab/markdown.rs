//! Markdown document of a record, such as `docs/measurements/accuracy.md`.

use super::answers;
use super::record::{ChoiceRecord, Record, TechniqueRecord};
pub use super::statistics::number;

use super::statistics::Times;

/// Returns the document.
pub fn document(record: &Record) -> String {
    let Record { adapter, size_px, load, warm_up, repeats, scene, quick, optimized, .. } = record;
    let mut text = format!(
        "# Error and cost of approximations\n\n\
        Printed by `cargo run {}-p tests --bin accuracy{}` from the `accuracy.json` in the same folder. Each table compares \
        the options of one setting: their error against a stated reference, and the time of a whole frame.\n\n\
        Adapter: {adapter}. Frames have {} × {} pixels. Each option is timed in {repeats} frames after {warm_up} warm-up \
        frames, interleaved with the other options of its table in random order. The machine has {} processors and had a \
        load average of {:.1}. Times are of this adapter: those of a software driver say nothing about a GPU, and only ratios \
        within a table are meaningful.\n\n\
        *Best* marks Pareto-optimal options: no other has a lower error and a lower time (or fewer operations, if no frame \
        is timed). Times are medians with their 95 % bootstrap interval. `≈` marks options whose interval overlaps that of \
        the fastest, which are not distinguishable from it. An error below three standard errors of the reference is not \
        printed. *Steps* is the sum of the median GPU times of the frame's steps, without waiting and recording. Operations \
        are counted in the shader's function: arithmetic + transcendental + texture + conversion. Differences of pictures \
        are in 8-bit steps, 1/255 of white.{}\n\n",
        if *optimized { "--release " } else { "" },
        if *quick { " -- --quick" } else { "" },
        size_px[0],
        size_px[1],
        load[0],
        load[1],
        scene.as_ref().map_or_else(String::new, |scene| format!(" All pictures show the scene `{scene}`.")),
    );
    text.push_str(&answers::taps(record));
    text.push_str("Options in which presets differ:\n\n");
    text.push_str(&answers::presets(record));
    text.push_str("\nAll settings:\n\n");
    text.push_str("| setting | options | smallest to largest error | unit | fastest to slowest |\n| --- | --- | --- | --- | --- |\n");
    record.techniques.iter().for_each(|technique| text.push_str(&overview(technique)));
    record.techniques.iter().for_each(|technique| text.push_str(&section(technique)));
    record.budget.iter().for_each(|measured| text.push_str(&answers::budget(measured)));
    text
}

fn overview(technique: &TechniqueRecord) -> String {
    let span = |values: &[f64]| {
        let [low, high] = [f64::min, f64::max].map(|pick| values.iter().copied().reduce(pick).unwrap_or(0.0));
        format!("{} … {}", number(low), number(high))
    };
    let errors: Vec<f64> = technique.choices.iter().map(|choice| choice.error).collect();
    let times: Vec<f64> = technique.choices.iter().filter_map(|choice| Some(choice.ms?.median)).collect();
    let times = if times.is_empty() { "–".to_owned() } else { span(&times) + " ms" };
    let TechniqueRecord { name, unit, choices, .. } = technique;
    format!("| [{name}](#{name}) | {} | {} | {unit} | {times} |\n", choices.len(), span(&errors))
}

fn section(technique: &TechniqueRecord) -> String {
    let TechniqueRecord { name, what, truth, unit, choices } = technique;
    let mut text = format!("\n## {name}\n\n{what} Reference: {truth}\n\n");
    let any = |has: fn(&ChoiceRecord) -> bool| choices.iter().any(has);
    let columns: [(&str, bool); 10] = [
        ("option", true),
        ("", true),
        (unit, true),
        ("bias", any(|c| c.bias.is_some())),
        ("noise", any(|c| c.noise.is_some())),
        ("worst, 99.9 %, PSNR, FLIP, relative MSE", any(|c| c.picture.is_some())),
        ("ms", any(|c| c.ms.is_some())),
        ("steps, ms", any(|c| !c.steps.is_empty())),
        ("operations", any(|c| c.operations.is_some())),
        ("presets", any(|c| !c.presets.is_empty())),
    ];
    let shown = |cells: [String; 10]| {
        let kept = cells.into_iter().zip(columns).filter(|(_, (_, shown))| *shown).map(|(cell, _)| cell);
        format!("| {} |\n", kept.collect::<Vec<_>>().join(" | "))
    };
    text.push_str(&shown(columns.map(|(head, _)| head.to_owned())));
    text.push_str(&shown(columns.map(|_| "---".to_owned())));
    let fastest = choices.iter().filter_map(|choice| choice.ms).min_by(|a, b| a.median.total_cmp(&b.median));
    for (choice, best) in choices.iter().zip(technique.front()) {
        text.push_str(&shown(cells(choice, best, fastest)));
    }
    text
}

fn cells(choice: &ChoiceRecord, best: bool, fastest: Option<Times>) -> [String; 10] {
    let optional = |value: Option<f64>| value.map_or_else(String::new, number);
    let picture = choice.picture.map_or_else(String::new, |p| {
        let psnr = p.psnr_db.map_or_else(|| "∞".to_owned(), |db| format!("{db:.1} dB"));
        format!("{:.0}, {}, {psnr}, {:.4}, {:.1e}", p.worst, number(p.p999), p.flip, p.relative_mse)
    });
    let ms = choice.ms.map_or_else(String::new, |t| {
        let same = fastest.is_some_and(|fastest| fastest.median < t.median && !fastest.differs_from(&t));
        let mark = if same { "≈ " } else { "" };
        format!(
            "{mark}{} ({}…{}; min {}, p25 {})",
            number(t.median),
            number(t.low),
            number(t.high),
            number(t.min),
            number(t.p25)
        )
    });
    let steps = match choice.steps.iter().map(|step| step.median).sum::<f64>() {
        0.0 => String::new(),
        ms => number(ms),
    };
    let operations = choice.operations.map_or_else(String::new, |parts| parts.map(|n| n.to_string()).join(" + "));
    let error = if choice.is_void() {
        format!("below {}, the reference's own", number(3.0 * choice.truth_error))
    } else {
        number(choice.error)
    };
    [
        choice.name.clone(),
        if best { "best".to_owned() } else { String::new() },
        error,
        optional(choice.bias),
        optional(choice.noise),
        picture,
        ms,
        steps,
        operations,
        choice.presets.join(", "),
    ]
}
