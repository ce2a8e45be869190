//! Uses between the files of a crate.

use super::module::{Crate, Import, Module};
use std::collections::{BTreeMap, BTreeSet};

/// Names used, for each pair of a using and a used file (indices into [`Crate::files`]).
pub type Uses = BTreeMap<(usize, usize), BTreeSet<String>>;

/// Maximum number of re-exports to follow before a name counts as external.
const DEEPEST: usize = 16;

/// Returns the uses between files, found by paths and imported names in the code.
///
/// - A declaration (`mod a;`) or a re-export (`pub use a::B;`) counts as a use only if the same module also names `B`.
/// - A name counts as a use of the file that defines it and of every file that re-exports it on the way.
/// - A private `use` of an item counts as a use. A `use` of a module does not; the paths through it do.
pub fn uses(of: &Crate) -> Uses {
    let mut found = Uses::new();
    for (own, module) in of.modules.iter().enumerate() {
        let mut add = |path: &[String]| {
            let Some(Place::Item(files, name)) = resolve(of, (own, own), path, 0) else { return };
            for used in files.into_iter().filter(|used| *used != module.file) {
                found.entry((module.file, used)).or_default().insert(name.clone());
            }
        };
        for path in &module.names {
            if first_is_local(module, &path[0]) || imported_by_glob(of, own, &path[0]) {
                add(path);
            }
        }
        for Import { name, path, public } in &module.imports {
            if !public && name != "*" {
                add(path);
            }
        }
    }
    found
}

/// Target of a path.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Place {
    /// A module: index into [`Crate::modules`].
    Module(usize),
    /// An item by name, with the files that lead to it: the defining file, then re-exporting files (indices into
    /// [`Crate::files`]).
    Item(Vec<usize>, String),
}

impl Place {
    /// Adds a file that re-exports the item.
    fn through(mut self, file: usize) -> Self {
        if let Self::Item(files, _) = &mut self {
            files.push(file);
        }
        self
    }
}

fn first_is_local(module: &Module, first: &str) -> bool {
    matches!(first, "crate" | "super" | "self")
        || module.children.contains_key(first)
        || module.imports.iter().any(|import| import.name == first)
}

fn imported_by_glob(of: &Crate, own: usize, name: &str) -> bool {
    through_globs(of, own, name, 0).is_some()
}

/// Resolves a path that occurs in the module `origin`, starting in the module `from`. Returns `None` if it leaves the
/// crate.
fn resolve(of: &Crate, (origin, from): (usize, usize), path: &[String], depth: usize) -> Option<Place> {
    let mut at = from;
    for (index, name) in path.iter().enumerate() {
        let module = &of.modules[at];
        match name.as_str() {
            "crate" if index == 0 => at = 0,
            "self" => {}
            "super" => at = module.parent,
            name => {
                // At the end of a path, an item takes precedence over a module with the same name.
                let item = index + 1 == path.len()
                    && (module.defines.contains(name) || module.imports.iter().any(|import| import.name == name));
                if let Some(child) = module.children.get(name).filter(|_| !item) {
                    at = *child;
                    continue;
                }
                let imported = (depth < DEEPEST).then(|| imported(of, at, name, depth)).flatten();
                let here = Place::Item(vec![module.file], name.to_owned());
                return match imported {
                    _ if module.defines.contains(name) => Some(here),
                    Some(Place::Module(next)) => resolve(of, (origin, next), &path[index + 1..], depth + 1),
                    Some(item) if at == origin => Some(item),
                    Some(item) => Some(item.through(module.file)),
                    // The name is introduced in a way that is not followed, such as a macro, or is the name of another
                    // crate.
                    None => (index > 0 && !module.imports.iter().any(|i| i.name == name)).then_some(here),
                };
            }
        }
    }
    Some(Place::Module(at))
}

