//! Tolerances of references: rules stated in words.

use super::metrics::{Metrics, relative_error};
use super::picture::Picture;
use std::path::PathBuf;

/// Metric of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Number {
    /// Peak signal-to-noise ratio, in dB.
    Psnr,
    /// Mean FLIP error.
    Flip,
    /// Share of pixels that differ by more than 2 8-bit steps.
    Off2,
    /// Share of pixels that differ by more than 8 8-bit steps.
    Off8,
    /// Median of the relative error.
    Relative50,
    /// 95th percentile of the relative error.
    Relative95,
    /// 99th percentile of the relative error.
    Relative99,
}

impl Number {
    const NAMES: [(&'static str, Self); 8] = [
        ("psnr_srgb", Self::Psnr),
        ("psnr", Self::Psnr),
        ("flip", Self::Flip),
        ("frac_gt_2lsb", Self::Off2),
        ("frac_gt_8lsb", Self::Off8),
        ("rel_p50", Self::Relative50),
        ("rel_p95", Self::Relative95),
        ("rel_p99", Self::Relative99),
    ];

    fn of(self, metrics: &Metrics) -> f64 {
        match self {
            Self::Psnr => metrics.psnr_db,
            Self::Flip => metrics.flip,
            Self::Off2 => metrics.off_2,
            Self::Off8 => metrics.off_8,
            Self::Relative50 => metrics.relative[0],
            Self::Relative95 => metrics.relative[1],
            Self::Relative99 => metrics.relative[2],
        }
    }
}

/// A parsed rule.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    /// If given, this picture beside the statement is filtered by FXAA and judged, instead of a rendered scene.
    pub filtered: Option<PathBuf>,
    /// Clauses that must hold.
    pub clauses: Vec<Clause>,
    /// Clauses that should hold; violations are reported and do not fail.
    pub soft: Vec<Clause>,
}

/// Clause of a rule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clause {
    /// The metric is at least this value.
    AtLeast(Number, f64),
    /// The metric is at most this value.
    AtMost(Number, f64),
    /// Limits each channel of the pixel at the center of every sphere.
    Centres {
        /// Expected value, linear light.
        light: f64,
        /// Maximum difference.
        within: f64,
    },
    /// Limits the center of every patch of the chart.
    Patches {
        /// Maximum difference of most patches, in 8-bit steps.
        codes: f64,
        /// Minimum share of patches within this difference, 0…1.
        share: f64,
        /// Maximum difference of any patch, in 8-bit steps; infinity if not limited.
        worst: f64,
    },
}

/// A patch of a chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// Center of the patch, x and y in 0…1 from the top left.
    pub at: [f64; 2],
    /// Color of the reference, as 8-bit values or linear light.
    pub expected: [f64; 3],
    /// True if the color has 8-bit values.
    pub codes: bool,
}

/// Data that clauses evaluate.
#[derive(Clone, Copy, Debug)]
pub struct Evidence<'a> {
    /// Rendered picture.
    pub picture: &'a Picture,
    /// Metrics of the picture, if the reference is a picture.
    pub metrics: Option<&'a Metrics>,
    /// Patches of the reference, if it is a chart.
    pub patches: &'a [Patch],
    /// Centers of spheres in the picture, x and y in 0…1 from the top left.
    pub centres: &'a [[f64; 2]],
}

/// Parses a rule: clauses separated by commas, semicolons or `and`, after an optional `apply FXAA to FILE:`. Clauses
/// after `SOFT:` are soft. Text in parentheses is ignored.
///
/// # Errors
/// The first part that is not understood.
pub fn parse(text: &str) -> Result<Rule, String> {
    let plain = without_brackets(text).replace('≥', ">=").replace('≤', "<=").replace('±', "+-");
    let (filtered, plain) = match plain.trim_start().strip_prefix("apply FXAA to ").and_then(|p| p.split_once(": ")) {
        Some((file, after)) => (Some(PathBuf::from(file)), after),
        None => (None, plain.as_str()),
    };
    let (hard, soft) = plain.split_once("SOFT:").unwrap_or((plain, ""));
    let (clauses, soft) = (clauses(hard)?, clauses(soft)?);
    if clauses.is_empty() && soft.is_empty() { Err(text.to_owned()) } else { Ok(Rule { filtered, clauses, soft }) }
}

/// Parses clauses. A clause that starts with `<=` limits all patches, after one that limits most.
fn clauses(text: &str) -> Result<Vec<Clause>, String> {
    let mut found: Vec<Clause> = Vec::new();
    let parts = text.split([',', ';']).flat_map(|part| part.split(" and "));
    let parts = parts.map(|part| part.trim().trim_start_matches("and ").trim()).filter(|part| !part.is_empty());
    for part in parts {
        match (everywhere(part), found.last_mut()) {
            (Some(codes), Some(Clause::Patches { worst, .. })) => *worst = codes,
            _ => found.push(clause(part).ok_or_else(|| part.to_owned())?),
        }
    }
    Ok(found)
}

