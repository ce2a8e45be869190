//! From an embedded pass, or a source of one's own, to one plain WGSL text.
//!
//! The work is done by `wesl`: it follows `import` statements, evaluates `@if` attributes and
//! drops what no entry point reaches. Names are kept as written, since every name of the
//! library is unique (a test sees to it); so errors, captures and reflection show the
//! author's names. Each declaration of the result is preceded by a comment with the file and
//! line it came from.

use std::borrow::Cow;

use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use wesl::syntax::PathOrigin;
use wesl::{CompileOptions, CompileResult, ModulePath, NoMangler, ResolveError, Resolver, SourceMap};

use crate::effect::{self, Overlay};
use crate::origin::{self, Origins};
use crate::{Effect, Feature, Features, Reflection, ShaderError, ShaderId, library};

/// A resolved shader: validated by naga, ready for `wgpu::Device::create_shader_module`.
#[derive(Clone, Debug)]
pub struct Shader {
    /// Path of the root file, relative to `wgsl/` for embedded ones.
    pub file: String,
    /// Plain WGSL. The same root and features give the same bytes, in this run and the next.
    pub wgsl: String,
    /// Entry points, bindings and override constants.
    pub reflection: Reflection,
}

/// Resolves an embedded pass.
///
/// # Errors
/// None, unless an embedded source is wrong, which the tests of this crate rule out.
pub fn resolve(id: ShaderId, features: Features) -> Result<Shader, ShaderError> {
    resolve_root(Root::embedded(id, Overlay::new()), features.only(id.features()))
}

/// Resolves an embedded pass that ends with `effects`, in this order. A pass without the socket for them
/// ([`ShaderId::takes_effects`]) stays as it is.
///
/// # Errors
/// With file and line where an effect is wrong; or when two of them have one name.
pub fn resolve_with(id: ShaderId, features: Features, effects: &[Effect]) -> Result<Shader, ShaderError> {
    resolve_root(Root::embedded(id, effect::overlay(effects)?), features.only(id.features()))
}

/// Resolves an embedded pass by the name of its file without ending, such as `"post"`.
///
/// # Errors
/// [`ShaderError::UnknownShader`] if there is no such pass.
pub fn resolve_named(name: &str, features: Features) -> Result<Shader, ShaderError> {
    let known = ShaderId::ALL.into_iter().find(|id| id.name() == name);
    let id = known.ok_or_else(|| ShaderError::UnknownShader {
        name: name.to_owned(),
        known: ShaderId::ALL.map(ShaderId::name).join(", "),
    })?;
    resolve(id, features)
}

/// Resolves a source that is not embedded but may import what is, as
/// `import package::lib::luminance::luminance;`. `file` appears in errors and comments.
///
/// # Errors
/// With file and line where the source, or something it imports, is wrong.
pub fn resolve_source(file: &str, source: &str, features: Features) -> Result<Shader, ShaderError> {
    resolve_root(Root::custom(file, source)?, features)
}

/// The file to start from and the folder of embedded ones it may import.
struct Root<'a> {
    module: ModulePath,
    file: Cow<'a, str>,
    /// Text of a root that is not embedded.
    custom: Option<&'a str>,
    /// Modules that are looked up before the embedded ones.
    overlay: Overlay,
}

impl<'a> Root<'a> {
    fn embedded(id: ShaderId, overlay: Overlay) -> Self {
        Self {
            module: absolute(vec!["pass".to_owned(), id.name().to_owned()]),
            file: Cow::Owned(id.path()),
            custom: None,
            overlay,
        }
    }

    /// A custom root lives in a folder of its own, `custom`, so that its name cannot hide an
    /// embedded module.
    fn custom(file: &'a str, text: &'a str) -> Result<Self, ShaderError> {
        let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
        let stem = name.strip_suffix(".wgsl").unwrap_or(name);
        let is_word = |c: char| c == '_' || c.is_ascii_alphanumeric();
        let reason = if stem.is_empty() {
            "it is empty"
        } else if !stem.chars().all(is_word) || stem.starts_with(|c: char| c.is_ascii_digit()) {
            "it is no module name"
        } else {
            return Ok(Self {
                module: absolute(vec!["custom".to_owned(), stem.to_owned()]),
                file: Cow::Borrowed(file),
                custom: Some(text),
                overlay: Overlay::new(),
            });
        };
        Err(ShaderError::FileName { file: file.to_owned(), reason })
    }

    /// The file a module path stands for, as errors should name it.
    fn file_of(&self, module: &ModulePath) -> String {
        if *module == self.module {
            return self.file.clone().into_owned();
        }
        format!("{}.wgsl", module.components.join("/"))
    }