fn imported(of: &Crate, at: usize, name: &str, depth: usize) -> Option<Place> {
    let module = &of.modules[at];
    let named = module.imports.iter().find(|import| import.name == name);
    named
        // A path that starts with the name it imports refers to another crate: `use wgpu;`.
        .filter(|import| import.path.first().is_some_and(|first| first != name || module.children.contains_key(first)))
        .and_then(|import| resolve(of, (at, at), &import.path, depth + 1))
        .or_else(|| through_globs(of, at, name, depth))
}

fn through_globs(of: &Crate, at: usize, name: &str, depth: usize) -> Option<Place> {
    if depth >= DEEPEST {
        return None;
    }
    let here = &of.modules[at];
    let globs = here.imports.iter().filter(|import| import.name == "*" && first_is_local(here, &import.path[0]));
    globs.into_iter().find_map(|glob| {
        let Some(Place::Module(inside)) = resolve(of, (at, at), &glob.path, depth + 1) else { return None };
        let module = &of.modules[inside];
        if let Some(child) = module.children.get(name) {
            Some(Place::Module(*child))
        } else if module.defines.contains(name) {
            Some(Place::Item(vec![module.file], name.to_owned()))
        } else {
            imported(of, inside, name, depth + 1).map(|place| place.through(module.file))
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::Tree;
    use std::path::Path;

    fn found(files: &[(&str, &str)]) -> Vec<String> {
        let tree = Tree::new(files);
        let read = Crate::read(tree.root(), Path::new("lib.rs")).expect("a crate");
        let file = |index: usize| read.files[index].display().to_string();
        uses(&read).keys().map(|(from, to)| format!("{} > {}", file(*from), file(*to))).collect()
    }

    #[test]
    fn declaring_and_re_exporting_is_no_use_but_naming_is() {
        let a = ("a.rs", "pub struct A;");
        assert!(found(&[("lib.rs", "mod a; pub use a::A;"), a]).is_empty());
        assert_eq!(found(&[("lib.rs", "mod a; pub use a::A; fn f(_: A) {}"), a]), ["lib.rs > a.rs"]);
        assert_eq!(found(&[("lib.rs", "mod a; fn f(_: a::A) {}"), a]), ["lib.rs > a.rs"]);
        assert_eq!(found(&[("lib.rs", "mod a; use a::A;"), a]), ["lib.rs > a.rs"]);
    }

    #[test]
    fn a_name_counts_for_the_file_that_defines_it_and_for_those_on_the_way() {
        let files = [("lib.rs", "mod a; mod b; pub use a::*;"), ("a.rs", "pub struct A;")];
        for b in ["use crate::a::A;", "use crate::a; fn f(_: a::A) {}", "use super::a::*; fn f(_: A) {}"] {
            assert_eq!(found(&[files[0], files[1], ("b.rs", b)]), ["b.rs > a.rs"], "{b}");
        }
        let folder = [("lib.rs", "mod a; mod b;"), ("a.rs", "pub mod c; pub use c::c;"), ("a/c.rs", "pub fn c() {}")];
        let b = ("b.rs", "use crate::a; fn f() { a::c() }");
        assert_eq!(found(&[folder[0], folder[1], folder[2], b]), ["b.rs > a.rs", "b.rs > a/c.rs"]);
        for b in ["use crate::A;", "use super::A;", "fn f(_: crate::A) {}", "use super::*; fn f(_: A) {}"] {
            assert_eq!(found(&[files[0], files[1], ("b.rs", b)]), ["b.rs > lib.rs", "b.rs > a.rs"], "{b}");
        }
        for b in ["use crate::a;", "use super::*;", "use std::fmt; fn f(_: fmt::Error, _: u8) {}"] {
            assert!(found(&[files[0], files[1], ("b.rs", b)]).is_empty(), "{b}");
        }
    }

    #[test]
    fn tests_do_not_count() {
        let lib = "mod a; #[cfg(test)] mod tests { use crate::a::A; }";
        assert!(found(&[("lib.rs", lib), ("a.rs", "pub struct A; #[cfg(test)] use super::gone;")]).is_empty());
    }
}
