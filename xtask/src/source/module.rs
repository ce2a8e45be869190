//! Modules of a crate as its files declare them: definitions, imports and names.

use super::product::Product;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// One module.
#[derive(Debug)]
pub struct Module {
    /// File of the module: index into [`Crate::files`].
    pub file: usize,
    /// Enclosing module: index into [`Crate::modules`]; the root is its own parent.
    pub parent: usize,
    /// Child modules by name: indices into [`Crate::modules`].
    pub children: BTreeMap<String, usize>,
    /// Items that the module defines.
    pub defines: BTreeSet<String>,
    /// Imports, one for each name of a `use` declaration.
    pub imports: Vec<Import>,
    /// Paths and single names in the code, outside of `use`.
    pub names: BTreeSet<Vec<String>>,
}

/// One name of a `use` declaration.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Import {
    /// Imported name; `*` for all names of the path.
    pub name: String,
    /// Imported path.
    pub path: Vec<String>,
    /// True for a re-export.
    pub public: bool,
}

/// One crate: a library or a program.
#[derive(Debug)]
pub struct Crate {
    /// Product files, relative to the crate's folder; the root comes first.
    pub files: Vec<PathBuf>,
    /// Lines of each file without tests.
    pub lines: Vec<usize>,
    /// Product modules; the root comes first.
    pub modules: Vec<Module>,
}

impl Crate {
    /// Reads a crate from its root file, relative to `folder`.
    ///
    /// # Errors
    /// A file that cannot be read, or a module without a file.
    pub fn read(folder: &Path, root: &Path) -> Result<Self, String> {
        let mut found = Self { files: Vec::new(), lines: Vec::new(), modules: Vec::new() };
        let inside = root.parent().unwrap_or(Path::new("")).to_owned();
        found.add_file(folder, root, &inside, 0)?;
        Ok(found)
    }

    /// Reads `file`, whose child modules are in the folder `inside`. Returns the index of its module.
    fn add_file(&mut self, folder: &Path, file: &Path, inside: &Path, parent: usize) -> Result<usize, String> {
        let path = folder.join(file);
        let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let Product { code, lines } = Product::of(&text);
        self.files.push(file.to_owned());
        self.lines.push(lines);
        let words = words(&code);
        self.add_module(folder, (self.files.len() - 1, inside), &words, &mut 0, parent)
    }

    /// Reads the tokens of a module up to its closing brace.
    fn add_module(
        &mut self,
        folder: &Path,
        (file, inside): (usize, &Path),
        words: &[&str],
        at: &mut usize,
        parent: usize,
    ) -> Result<usize, String> {
        let own = self.modules.len();
        self.modules.push(Module {
            file,
            parent,
            children: BTreeMap::new(),
            defines: BTreeSet::new(),
            imports: Vec::new(),
            names: BTreeSet::new(),
        });
        let mut depth = 0_usize;
        while let Some(word) = words.get(*at) {
            *at += 1;
            let next = words.get(*at).copied().unwrap_or_default();
            let after = words.get(*at + 1).copied().unwrap_or_default();
            match *word {
                "}" if depth == 0 => break,
                "{" => depth += 1,
                "}" => depth -= 1,
                "mod" if after == "{" => {
                    *at += 2;
                    let child = self.add_module(folder, (file, &inside.join(next)), words, at, own)?;
                    self.modules[own].children.insert(next.to_owned(), child);
                }
                "mod" if after == ";" => {
                    *at += 2;
                    let flat = inside.join(format!("{next}.rs"));
                    let nested = inside.join(next).join("mod.rs");
                    let child_file = if folder.join(&flat).is_file() { flat } else { nested };
                    let child = self.add_file(folder, &child_file, &inside.join(next), own)?;
                    self.modules[own].children.insert(next.to_owned(), child);
                }
                "use" => {
                    let public = is_public(&words[..*at - 1]);
                    import(words, at, &[], public, &mut self.modules[own].imports);
                }
                "fn" | "struct" | "enum" | "trait" | "type" | "const" | "static" | "union"
                    if depth == 0 && is_name(next) =>
                {
                    self.modules[own].defines.insert(next.to_owned());
                }
                "macro_rules" if depth == 0 => {
                    self.modules[own].defines.insert(after.to_owned());
                }
                name if is_name(name) && words[..*at - 1].last() != Some(&".") => {
                    let mut path = vec![name.to_owned()];
                    while words.get(*at) == Some(&"::") && words.get(*at + 1).is_some_and(|word| is_name(word)) {
                        path.push(words[*at + 1].to_owned());
                        *at += 2;
                    }
                    self.modules[own].names.insert(path);
                }
                _ => {}
            }
        }
        Ok(own)
    }
}

