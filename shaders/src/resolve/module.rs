//! One file: its imports and declarations.

use std::collections::BTreeMap;
use std::ops::Range;

use super::code::Code;
use super::condition::{IsOn, translate};
use super::fault::Fault;

/// File after conditional translation.
#[derive(Debug)]
pub(super) struct Module<'a> {
    pub code: Code<'a>,
    /// The directives `enable`, `requires` and `diagnostic`.
    pub directives: Vec<Range<usize>>,
    /// Imported items by name.
    pub imports: BTreeMap<&'a str, Import>,
    /// Declarations in the order of the text.
    pub declarations: Vec<Declaration<'a>>,
    /// Indices of declarations by name.
    pub named: BTreeMap<&'a str, usize>,
}

/// Origin of an imported name.
#[derive(Debug)]
pub(super) struct Import {
    /// Path of the file, such as `lib/ggx.wgsl`.
    pub path: String,
    /// Line of the name in the import statement.
    pub line: usize,
}

/// Declaration at module scope.
#[derive(Debug)]
pub(super) struct Declaration<'a> {
    /// Name; `None` for an assertion.
    pub name: Option<&'a str>,
    /// Range of its tokens.
    pub tokens: Range<usize>,
    /// True if it is the entry point of a stage.
    pub is_entry_point: bool,
}

/// The `@group` and `@binding` of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Binding {
    pub group: u32,
    pub number: u32,
    /// Index of the token of `number`.
    pub token: usize,
}

impl<'a> Module<'a> {
    /// Reads a file.
    ///
    /// # Errors
    ///
    /// If conditions are invalid, an import cannot be read, or a name is declared twice.
    pub fn read(code: &Code<'a>, features: &IsOn<'_>) -> Result<Self, Fault> {
        let code = translate(code, features)?;
        let (mut directives, mut declarations) = (Vec::new(), Vec::new());
        let (mut imports, mut named) = (BTreeMap::<&str, Import>::new(), BTreeMap::<&str, usize>::new());
        let mut start = 0;
        while start < code.tokens.len() {
            let end = code.statement_end(start, code.tokens.len());
            match code.word(start) {
                "import" => {
                    for (name, import) in read_import(&code, start, end)? {
                        let other = imports.get(name).filter(|before| before.path != import.path);
                        if let Some(Import { path, .. }) = other {
                            let message = format!("`{name}` is also imported from `{path}`");
                            return Err(Fault::new(import.line, message));
                        }
                        imports.insert(name, import);
                    }
                }
                "enable" | "requires" | "diagnostic" => directives.push(start..end),
                ";" => {}
                _ => {
                    if let Some(at) = (start..end).find(|at| code.word(*at) == "package" && code.is(at + 1, ':')) {
                        return Err(Fault::new(code.line(at), "a path stands in an `import`, and its last name here"));
                    }
                    let declaration = Declaration::read(&code, start..end);
                    let before = declaration.name.and_then(|name| named.insert(name, declarations.len()));
                    if before.is_some() {
                        let name = declaration.name.unwrap_or_default();
                        return Err(Fault::new(code.line(start), format!("`{name}` is declared twice in this file")));
                    }
                    declarations.push(declaration);
                }
            }
            start = end;
        }
        if let Some((name, import)) = imports.iter().find(|(name, _)| named.contains_key(*name)) {
            return Err(Fault::new(import.line, format!("`{name}` is imported and declared in this file")));
        }
        Ok(Self { code, directives, imports, declarations, named })
    }

