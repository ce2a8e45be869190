//! From an embedded pass, or a source of one's own, to one plain WGSL text.
//!
//! 1. `token` and `code` read a file into tokens with matched brackets.
//! 2. `condition` leaves out what `@if` attributes switch off.
//! 3. `module` finds imports and declarations.
//! 4. `link` follows imports and writes the declarations that entry points reach, each under a comment with the file and
//!    line it came from.
//! 5. `check` validates the text with naga and traces its complaints back to the author's line.
//!
//! Names are kept as written, so errors, captures and reflection show the author's names; the names of all shared files
//! are unique (a test sees to it), and two files of one shader that declare the same name are an error.

mod check;
mod code;
mod condition;
mod link;
mod module;
mod token;

use crate::effect::{self, Overlay};
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
    resolve_with(id, features, &[])
}

/// Resolves an embedded pass that ends with `effects`, in this order. A pass without the socket for them
/// ([`ShaderId::takes_effects`]) stays as it is.
///
/// # Errors
/// With file and line where an effect is wrong; or when two of them have one name.
pub fn resolve_with(id: ShaderId, features: Features, effects: &[Effect]) -> Result<Shader, ShaderError> {
    let path = id.path();
    let text = library::text(&path).unwrap_or_default();
    resolve_root(&path, text, &effect::overlay(effects)?, features.only(id.features()))
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
    if file.is_empty() || file.contains(char::is_control) {
        let reason = "a shader file needs a name of printable characters, which errors refer to";
        return Err(ShaderError::FileName { file: file.to_owned(), reason });
    }
    resolve_root(file, source, &Overlay::new(), features)
}

fn resolve_root(file: &str, text: &str, overlay: &Overlay, features: Features) -> Result<Shader, ShaderError> {
    let load = |path: &str| {
        let own = overlay.iter().find(|(p, _)| *p == path).map(|(_, text)| text.as_ref());
        own.or_else(|| library::text(path))
    };
    let is_on = |name: &str| Feature::ALL.into_iter().find(|f| f.name() == name).map(|f| features.contains(f));
    let linked = link::link(file, text, &load, &is_on)?;
    let (module, info) = check::check(&linked)?;
    let reflection = Reflection::of(&module, &info);
    Ok(Shader { file: file.to_owned(), wgsl: linked.wgsl, reflection })
}

/// What is wrong with a file, and in which line.
#[derive(Debug)]
struct Fault {
    line: usize,
    message: String,
}

impl Fault {
    fn new(line: usize, message: impl Into<String>) -> Self {
        Self { line, message: message.into() }
    }

    fn at(self, file: &str) -> ShaderError {
        ShaderError::Source { file: file.to_owned(), line: self.line, message: self.message }
    }
}