/// Returns true if the tokens before an item end with `pub`, `pub(crate)` or similar.
fn is_public(before: &[&str]) -> bool {
    match before {
        [.., "pub"] => true,
        [.., ")"] => before.iter().rev().take(8).any(|word| *word == "pub"),
        _ => false,
    }
}

/// Reads one tree of a `use` declaration after `prefix`.
fn import(words: &[&str], at: &mut usize, prefix: &[String], public: bool, found: &mut Vec<Import>) {
    let mut path = prefix.to_vec();
    while let Some(word) = words.get(*at) {
        *at += 1;
        match *word {
            "{" => {
                while words.get(*at).is_some_and(|word| *word != "}") {
                    import(words, at, &path, public, found);
                    if words.get(*at) == Some(&",") {
                        *at += 1;
                    }
                }
                *at += 1;
                return;
            }
            "*" => return found.push(Import { name: "*".to_owned(), path, public }),
            "as" => {
                let name = words.get(*at).copied().unwrap_or_default().to_owned();
                *at += 1;
                return found.push(Import { name, path, public });
            }
            "::" => {}
            ";" | "," | "}" => {
                *at -= usize::from(*word != ";");
                break;
            }
            // `use a::{self, b}` names `a` itself.
            "self" if !path.is_empty() && path.last().is_some_and(|last| last != "super") => {}
            name => path.push(name.to_owned()),
        }
    }
    if let Some(name) = path.last().cloned() {
        found.push(Import { name, path, public });
    }
}

fn is_name(word: &str) -> bool {
    word.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Splits code into names, `::` and single signs. Lifetimes are dropped.
fn words(code: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut rest = code.trim_start();
    while let Some(first) = rest.chars().next() {
        let lifetime = first == '\'';
        let length = if first.is_alphanumeric() || first == '_' || lifetime {
            let tail = &rest[usize::from(lifetime)..];
            usize::from(lifetime) + tail.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(tail.len())
        } else if rest.starts_with("::") {
            2
        } else {
            first.len_utf8()
        };
        if !lifetime {
            found.push(&rest[..length]);
        }
        rest = rest[length..].trim_start();
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::Tree;

    #[test]
    fn modules_are_followed_from_file_to_file() {
        let tree = Tree::new(&[
            (
                "src/lib.rs",
                "mod a; pub(crate) use a::{b::{self, C as D}, *}; mod inline { pub fn f() { super::g() } } fn g() {}",
            ),
            ("src/a.rs", "pub mod b; #[cfg(test)] mod tests;"),
            (
                "src/a/b.rs",
                "use super::super::g; pub struct C; impl C { fn method(&self) { g(); self.other::<u8>(); } }",
            ),
        ]);
        let found = Crate::read(tree.root(), Path::new("src/lib.rs")).expect("a crate");
        assert_eq!(found.files, ["src/lib.rs", "src/a.rs", "src/a/b.rs"].map(PathBuf::from));
        let [root, a, b, inline] = &found.modules[..] else { panic!("four modules: {found:?}") };
        assert_eq!((root.children["a"], a.children["b"], root.children["inline"]), (1, 2, 3));
        assert_eq!((b.parent, inline.parent, inline.file), (1, 0, 0));
        let told: Vec<String> = root.imports.iter().map(|i| format!("{} = {}", i.name, i.path.join("::"))).collect();
        assert_eq!(told, ["b = a::b", "D = a::b::C", "* = a"]);
        assert!(root.imports.iter().all(|import| import.public) && !b.imports[0].public);
        assert_eq!(b.imports[0].path, ["super", "super", "g"]);
        assert!(b.defines.contains("C") && !b.defines.contains("method"));
        assert!(inline.names.contains(&vec!["super".to_owned(), "g".to_owned()]));
        assert!(!b.names.contains(&vec!["other".to_owned()]), "methods are no names of modules");
    }

    #[test]
    fn a_module_without_a_file_is_named() {
        let tree = Tree::new(&[("src/lib.rs", "mod gone;")]);
        let told = Crate::read(tree.root(), Path::new("src/lib.rs")).expect_err("no such file");
        assert!(told.contains("gone"), "{told}");
    }
}
