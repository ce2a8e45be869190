//! Tooltips and ranges of fields, from the tables of settings.

use framegraph_passes::frame::tables::{Row, sections};

/// Returns the description of a field by its path, such as `settings.shadows.filter`: its own, or that of its effect.
pub fn about(path: &str) -> Option<String> {
    if let Some(row) = row(path) {
        return Some(format!("{}: {} ({})", row.key, row.about, row.takes));
    }
    let section = sections().iter().find(|section| !section.path.is_empty() && section.path == path)?;
    Some(section.about.replace('`', ""))
}

/// Returns the range of the number at a path.
pub fn range(path: &str) -> Option<[f64; 2]> {
    row(path)?.range
}

fn row(path: &str) -> Option<&'static Row> {
    sections().iter().flat_map(|section| &section.rows).find(|row| !row.path.is_empty() && row.path == path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_and_effects_are_described() {
        let slope = about("settings.shadows.bias.slope").expect("a row");
        assert!(slope.starts_with("slope-bias: ") && slope.ends_with("(a number from 0 to 100)"), "{slope}");
        assert_eq!(range("settings.shadows.bias.slope"), Some([0.0, 100.0]));
        assert_eq!(about("settings.taa").as_deref(), Some("temporal anti-aliasing"));
        assert!(about("quality").is_some_and(|text| text.contains("ultra")) && about("settings.nothing").is_none());
    }
}
