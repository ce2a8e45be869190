//! Resolution of an embedded pass, or of an application's shader, into one plain WGSL text.
//!
//! 1. `token` and `code` read a file into tokens with matched brackets; `embedded` caches the tokens of embedded files.
//! 2. `condition` removes items that `@if` attributes switch off.
//! 3. `module` finds imports and declarations.
//! 4. `link` follows imports and writes the declarations that entry points reach, each below a comment with its file
//!    and line. It numbers the bindings of effects after those of the pass.
//! 5. `check` validates the text with naga and maps errors back to the author's lines.
//!
//! Names are kept as written, so errors, captures and reflection show the author's names. Names of shared files are
//! unique, which a test verifies. Two files of one shader that declare the same name are an error.

mod check;
mod code;
mod condition;
mod embedded;
mod fault;
mod link;
mod module;
mod token;

use std::borrow::Cow;

use self::code::Code;
use self::fault::Fault;
use crate::effect::{self, Effect, SOCKET};
use crate::{Feature, Features, Module, Reflection, ShaderError, library};

/// Resolved shader: validated by naga, ready for `wgpu::Device::create_shader_module`.
#[derive(Clone, Debug)]
pub struct Shader {
    /// Plain WGSL. The text is deterministic: the same module, features and effects always give the same bytes.
    pub wgsl: String,
    /// Entry points, bindings and override constants.
    pub reflection: Reflection,
}

fn read(text: &str) -> Result<Cow<'_, Code<'_>>, Fault> {
    Code::new(text).map(Cow::Owned)
}

/// Resolves a shader with `features`, ending with `effects` in this order. Features that the shader does not test have
/// no effect.
///
/// # Errors
///
/// With file and line if the shader, an effect or an imported file is invalid. Also if a feature is unknown or two
/// effects share a name. Also if effects are given and the shader does not end with the socket
/// `package::interface::epilogue`.
pub fn resolve(module: &Module<'_>, features: &Features, effects: &[Effect<'_>]) -> Result<Shader, ShaderError> {
    let known = |name: &str| {
        Feature::all().chain([Feature::STEREO]).chain(module.features.iter().copied()).any(|f| f.name() == name)
    };
    if let Some(unknown) = features.iter().find(|feature| !known(feature.name())) {
        return Err(ShaderError::UnknownFeature { name: unknown.name(), file: module.path.to_owned() });
    }
    if module.path.is_empty() || module.path.contains(char::is_control) {
        let reason = "a shader needs a name of printable characters, which errors refer to";
        return Err(ShaderError::FileName { file: module.path.to_owned(), reason });
    }
    if let Some(taken) = module.sources.iter().find(|source| library::text(source.path).is_some()) {
        let reason = "an embedded file has this path";
        return Err(ShaderError::FileName { file: taken.path.to_owned(), reason });
    }
    let overlay = effect::overlay(effects)?;
    let load = |path: &str| {
        if let Some((_, own)) = overlay.iter().find(|(p, _)| *p == path) {
            return read(own).map(Some);
        }
        if let Some(code) = embedded::code(path)? {
            return Ok(Some(Cow::Borrowed(code)));
        }
        module.sources.iter().find(|source| source.path == path).map(|source| read(source.wgsl)).transpose()
    };
    let is_on = |name: &str| known(name).then(|| features.iter().any(|feature| feature.name() == name));
    let is_embedded = library::text(module.path) == Some(module.wgsl);
    let known = if is_embedded { embedded::code(module.path) } else { Ok(None) };
    let root = known.and_then(|known| known.map_or_else(|| read(module.wgsl), |code| Ok(Cow::Borrowed(code))));
    let root = root.map_err(|fault| fault.at(module.path))?;
    let linked = link::link(module.path, &root, &load, &is_on)?;
    #[cfg(feature = "replaced")]
    crate::replaced::note(linked.lines());
    if !effects.is_empty() && !linked.files.iter().any(|file| file == SOCKET) {
        return Err(ShaderError::NoEpilogue { file: module.path.to_owned() });
    }
    let (module, info) = check::check(&linked)?;
    let reflection = Reflection::of(&module, &info);
    Ok(Shader { wgsl: linked.wgsl, reflection })
}
