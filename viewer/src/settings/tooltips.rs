//! Tooltips of settings fields from `docs/reference/settings.md`.

/// Text of the document at build time.
const TEXT: &str = include_str!("../../../docs/reference/settings.md");

/// Returns the documentation of a field by its path, such as `settings.shadows.filter`: its own row, or that of its parent.
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

/// Removes Markdown markup and link targets.
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
