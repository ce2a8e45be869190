//! Linking: combines a file with its imports into one text of the declarations that its entry points reach.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use super::code::Code;
use super::condition::IsOn;
use super::fault::Fault;
use super::module::{Declaration, Module};
use crate::ShaderError;
use crate::effect::FOLDER;

/// Loads the tokens of a file by its path; returns `None` for a missing file.
pub(super) type Load<'a, 'b> = dyn Fn(&str) -> Result<Option<Cow<'a, Code<'a>>>, Fault> + 'b;

/// Linked text, with the origin of each line.
pub(super) struct Linked {
    pub wgsl: String,
    /// Paths of all files that were read.
    pub files: Vec<String>,
    /// (index of the file, line) for each line of `wgsl`, starting at 0.
    origins: Vec<(usize, usize)>,
}

impl Linked {
    /// Returns the file and line of a byte in the text.
    pub fn origin(&self, byte: usize) -> (&str, usize) {
        let before = &self.wgsl.as_bytes()[..byte.min(self.wgsl.len())];
        let line = before.iter().filter(|byte| **byte == b'\n').count();
        let found = self.origins.get(line).or(self.origins.last());
        found.map_or((&self.files[0], 1), |(file, line)| (&self.files[*file], *line))
    }

    /// Returns the file and line of every line of the text.
    #[cfg(feature = "replaced")]
    pub fn lines(&self) -> impl Iterator<Item = (&str, usize)> {
        self.origins.iter().map(|(file, line)| (self.files[*file].as_str(), *line))
    }

    /// Writes tokens as they appear in their file, without comments and empty lines, and substitutes `numbers`.
    fn print(&mut self, file: usize, module: &Module<'_>, tokens: Range<usize>, numbers: &Numbers) {
        let code = &module.code;
        for at in tokens.clone() {
            let token = code.tokens[at];
            let before = at.checked_sub(1).filter(|before| *before >= tokens.start).map(|before| code.tokens[before]);
            match before {
                Some(before) if before.line == token.line => {
                    let gap = &code.text[before.end..token.start];
                    self.wgsl += if gap.chars().all(char::is_whitespace) { gap } else { " " };
                }
                _ => {
                    if before.is_some() {
                        self.wgsl.push('\n');
                    }
                    let line = &code.text[code.text[..token.start].rfind('\n').map_or(0, |end| end + 1)..token.start];
                    self.wgsl += &line[..line.len() - line.trim_start().len()];
                    self.origins.push((file, token.line));
                }
            }
            match numbers.get(&(file, at)) {
                Some(number) => self.wgsl += &number.to_string(),
                None => self.wgsl += code.word(at),
            }
        }
        self.wgsl.push('\n');
    }
}

/// Replacement numbers by file and token.
type Numbers = BTreeMap<(usize, usize), u32>;

/// Files that were read. The first is the root.
struct Modules<'a> {
    list: Vec<(String, Module<'a>)>,
    by_path: BTreeMap<String, usize>,
}

/// Links the file `root` with its imports.
///
/// # Errors
///
/// With file and line if a text cannot be read, an import names a missing item, or two files declare the same name.
pub(super) fn link<'a>(
    file: &str,
    root: &Code<'a>,
    load: &Load<'a, '_>,
    features: &IsOn<'_>,
) -> Result<Linked, ShaderError> {
    let modules = Modules::read(file, root, load, features)?;
    let reached = modules.reached();
    modules.refuse_doubles(&reached)?;

    // The root comes first, then files by path; declarations keep the order of their file.
    let mut order: Vec<usize> = (0..modules.list.len()).collect();
    order.sort_by_key(|index| (*index != 0, &modules.list[*index].0));
    let files = modules.list.iter().map(|(file, _)| file.clone()).collect();
    let mut linked = Linked { wgsl: String::new(), files, origins: Vec::new() };
    let uses = |index: usize| index == 0 || reached.range((index, 0)..(index + 1, 0)).next().is_some();
    let mut written = BTreeSet::new();
    for &index in order.iter().filter(|index| uses(**index)) {
        let module = &modules.list[index].1;
        for tokens in &module.directives {
            let words: Vec<&str> = tokens.clone().map(|at| module.code.word(at)).collect();
            if written.insert(words) {
                linked.print(index, module, tokens.clone(), &Numbers::new());
            }
        }
    }
    let numbers = modules.effect_bindings(&order, &reached);
    for index in order {
        let (file, module) = &modules.list[index];
        for &(_, declaration) in reached.range((index, 0)..(index + 1, 0)) {
            let tokens = module.declarations[declaration].tokens.clone();
            let line = module.code.line(tokens.start);
            if !linked.wgsl.is_empty() {
                linked.wgsl.push('\n');
                linked.origins.push((index, line));
            }
            linked.wgsl += &format!("// {file}:{line}\n");
            linked.origins.push((index, line));
            linked.print(index, module, tokens, &numbers);
        }
    }
    Ok(linked)
}

