//! From a place in the resolved text back to the file and line the author wrote.
//!
//! The resolver prints its syntax tree anew, so lines move. Declarations know their place in
//! the source, and so do statements: both are printed one after the other in source order,
//! so matching first lines in order recovers a table of (printed line, source line).

use wesl::syntax::{CompoundStatement, GlobalDeclaration, GlobalDeclarationNode, Statement, StatementNode};
use wesl::{Diagnostic, Error};

use crate::ShaderError;

/// Where the lines of a resolved text came from.
pub(crate) struct Origins {
    /// Named when an error has no place at all.
    root_file: String,
    /// Ascending in `offset`.
    entries: Vec<Entry>,
}

struct Entry {
    /// First byte of the resolved text this entry speaks for.
    offset: usize,
    file: String,
    line: usize,
}

impl Origins {
    pub(crate) fn new(root_file: &str) -> Self {
        Self { root_file: root_file.to_owned(), entries: Vec::new() }
    }

    /// Prints a declaration after `wgsl`, under a comment with its origin, and remembers it.
    pub(crate) fn append(&mut self, wgsl: &mut String, declaration: &GlobalDeclarationNode, file: &str, source: &str) {
        if matches!(declaration.node(), GlobalDeclaration::Void) {
            return;
        }
        let first_line = line_of(source, declaration.span().start);
        if !wgsl.is_empty() {
            wgsl.push('\n');
        }
        wgsl.push_str(&format!("// {file}:{first_line}\n"));
        let start = wgsl.len();
        let printed = declaration.to_string();
        wgsl.push_str(&printed);
        wgsl.push('\n');

        let entry = |offset, line| Entry { offset: start + offset, file: file.to_owned(), line };
        self.entries.push(entry(0, first_line));
        if let GlobalDeclaration::Function(function) = declaration.node() {
            let mut statements = Vec::new();
            flatten(&function.body, &mut statements);
            for (offset, span_start) in match_lines(&printed, &statements) {
                self.entries.push(entry(offset, line_of(source, span_start)));
            }
        }
    }

    /// File and line of a byte offset, or of the root file's first line without one.
    pub(crate) fn locate(&self, offset: Option<usize>) -> (String, usize) {
        let at = offset.map(|o| self.entries.partition_point(|entry| entry.offset <= o));
        match at {
            Some(after @ 1..) => {
                let entry = &self.entries[after - 1];
                (entry.file.clone(), entry.line)
            }
            _ => (self.root_file.clone(), 1),
        }
    }
}

/// Name of a declaration; an assertion has none.
pub(crate) fn name_of(declaration: &GlobalDeclarationNode) -> Option<String> {
    match declaration.node() {
        GlobalDeclaration::Declaration(variable) => Some(variable.ident.to_string()),
        GlobalDeclaration::TypeAlias(alias) => Some(alias.ident.to_string()),
        GlobalDeclaration::Struct(structure) => Some(structure.ident.to_string()),
        GlobalDeclaration::Function(function) => Some(function.ident.to_string()),
        GlobalDeclaration::Void | GlobalDeclaration::ConstAssert(_) => None,
    }
}

/// Line, from one, of a byte offset into a text.
fn line_of(text: &str, offset: usize) -> usize {
    let before = &text.as_bytes()[..offset.min(text.len())];
    1 + before.iter().filter(|byte| **byte == b'\n').count()
}

/// All statements of a body and of the bodies in it, in printing order.
fn flatten<'a>(body: &'a CompoundStatement, out: &mut Vec<&'a StatementNode>) {
    for statement in &body.statements {
        out.push(statement);
        match statement.node() {
            Statement::Compound(inner) => flatten(inner, out),
            Statement::If(branch) => {
                flatten(&branch.if_clause.body, out);
                for clause in &branch.else_if_clauses {
                    flatten(&clause.body, out);
                }
                if let Some(clause) = &branch.else_clause {
                    flatten(&clause.body, out);
                }
            }
            Statement::Switch(switch) => {
                for clause in &switch.clauses {
                    flatten(&clause.body, out);
                }
            }
            Statement::Loop(inner) => {
                flatten(&inner.body, out);
                if let Some(continuing) = &inner.continuing {
                    flatten(&continuing.body, out);
                }
            }
            Statement::For(inner) => flatten(&inner.body, out),
            Statement::While(inner) => flatten(&inner.body, out),
            _ => {}
        }
    }
}

/// (offset into `printed`, offset into the source) of each statement whose first printed line
/// is found, searching forward only.
fn match_lines(printed: &str, statements: &[&StatementNode]) -> Vec<(usize, usize)> {
    let mut lines = Vec::new();
    let mut offset = 0;
    for line in printed.split_inclusive('\n') {
        lines.push((offset, line.trim()));
        offset += line.len();
    }
    let mut cursor = 0;
    let mut found = Vec::new();
    for statement in statements {
        let text = statement.to_string();
        let first = text.lines().next().unwrap_or_default().trim();
        let ahead = lines[cursor..].iter().position(|(_, line)| line.starts_with(first));
        if let Some(ahead) = ahead.filter(|_| !first.is_empty()) {
            found.push((lines[cursor + ahead].0, statement.span().start));
            cursor += ahead + 1;
        }
    }
    found
}

/// The resolver's own errors, with file and line where it knows them.
pub(crate) fn link_error(error: Error, root_file: &str) -> ShaderError {
    let diagnostic: Diagnostic<Error> = error.into();
    let detail = &diagnostic.detail;
    let file = detail.display_name.clone().unwrap_or_else(|| root_file.to_owned());
    let message = without_span_prefix(&diagnostic.error.to_string());
    match (&detail.span, &detail.source) {
        (Some(span), Some(source)) => ShaderError::Source { file, line: line_of(source, span.start), message },
        _ => ShaderError::Import { file, message },
    }
}

/// Parse errors begin with `chars 12..15: `, which the line replaces.
fn without_span_prefix(message: &str) -> String {
    let rest = message.strip_prefix("chars ").and_then(|tail| tail.split_once(": "));
    rest.map_or(message, |(_, rest)| rest).to_owned()
}