/// Parses `<=6/255 everywhere`.
fn everywhere(part: &str) -> Option<f64> {
    number(part.strip_prefix("<=")?.strip_suffix("everywhere")?.trim_end().strip_suffix("/255")?)
}

fn without_brackets(text: &str) -> String {
    let mut depth = 0_usize;
    let kept = text.chars().filter(|c| {
        match c {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => return depth == 0,
        }
        false
    });
    kept.collect()
}

fn clause(part: &str) -> Option<Clause> {
    if let Some(rest) = part.strip_prefix("every sphere centre ") {
        let (light, within) = rest.split_once("+-")?;
        return Some(Clause::Centres { light: number(light)?, within: number(within)? });
    }
    if let Some(rest) = part.strip_prefix("|out-ref|") {
        if let Some(codes) = everywhere(rest) {
            return Some(Clause::Patches { codes, share: 1.0, worst: codes });
        }
        let (codes, rest) = rest.strip_prefix("<=")?.split_once("/255 on >=")?;
        let (percent, _) = rest.split_once('%')?;
        let share = number(percent)? / 100.0;
        return Some(Clause::Patches { codes: number(codes)?, share, worst: f64::INFINITY });
    }
    let (name, least, value) = match (part.split_once(">="), part.split_once("<=")) {
        (Some((name, value)), None) => (name, true, value),
        (None, Some((name, value))) => (name, false, value),
        _ => return None,
    };
    let (_, known) = Number::NAMES.into_iter().find(|(known, _)| *known == name.trim())?;
    let value = number(value)?;
    Some(if least { Clause::AtLeast(known, value) } else { Clause::AtMost(known, value) })
}

fn number(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|n: &f64| n.is_finite())
}

/// Returns one line for each clause that does not hold.
pub fn failures(clauses: &[Clause], evidence: Evidence<'_>) -> Vec<String> {
    clauses.iter().filter_map(|clause| failure(*clause, evidence)).collect()
}

fn failure(clause: Clause, evidence: Evidence<'_>) -> Option<String> {
    let Evidence { picture, metrics, patches, centres } = evidence;
    let found = |number: Number| metrics.map(|m| number.of(m));
    match clause {
        // Comparisons are written so that NaN fails.
        Clause::AtLeast(number, least) => match found(number) {
            Some(value) if value >= least => None,
            value => Some(format!("{number:?} is {}, not at least {least}", told(value))),
        },
        Clause::AtMost(number, most) => match found(number) {
            Some(value) if value <= most => None,
            value => Some(format!("{number:?} is {}, not at most {most}", told(value))),
        },
        Clause::Centres { light, within } => {
            let off = |at: &[f64; 2]| {
                picture.linear[picture.at(*at)].iter().map(|c| (f64::from(*c) - light).abs()).fold(0.0, worse)
            };
            let worst = centres.iter().map(off).fold(0.0, worse);
            let good = !centres.is_empty() && worst <= within;
            (!good).then(|| {
                format!("the worst of {} centers of spheres is off by {worst:.4}, not by {within}", centres.len())
            })
        }
        Clause::Patches { codes, share, worst } => {
            let off: Vec<f64> = patches.iter().map(|patch| codes_off(picture, patch)).collect();
            let near = off.iter().filter(|o| **o <= codes).count() as f64 / off.len().max(1) as f64;
            let most = off.iter().copied().fold(0.0, worse);
            let good = !off.is_empty() && near >= share && most <= worst;
            (!good).then(|| {
                format!(
                    "{:.1} % of {} patches are within {codes} codes, the worst is off by {most:.1}",
                    near * 100.0,
                    off.len()
                )
            })
        }
    }
}

fn told(value: Option<f64>) -> String {
    value.map_or("unknown".into(), |v| format!("{v:.4}"))
}