    fn text_of(&self, module: &ModulePath) -> Option<&str> {
        if let Some(text) = self.custom.filter(|_| *module == self.module) {
            return Some(text);
        }
        let path = format!("{}.wgsl", module.components.join("/"));
        let own = self.overlay.iter().find(|(p, _)| *p == path).map(|(_, text)| text.as_ref());
        own.or_else(|| library::text(&path))
    }
}

fn absolute(components: Vec<String>) -> ModulePath {
    ModulePath { origin: PathOrigin::Absolute, components }
}

impl Resolver for Root<'_> {
    fn resolve_source<'s>(&'s self, path: &ModulePath) -> Result<Cow<'s, str>, ResolveError> {
        let text =
            self.text_of(path).ok_or_else(|| ResolveError::ModuleNotFound(path.clone(), "not embedded".to_owned()))?;
        Ok(Cow::Borrowed(text))
    }

    fn display_name(&self, path: &ModulePath) -> Option<String> {
        Some(self.file_of(path))
    }
}

fn options(features: Features) -> CompileOptions {
    let flags = Feature::ALL.map(|f| (f.name().to_owned(), features.contains(f).into()));
    CompileOptions {
        features: wesl::Features {
            // A misspelt name in an @if is an error and not a feature that is off.
            default: wesl::Feature::Error,
            flags: flags.into_iter().collect(),
        },
        ..CompileOptions::default()
    }
}

fn resolve_root(root: Root<'_>, features: Features) -> Result<Shader, ShaderError> {
    let compiled = wesl::compile_sourcemap(&root.module, &root, &NoMangler, &options(features))
        .map_err(|error| origin::link_error(error, &root.file))?;
    let (wgsl, origins) = print(&root, &compiled);
    let (module, info) = validate(&wgsl).map_err(|fault| fault.at(&origins))?;
    let reflection = Reflection::of(&module, &info);
    Ok(Shader { file: root.file.into_owned(), wgsl, reflection })
}

/// The text of a resolved program, each declaration under a comment that says where it came
/// from, and the same as a table.
///
/// The resolver hands modules over in the order of a hash map, which differs from run to run.
/// WGSL does not care about the order of declarations, so they are sorted: the root's first,
/// then by file, each file in its own order.
fn print(root: &Root<'_>, compiled: &CompileResult) -> (String, Origins) {
    let mut wgsl = String::new();
    for directive in &compiled.syntax.global_directives {
        wgsl.push_str(&format!("{directive}\n"));
    }
    let declarations = compiled.syntax.global_declarations.iter().map(|declaration| {
        let name = origin::name_of(declaration);
        let found = name.and_then(|name| compiled.sourcemap.get_decl(&name));
        let module = found.map_or(&root.module, |(module, _)| module);
        (declaration, module, root.file_of(module))
    });
    let mut declarations: Vec<_> = declarations.collect();
    declarations
        .sort_by_key(|(declaration, module, file)| (**module != root.module, file.clone(), declaration.span().start));

    let mut origins = Origins::new(&root.file);
    for (declaration, module, file) in declarations {
        let source = root.text_of(module).unwrap_or_default();
        origins.append(&mut wgsl, declaration, &file, source);
    }
    (wgsl, origins)
}

/// A complaint of naga's about the resolved text.
pub(crate) struct Fault {
    /// Byte offset into the text, where naga gives one.
    offset: Option<usize>,
    message: String,
}

impl Fault {
    /// The fault in terms of the author's files.
    fn at(self, origins: &Origins) -> ShaderError {
        let (file, line) = origins.locate(self.offset);
        ShaderError::Source { file, line, message: self.message }
    }
}

/// Parses and validates plain WGSL with all optional capabilities allowed: whether the device
/// at hand has them is for the device to say.
fn validate(wgsl: &str) -> Result<(naga::Module, ModuleInfo), Fault> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|error| {
        let label = error.labels().next();
        let detail = label.filter(|(_, text)| !text.is_empty());
        Fault {
            offset: label.and_then(|(span, _)| span.to_range()).map(|range| range.start),
            message: match detail {
                Some((_, text)) if text != error.message() => {
                    format!("{}: {text}", error.message())
                }
                _ => error.message().to_owned(),
            },
        }
    })?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module).map_err(|error| {
        let span = error.spans().last().and_then(|(span, _)| span.to_range());
        Fault { offset: span.map(|range| range.start), message: chain(error.as_inner()) }
    })?;
    Ok((module, info))
}

/// An error and its causes in one line.
fn chain(error: &dyn std::error::Error) -> String {
    let mut line = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        line.push_str(&format!(": {error}"));
        cause = error.source();
    }
    line
}