    /// Returns the names at module scope that a declaration may refer to.
    ///
    /// Attributes, accesses to members, and the names of members, parameters and variables are left out. A local
    /// variable that shares its name with a declaration counts as a reference. The linker may thus keep too many
    /// declarations, but never too few.
    pub fn references(&self, declaration: &Declaration<'a>) -> impl Iterator<Item = &'a str> {
        let code = &self.code;
        let keyword = code.after_attributes(declaration.tokens.start);
        // The brackets of a struct or a parameter list contain `name: type`.
        let members = match code.word(keyword) {
            "struct" | "fn" => keyword + 2..code.close(keyword + 2),
            _ => 0..0,
        };
        declaration.tokens.clone().filter_map(move |at| {
            let before = at.checked_sub(1).map_or("", |before| code.word(before));
            let is_declared = matches!(before, "let" | "var" | "const" | "fn" | "struct" | "override" | "alias")
                || members.contains(&at) && code.is(at + 1, ':');
            let is_reference = code.is_word(at) && !is_declared && !matches!(before, "." | "@");
            is_reference.then(|| code.word(at))
        })
    }

    /// Returns the binding of a variable if both numbers are literals.
    pub fn binding(&self, declaration: &Declaration<'a>) -> Option<Binding> {
        let code = &self.code;
        let attributes = declaration.tokens.start..code.after_attributes(declaration.tokens.start);
        let number = |name: &str| {
            let at = attributes.clone().find(|at| code.is(*at, '@') && code.word(at + 1) == name)? + 3;
            code.word(at).trim_end_matches(['u', 'i']).parse().ok().map(|number: u32| (number, at))
        };
        let ((group, _), (number, token)) = (number("group")?, number("binding")?);
        Some(Binding { group, number, token })
    }
}

impl<'a> Declaration<'a> {
    fn read(code: &Code<'a>, tokens: Range<usize>) -> Self {
        let keyword = code.after_attributes(tokens.start);
        let mut at = keyword + 1;
        if code.word(keyword) == "var" && code.is(at, '<') {
            at = (at..tokens.end).find(|at| code.is(*at, '>')).map_or(at, |end| end + 1);
        }
        let named = matches!(code.word(keyword), "fn" | "struct" | "const" | "override" | "alias" | "var");
        let stages = ["vertex", "fragment", "compute"];
        let is_entry_point = (tokens.start..keyword).any(|at| code.is(at, '@') && stages.contains(&code.word(at + 1)));
        Self { name: (named && code.is_word(at)).then(|| code.word(at)), tokens, is_entry_point }
    }
}

/// Reads the names that `import package::folder::file::name;` or `…::{name, name};` imports.
fn read_import<'a>(code: &Code<'a>, start: usize, end: usize) -> Result<Vec<(&'a str, Import)>, Fault> {
    let mut path = Vec::new();
    let mut at = start + 1;
    while code.is_word(at) && code.is(at + 1, ':') && code.is(at + 2, ':') {
        path.push(code.word(at));
        at += 3;
    }
    let wrong = |at: usize| Fault::new(code.line(at), "an import reads `import package::folder::file::{a, b};`");
    let names = if code.is(at, '{') { at + 1..code.close(at) } else { at..at + 1 };
    let after = if code.is(at, '{') { code.close(at) + 1 } else { at + 1 };
    let complete = path.len() > 1 && path[0] == "package" && code.is(after, ';') && after + 1 == end;
    if !complete {
        return Err(wrong(start));
    }
    let file = format!("{}.wgsl", path[1..].join("/"));
    let mut list = Vec::new();
    for at in names.clone() {
        let is_name = (at - names.start).is_multiple_of(2);
        if is_name && code.is_word(at) {
            list.push((code.word(at), Import { path: file.clone(), line: code.line(at) }));
        } else if is_name || !code.is(at, ',') {
            return Err(wrong(at));
        }
    }
    Ok(list)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Module<'_>, Fault> {
        Module::read(&Code::new(text)?, &|_| None)
    }

    #[test]
    fn a_file_is_read_into_its_parts() {
        let text = "enable f16;\nimport package::a::b::{c,\n d,};\nimport package::e::f;\n\
                    @group(0) @binding(1) var<storage, read> g: array<c>;\nconst_assert d > 1;\n\
                    @compute @workgroup_size(N) fn h(x: c) { let y = x.z + f(g[0]); }\nalias i = vec2<f16>;";
        let module = read(text).unwrap();
        assert_eq!(module.directives.first(), Some(&(0..3)));
        let imports: Vec<_> = module.imports.iter().map(|(name, i)| (*name, i.path.as_str(), i.line)).collect();
        assert_eq!(imports, [("c", "a/b.wgsl", 2), ("d", "a/b.wgsl", 3), ("f", "e.wgsl", 4)]);
        let names: Vec<_> = module.declarations.iter().map(|d| (d.name, d.is_entry_point)).collect();
        assert_eq!(names, [(Some("g"), false), (None, false), (Some("h"), true), (Some("i"), false)]);
        let references = |index: usize| module.references(&module.declarations[index]).collect::<Vec<_>>();
        assert!(references(0).contains(&"c") && !references(0).contains(&"binding"));
        let bound = |index: usize| module.binding(&module.declarations[index]).map(|b| (b.group, b.number));
        assert_eq!((bound(0), bound(2)), (Some((0, 1)), None));
        let h = references(2);
        assert!(["N", "c", "f", "g"].iter().all(|name| h.contains(name)), "{h:?}");
        assert!(!h.contains(&"z") && !h.contains(&"y") && !h.contains(&"compute"), "{h:?}");
    }

    #[test]
    fn imports_and_names_that_are_wrong_are_told() {
        for (text, line, part) in [
            ("\nimport lib::a::b;", 2, "an import reads"),
            ("import package::b;", 1, "an import reads"),
            ("import package::a::b as c;", 1, "an import reads"),
            ("import package::a::{b\n c};", 2, "an import reads"),
            ("import package::a::{b,\n 1};", 2, "an import reads"),
            ("import package::a::b;\nimport package::c::b;", 2, "also imported"),
            ("fn a() {\n let b = package::c::d(); }", 2, "a path stands in an `import`"),
            ("const a = 1;\nfn a() {}", 2, "declared twice"),
            ("import package::a::b;\nfn b() {}", 1, "imported and declared"),
        ] {
            let fault = read(text).unwrap_err();
            assert!(fault.line == line && fault.message.contains(part), "{text}: {fault:?}");
        }
    }
}
