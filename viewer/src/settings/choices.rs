//! Fields with variants or optional values, from the tables of settings.

use super::{Node, settings, tree};
use framegraph_passes::FrameSettings;
use framegraph_passes::frame::tables::sections;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// Alternative values of a field, in RON.
pub type Alternatives = Vec<String>;

/// Returns the alternatives of the field at a path; `None` for numbers, booleans and plain structures.
pub fn alternatives(path: &str) -> Option<Alternatives> {
    static ALL: LazyLock<BTreeMap<String, Alternatives>> = LazyLock::new(|| {
        let mut all = BTreeMap::new();
        for section in sections() {
            let frames = section.methods.iter().filter_map(|method| {
                let mut frame = FrameSettings::DEFAULT;
                section.take(&mut frame, method).ok().map(|()| frame)
            });
            if !section.methods.is_empty() {
                all.insert(section.path.to_owned(), values(section.path, frames));
            }
            for row in &section.rows {
                let frames = row.alternatives.iter().filter_map(|text| {
                    let mut frame = row.frame;
                    row.set(&mut frame, text).ok().map(|()| frame)
                });
                all.insert(row.path.clone(), values(&row.path, frames));
            }
        }
        all.retain(|path, values| !path.is_empty() && values.len() > 1);
        all
    });
    ALL.get(path).cloned()
}

/// Returns the values at a path in these frames, one of each variant, and `None` if the field is optional.
fn values(path: &str, frames: impl Iterator<Item = FrameSettings>) -> Alternatives {
    let mut found: Vec<Node> = Vec::new();
    for whole in frames.filter_map(|frame| tree(&frame).ok()) {
        let Some(value) = whole.at(path) else { continue };
        if found.is_empty() {
            let (mut without, none) = (whole.clone(), Node::Word("None".into()));
            if without.at_mut(path).is_some_and(|place| std::mem::replace(place, none.clone()) != none)
                && settings(&without).is_ok()
            {
                found.push(none);
            }
        }
        if !found.iter().any(|other| other.variant() == value.variant()) {
            found.push(value.clone());
        }
    }
    found.iter().map(Node::to_string).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lists the paths of all scalars and variants below a value.
    fn leaves(node: &Node, path: &str, found: &mut Vec<(String, bool)>) {
        let is_name = |word: &str| word.starts_with(|c: char| c.is_ascii_uppercase());
        let is_variant = node.variant().is_some_and(is_name);
        if is_variant || node.children().is_empty() {
            found.push((path.to_owned(), is_variant));
        }
        for (name, child) in node.children() {
            let path = if path.is_empty() { name } else { format!("{path}.{name}") };
            leaves(child, &path, found);
        }
    }

    /// Every field of the file has a row in a table, and every variant can be chosen.
    #[test]
    fn every_field_of_the_file_is_declared() {
        let rows: Vec<_> = sections().iter().flat_map(|section| &section.rows).collect();
        let declared = |path: &str| {
            let below = |own: &str| path.strip_prefix(own).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
            rows.iter().any(|row| !row.path.is_empty() && below(&row.path))
                || sections().iter().any(|section| section.path == path)
        };
        let mut tried = 0;
        for row in &rows {
            let mut found = Vec::new();
            leaves(&tree(&row.frame).expect("a tree"), "", &mut found);
            for (path, is_variant) in found {
                assert!(declared(&path), "{path} has no row in a table");
                assert!(!is_variant || alternatives(&path).is_some(), "{path} has no alternatives");
                tried += 1;
            }
        }
        assert!(tried > 10_000, "{tried}");
    }

    #[test]
    fn every_alternative_is_a_value_that_the_file_takes() {
        let mut tried = 0;
        for section in sections() {
            for row in &section.rows {
                for text in alternatives(&row.path).unwrap_or_default() {
                    let mut whole = tree(&row.frame).expect("a tree");
                    let value = super::super::parse(&text).expect("a value");
                    *whole.at_mut(&row.path).expect("the field") = value.clone();
                    let read = settings(&whole).unwrap_or_else(|error| panic!("{}: {text}: {error}", row.path));
                    let again = tree(&read).expect("a tree");
                    assert_eq!(again.at(&row.path).and_then(Node::variant), value.variant(), "{}", row.path);
                    tried += 1;
                }
            }
        }
        assert!(tried > 80, "{tried}");
        let of = |path: &str| alternatives(path).unwrap_or_default();
        assert_eq!(of("settings.shadows.filter"), ["Pcf", "Dpcf", "Pcss", "Vsm", "Evsm"]);
        assert_eq!(of("settings.bloom")[0], "None");
        assert_eq!(of("settings.transparency").len(), 5);
        assert_eq!(alternatives("settings.occlusion.radius_m"), None);
    }
}
