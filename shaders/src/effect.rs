//! Point-wise effects, applied to a color between shading and the render target.
//!
//! Shading passes and full-screen passes end with the socket `interface/epilogue.wgsl`, in which
//! [`resolve`](crate::resolve()) calls a list of effects. Every effect therefore has one text for both kinds of pass.

use std::borrow::Cow;
use std::fmt::Write;

use crate::{ShaderError, library};

/// A point-wise effect: a WGSL file `effect/NAME.wgsl` with a function `NAME(color: vec4<f32>, pixel: vec2<f32>) ->
/// vec4<f32>`, where `pixel` is the position in pixels.
///
/// An effect may import the embedded files, declare overrides, and bind resources in group 0. Its binding numbers begin
/// at 0; [`resolve`](crate::resolve()) moves them behind those of the pass and of other effects.
/// [`library::text("effect/NAME.wgsl")`](library::text) returns the text of an embedded effect. Two effects are equal
/// if their names are equal.
#[derive(Clone, Copy, Debug)]
pub struct Effect<'a> {
    /// Name of the file and of its function.
    pub name: &'a str,
    /// WGSL text of the effect.
    pub wgsl: &'a str,
}

impl PartialEq for Effect<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Effect<'_> {}

/// Path of the file in which effects are called.
pub(crate) const SOCKET: &str = "interface/epilogue.wgsl";
/// Folder of effects.
pub(crate) const FOLDER: &str = "effect/";

/// Texts that replace embedded files or are added to them, by path.
pub(crate) type Overlay<'a> = Vec<(String, Cow<'a, str>)>;

/// Returns the socket that calls `effects`, and the files of effects that are not embedded.
///
/// # Errors
///
/// If two effects of the same name have different texts, or a name is not an identifier.
pub(crate) fn overlay<'a>(effects: &[Effect<'a>]) -> Result<Overlay<'a>, ShaderError> {
    let mut files = Overlay::new();
    if effects.is_empty() {
        return Ok(files);
    }
    let is_word = |c: char| c == '_' || c.is_ascii_alphanumeric();
    let (mut imports, mut calls) = (String::new(), String::new());
    for Effect { name, wgsl } in effects {
        let file = format!("{FOLDER}{name}.wgsl");
        if name.is_empty() || !name.chars().all(is_word) || name.starts_with(|c: char| c.is_ascii_digit()) {
            let reason = "the name of an effect is that of a function: letters, digits and `_`";
            return Err(ShaderError::FileName { file, reason });
        }
        let own = files.iter().find(|(path, _)| *path == file).map(|(_, text)| text.as_ref());
        match own.or(library::text(&file)) {
            Some(known) if known != *wgsl => {
                return Err(ShaderError::FileName { file, reason: "another effect has this name" });
            }
            Some(_) => {}
            None => files.push((file, Cow::Borrowed(*wgsl))),
        }
        let import = format!("import package::effect::{name}::{name};\n");
        if !imports.contains(&import) {
            imports += &import;
        }
        // Writing to a string cannot fail.
        let _ = writeln!(calls, "    color = {name}(color, pixel);");
    }
    let text = format!(
        "// The effects of this shader, in order.\n\n{imports}\n\
         fn epilogue(shaded: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {{\n    \
             var color = shaded;\n{calls}    return color;\n}}\n"
    );
    files.push((SOCKET.to_owned(), Cow::Owned(text)));
    Ok(files)
}
