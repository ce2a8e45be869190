//! Tables of `docs/reference/settings.md`, printed from the tables of settings.

use super::{alternatives, tree};
use framegraph_passes::FrameSettings;
use framegraph_passes::frame::tables::{Row, Section, sections};
use std::fmt::Write;

const BEGIN: &str = "<!-- settings -->\n";
const END: &str = "<!-- end -->";

/// Returns one table for each effect.
fn document() -> String {
    let plain = tree(&FrameSettings::DEFAULT).expect("a tree");
    let mut out = String::new();
    for section in sections() {
        let is_off = plain.at(section.path).is_some_and(|value| value.variant() == Some("None"));
        let name = if section.path.is_empty() { "frame" } else { section.path };
        _ = writeln!(out, "### `{name}`\n\n{}\n", introduction(section, is_off));
        _ = writeln!(out, "| field | key | values | default | effect |\n| --- | --- | --- | --- | --- |");
        for row in &section.rows {
            _ = writeln!(out, "{}", line(section, row));
        }
        out.push('\n');
    }
    out
}

fn introduction(section: &Section, is_off: bool) -> String {
    let mut text = section.about.to_owned();
    text[..1].make_ascii_uppercase();
    if is_off {
        text += "; `None` by default";
    }
    match (section.option, section.methods.is_empty()) {
        ("", _) => text + ".",
        (option, true) => format!("{text}. Option: `--{option} KEY=X,…`."),
        (option, false) if option == "shadow" => format!("{text}. Option: `--{option} KEY=X,…`."),
        (option, false) => format!("{text}. Option: `--{option} {}[:KEY=X,…]`.", section.methods.join("\\|")),
    }
}

fn line(section: &Section, row: &Row) -> String {
    let field = row.path.strip_prefix(section.path).unwrap_or_default().trim_start_matches('.');
    let whole = tree(&row.frame).expect("a tree");
    let default = whole.at(&row.path).filter(|_| !row.path.is_empty()).map(ToString::to_string);
    let code = |text: &str| if text.is_empty() { String::new() } else { format!("`{}`", text.replace('|', "\\|")) };
    let unit = row.unit();
    let values = match (alternatives(&row.path), row.range) {
        (Some(all), Some([low, high])) if all.len() == 2 && all[0] == "None" => {
            format!("`None`, or {}", between(low, high, unit))
        }
        (Some(all), _) => all.iter().map(|value| code(value)).collect::<Vec<_>>().join(", "),
        (None, Some([low, high])) => between(low, high, unit),
        (None, None) if row.path.is_empty() => row.takes.replace('|', "\\|"),
        (None, None) => "`true`, `false`".into(),
    };
    let (field, key) = (code(field), code(row.key));
    format!("| {field} | {key} | {values} | {} | {} |", code(&default.unwrap_or_default()), row.about)
}

fn between(low: f64, high: f64, unit: &str) -> String {
    format!("{} to {} {unit}", low as f32, high as f32).trim_end().to_owned()
}

/// `FRAMEGRAPH_WRITE_REFERENCES=1` writes the tables anew.
#[test]
fn the_document_has_the_tables() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/reference/settings.md");
    let text = std::fs::read_to_string(path).expect("the document");
    let (before, rest) = text.split_once(BEGIN).expect("the begin of the tables");
    let (found, after) = rest.split_once(END).expect("the end of the tables");
    let expected = format!("\n{}", document());
    if std::env::var_os("FRAMEGRAPH_WRITE_REFERENCES").is_some() {
        std::fs::write(path, format!("{before}{BEGIN}{expected}{END}{after}")).expect("the document is written");
        return;
    }
    assert!(
        found == expected,
        "docs/reference/settings.md: set FRAMEGRAPH_WRITE_REFERENCES=1 to write the tables anew"
    );
}