impl<'a> Modules<'a> {
    /// Reads the root and all its direct and indirect imports. Files may import each other.
    fn read(file: &str, root: &Code<'a>, load: &Load<'a, '_>, features: &IsOn<'_>) -> Result<Self, ShaderError> {
        let root = Module::read(root, features).map_err(|fault| fault.at(file))?;
        let mut modules = Self { list: vec![(file.to_owned(), root)], by_path: BTreeMap::new() };
        let mut next = 0;
        while next < modules.list.len() {
            let (file, module) = &modules.list[next];
            let mut found = Vec::new();
            for import in module.imports.values() {
                if modules.by_path.contains_key(&import.path) || found.iter().any(|(path, _)| *path == import.path) {
                    continue;
                }
                let missing = || Fault::new(import.line, format!("there is no file `{}` to import", import.path));
                let code =
                    load(&import.path).map_err(|fault| fault.at(&import.path))?.ok_or_else(|| missing().at(file))?;
                let imported = Module::read(&code, features).map_err(|fault| fault.at(&import.path))?;
                found.push((import.path.clone(), imported));
            }
            for (path, module) in found {
                modules.by_path.insert(path.clone(), modules.list.len());
                modules.list.push((path, module));
            }
            next += 1;
        }
        for (file, module) in &modules.list {
            for (name, import) in &module.imports {
                if !modules.list[modules.by_path[&import.path]].1.named.contains_key(name) {
                    let message = format!("`{}` declares no `{name}` with the features of this shader", import.path);
                    return Err(Fault::new(import.line, message).at(file));
                }
            }
        }
        Ok(modules)
    }

    /// Returns the declarations that the root's entry points reach, as (file, declaration). Assertions are included for
    /// every file with a reached declaration.
    fn reached(&self) -> BTreeSet<(usize, usize)> {
        let mut reached = BTreeSet::new();
        let mut visited = BTreeSet::from([0]);
        let of_file = |index: usize, wanted: fn(&Declaration<'_>) -> bool| {
            let declarations = self.list[index].1.declarations.iter().enumerate();
            declarations.filter(move |(_, d)| wanted(d)).map(move |(at, _)| (index, at))
        };
        let mut open: Vec<(usize, usize)> = of_file(0, |d| d.is_entry_point || d.name.is_none()).collect();
        while let Some((index, at)) = open.pop() {
            if !reached.insert((index, at)) {
                continue;
            }
            if visited.insert(index) {
                open.extend(of_file(index, |d| d.name.is_none()));
            }
            let module = &self.list[index].1;
            for name in module.references(&module.declarations[at]) {
                if let Some(own) = module.named.get(name) {
                    open.push((index, *own));
                } else if let Some(import) = module.imports.get(name) {
                    let other = self.by_path[&import.path];
                    open.push((other, self.list[other].1.named[name]));
                }
            }
        }
        reached
    }

    /// Returns binding numbers for effects, whose own numbers begin at 0. They follow all other numbers of group 0.
    fn effect_bindings(&self, order: &[usize], reached: &BTreeSet<(usize, usize)>) -> Numbers {
        let bindings = |index: usize| {
            let module = &self.list[index].1;
            let declarations = reached.range((index, 0)..(index + 1, 0)).map(|(_, at)| &module.declarations[*at]);
            declarations.filter_map(|declaration| module.binding(declaration)).filter(|binding| binding.group == 0)
        };
        let is_effect = |index: &usize| *index != 0 && self.list[*index].0.starts_with(FOLDER);
        let (effects, others): (Vec<usize>, Vec<usize>) = order.iter().partition(|index| is_effect(index));
        let first = others.into_iter().flat_map(bindings).map(|binding| binding.number + 1).max().unwrap_or(0);
        let places = effects.into_iter().flat_map(|index| bindings(index).map(move |b| (index, b.token)));
        places.zip(first..).collect()
    }

    /// Fails if two files declare the same name, because names are kept as written. The error points at the root if the
    /// root is one of them.
    fn refuse_doubles(&self, reached: &BTreeSet<(usize, usize)>) -> Result<(), ShaderError> {
        let mut owners: BTreeMap<&str, usize> = BTreeMap::new();
        for &(index, at) in reached.iter().rev() {
            let (file, module) = &self.list[index];
            let declaration = &module.declarations[at];
            let Some(name) = declaration.name else { continue };
            if let Some(other) = owners.insert(name, index) {
                let message = format!("`{name}` is also declared in `{}`; rename one of them", self.list[other].0);
                return Err(Fault::new(module.code.line(declaration.tokens.start), message).at(file));
            }
        }
        Ok(())
    }
}