/// Returns the larger number, or NaN if one is NaN.
fn worse(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// Returns the difference at the center of a patch in 8-bit steps; linear light is encoded first.
pub fn codes_off(picture: &Picture, patch: &Patch) -> f64 {
    let at = picture.at(patch.at);
    let reference = if patch.codes {
        patch.expected
    } else {
        Picture::from_linear([1, 1], vec![patch.expected.map(|c| c as f32)]).encoded[0].map(|c| f64::from(c) * 255.0)
    };
    (0..3).map(|c| (f64::from(picture.encoded[at][c]) * 255.0 - reference[c]).abs()).fold(0.0, worse)
}

/// Returns the largest relative error of a patch's channels, in linear light.
pub fn patch_relative(picture: &Picture, patch: &Patch) -> f64 {
    let at = picture.at(patch.at);
    (0..3).map(|c| relative_error(picture.linear[at][c].into(), patch.expected[c])).fold(0.0, worse)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rules_of_the_references_are_understood() {
        let clauses = |text: &str| parse(text).map(|rule| rule.clauses);
        assert_eq!(
            clauses("psnr_srgb>=40, flip<=0.03, rel_p50<=0.01"),
            Ok(vec![
                Clause::AtLeast(Number::Psnr, 40.0),
                Clause::AtMost(Number::Flip, 0.03),
                Clause::AtMost(Number::Relative50, 0.01)
            ])
        );
        assert_eq!(
            clauses("every sphere centre 1.00 +-0.01; psnr_srgb>=50"),
            Ok(vec![Clause::Centres { light: 1.0, within: 0.01 }, Clause::AtLeast(Number::Psnr, 50.0)])
        );
        assert_eq!(
            clauses("|out-ref|<=2/255 on >=98% of the 768 patches and <=6/255 everywhere (csv)"),
            Ok(vec![Clause::Patches { codes: 2.0, share: 0.98, worst: 6.0 }])
        );
        assert_eq!(
            parse("apply FXAA to 07_edges_none.png: psnr>=42 (no FXAA = 33.8)"),
            Ok(Rule {
                filtered: Some("07_edges_none.png".into()),
                clauses: vec![Clause::AtLeast(Number::Psnr, 42.0)],
                soft: Vec::new()
            })
        );
        let patches = |codes, share, worst| Clause::Patches { codes, share, worst };
        let (near, flip) = (Clause::AtLeast(Number::Psnr, 29.0), Clause::AtMost(Number::Flip, 0.11));
        for (text, hard, soft) in [
            ("psnr_srgb >= 29 and flip <= 0.11", vec![near, flip], vec![]),
            ("SOFT: psnr_srgb>=29, flip<=0.11 (another model)", vec![], vec![near, flip]),
            ("psnr≥29; SOFT: flip≤0.11", vec![near], vec![flip]),
            ("|out-ref|<=2/255 on >=98% of the patches", vec![patches(2.0, 0.98, f64::INFINITY)], vec![]),
            ("|out-ref|<=2/255 everywhere and flip<=0.11", vec![patches(2.0, 1.0, 2.0), flip], vec![]),
            (
                "|out-ref|<=3/255 on >=97%, and <=12/255 everywhere, flip<=0.11",
                vec![patches(3.0, 0.97, 12.0), flip],
                vec![],
            ),
        ] {
            assert_eq!(parse(text), Ok(Rule { filtered: None, clauses: hard, soft }), "{text}");
        }
        assert_eq!(parse("<=6/255 everywhere"), Err("<=6/255 everywhere".into()));
        assert_eq!(parse("psnr>=42, looks nice"), Err("looks nice".into()));
        assert_eq!(parse("psnr>=fine"), Err("psnr>=fine".into()));
        assert_eq!(parse("(nothing)"), Err("(nothing)".into()));
    }

    #[test]
    fn clauses_hold_or_say_what_is_wrong() {
        let picture = Picture::from_linear([2, 1], vec![[1.0, 1.0, 1.005], [0.5, 0.5, f32::NAN]]);
        let evidence = |centres| Evidence { picture: &picture, metrics: None, patches: &[], centres };
        let clause = [Clause::Centres { light: 1.0, within: 0.01 }];
        assert!(failures(&clause, evidence(&[[0.25, 0.5]])).is_empty());
        for centres in [&[][..], &[[0.75, 0.5]], &[[0.25, 0.5], [0.75, 0.5]]] {
            assert_eq!(failures(&clause, evidence(centres)).len(), 1, "{centres:?}");
        }
        assert_eq!(failures(&[Clause::AtLeast(Number::Psnr, 1.0)], evidence(&[])).len(), 1, "nothing was compared");
        let patch = |x: f64, code: f64| Patch { at: [x, 0.5], expected: [code; 3], codes: true };
        let of = |patches: &[Patch]| {
            let clause = [Clause::Patches { codes: 2.0, share: 0.5, worst: 6.0 }];
            failures(&clause, Evidence { patches, ..evidence(&[]) })
        };
        assert!(of(&[patch(0.25, 250.0), patch(0.25, 254.0)]).is_empty());
        assert_eq!(of(&[patch(0.25, 248.0)]).len(), 1, "the worst");
        assert_eq!(of(&[patch(0.25, 250.0), patch(0.25, 250.0), patch(0.25, 254.0)]).len(), 1, "the share");
        assert_eq!(of(&[]).len(), 1, "no patches");
    }
}
