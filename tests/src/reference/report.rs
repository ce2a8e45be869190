//! Results as a table and as JSON.

use super::examine::{ChartNumbers, Outcome, Verdict};
use super::metrics::Metrics;
use serde_json::{Value, json};

/// Returns one line per reference, then notes on some of them.
pub fn table(outcomes: &[Outcome]) -> String {
    let head = ["reference", "verdict", "PSNR dB", "FLIP", "> 2 codes", "> 8 codes", "rel. p50", "p95", "p99"];
    let mut rows = vec![head.map(String::from)];
    rows.extend(outcomes.iter().map(|outcome| {
        let [psnr, flip, off_2, off_8, p50, p95, p99] = outcome.metrics.map_or(["-"; 7].map(String::from), cells);
        [outcome.id.clone(), word(&outcome.verdict).into(), psnr, flip, off_2, off_8, p50, p95, p99]
    }));
    let mut text = aligned(&rows);
    for outcome in outcomes {
        let said = |line: String| format!("{}: {line}\n", outcome.id);
        match &outcome.verdict {
            Verdict::Passed => {}
            Verdict::Failed(failures) => text.extend(failures.iter().map(|failure| said(format!("failed: {failure}")))),
            Verdict::Missed(missed) => text.extend(missed.iter().map(|part| said(format!("missed softly: {part}")))),
            Verdict::Unjudged(why) => text += &said(format!("not judged: {why}")),
            Verdict::Skipped(keys) => text.extend(keys.iter().map(|key| said(format!("not built: {key}")))),
        }
        if let Some(ChartNumbers { count, within_2, worst_codes, worst_relative }) = outcome.chart {
            let light = worst_relative.map_or(String::new(), |r| format!(", {r:.5} of its light"));
            let share = within_2 * 100.0;
            text += &said(format!(
                "{share:.1} % of {count} patches within 2 codes, the worst off by {worst_codes:.2}{light}"
            ));
        }
        text.extend(outcome.otherwise.iter().map(|key| said(format!("built otherwise: {key}"))));
        if outcome.control == Some(false) {
            text += &said("CONTROL NOT NOTICED: its rule passes light that is a tenth too bright".into());
        }
    }
    text
}

/// Returns the differences of scenes between two ways of rendering, one line each.
pub fn distances(rows: &[(String, Metrics)], what: &str) -> String {
    let head = ["scene", what, "PSNR dB", "FLIP", "> 2 codes", "> 8 codes", "rel. p50", "p95", "p99"];
    let row = |(id, metrics): &(String, Metrics)| {
        let [psnr, flip, off_2, off_8, p50, p95, p99] = cells(*metrics);
        let word = if metrics.psnr_db.is_infinite() { "same" } else { "moves" };
        [id.clone(), word.into(), psnr, flip, off_2, off_8, p50, p95, p99]
    };
    aligned(&[head.map(String::from)].into_iter().chain(rows.iter().map(row)).collect::<Vec<_>>())
}

/// Formats PSNR, FLIP, shares in percent, and relative errors.
pub fn cells(metrics: Metrics) -> [String; 7] {
    let Metrics { psnr_db, flip, off_2, off_8, relative: [p50, p95, p99] } = metrics;
    [
        format!("{psnr_db:.2}"),
        format!("{flip:.5}"),
        format!("{:.3} %", off_2 * 100.0),
        format!("{:.3} %", off_8 * 100.0),
        format!("{p50:.4}"),
        format!("{p95:.4}"),
        format!("{p99:.4}"),
    ]
}

/// Aligns columns, with the first row as the head. The first two are left-aligned, numbers right-aligned.
pub fn aligned<const N: usize>(rows: &[[String; N]]) -> String {
    let widths: [usize; N] =
        std::array::from_fn(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0));
    let line = |cells: [String; N]| format!("| {} |\n", cells.join(" | "));
    let row = |row: &[String; N]| {
        line(std::array::from_fn(|column| {
            let width = widths[column];
            if column < 2 { format!("{:<width$}", row[column]) } else { format!("{:>width$}", row[column]) }
        }))
    };
    let rule = line(widths.map(|width| "-".repeat(width)));
    let (head, body) = rows.split_at(rows.len().min(1));
    head.iter().map(row).chain([rule]).chain(body.iter().map(row)).collect()
}

/// Returns the verdict as a word.
pub const fn word(verdict: &Verdict) -> &'static str {
    match verdict {
        Verdict::Passed => "pass",
        Verdict::Failed(_) => "FAIL",
        Verdict::Missed(_) => "missed",
        Verdict::Unjudged(_) => "no rule",
        Verdict::Skipped(_) => "skipped",
    }
}

/// Version of the output of [`json()`]; `docs/measurements/references.md` has its schema.
pub const JSON_VERSION: u32 = 1;

/// Returns the results as JSON. References that could not be examined follow with the reason. Infinite values are the
/// string `inf`.
pub fn json(outcomes: &[Outcome], errors: &[String]) -> String {
    let number = |n: f64| if n.is_finite() { json!(n) } else { json!("inf") };
    let one = |outcome: &Outcome| {
        let (failures, missing) = match &outcome.verdict {
            Verdict::Failed(failures) | Verdict::Missed(failures) => (failures.as_slice(), &[][..]),
            Verdict::Skipped(keys) => (&[][..], keys.as_slice()),
            _ => (&[][..], &[][..]),
        };
        let metrics = outcome.metrics.map_or(Value::Null, |m| {
            json!({
                "psnr_srgb": number(m.psnr_db), "flip": number(m.flip),
                "frac_gt_2lsb": m.off_2, "frac_gt_8lsb": m.off_8,
                "rel_p50": number(m.relative[0]), "rel_p95": number(m.relative[1]), "rel_p99": number(m.relative[2]),
            })
        });
        let chart = outcome.chart.map_or(Value::Null, |c| {
            json!({
                "patches": c.count, "within_2_codes": c.within_2, "worst_codes": number(c.worst_codes),
                "worst_relative": c.worst_relative.map_or(Value::Null, number),
            })
        });
        json!({
            "id": outcome.id, "verdict": word(&outcome.verdict).to_lowercase(), "metrics": metrics, "chart": chart,
            "failures": failures, "not_built": missing, "built_otherwise": outcome.otherwise,
            "control_noticed": outcome.control,
        })
    };
    let failed = errors.iter().map(|error| json!({ "verdict": "error", "error": error }));
    let references: Vec<Value> = outcomes.iter().map(one).chain(failed).collect();
    format!("{:#}\n", json!({ "schema": "framegraph-references", "version": JSON_VERSION, "references": references }))
}
