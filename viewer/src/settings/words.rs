//! What the document of settings says of a field, for tooltips.

/// The document, as it was when this program was built.
const TEXT: &str = include_str!("../../../docs/settings.md");

/// What a field is, by its path (`settings.shadows.filter`): the row of the field itself, or of the field that holds it.
pub fn about(path: &str) -> Option<String> {
    let mut names = path.split('.');
    let first = names.next()?;
    let (section, name) = match (first, names.next()) {
        ("settings", Some(name)) => ("## `settings`", name),
        _ => ("## `frame`", first),
    };
    let rows = TEXT.split_once(section)?.1.split("\n## ").next()?;
    let row = rows.lines().find_map(|line| line.strip_prefix(&format!("| `{name}` | ")))?;
    let what = row.split(" | ").next()?;
    Some(format!("{name}: {}", plain(what)))
}

/// Without marks and addresses of Markdown.
fn plain(text: &str) -> String {
    let mut out = String::new();
    for (index, part) in text.split("](").enumerate() {
        let after = if index == 0 { part } else { part.split_once(')').map_or("", |(_, after)| after) };
        out.push_str(after);
    }
    out.replace(['`', '['], "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_found_and_marks_are_gone() {
        let shadows = about("settings.shadows.bias.slope").expect("a row");
        assert!(shadows.starts_with("shadows: None, or map_texels (16 to 16384)"), "{shadows}");
        assert!(about("settings.taa").is_some_and(|text| text.ends_with("(TAA)")));
        assert!(about("quality").is_some_and(|text| text.contains("Ultra")) && about("settings.nothing").is_none());
    }
}
