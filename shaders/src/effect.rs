//! Point-wise effects: what may happen to a color between shading and the target.
//!
//! [`resolve`](crate::resolve()) calls a list of them in the socket `interface/epilogue.wgsl`, which shading passes and
//! full-screen passes end with: one text of each effect serves both.

use std::borrow::Cow;
use std::fmt::Write;

use crate::{ShaderError, library};

/// A WGSL file `effect/NAME.wgsl` with a function
/// `NAME(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32>`, where `pixel` is the position in pixels.
///
/// It may import the embedded files, declare overrides, and bind resources in group 0: with binding numbers of its own from
/// 0, which [`resolve`](crate::resolve()) moves behind those of the pass and of other effects. The texts of the embedded
/// ones are [`library::text("effect/NAME.wgsl")`](library::text). Two effects are equal when their names are.
#[derive(Clone, Copy, Debug)]
pub struct Effect<'a> {
    /// Name of the file and of its function.
    pub name: &'a str,
    /// The text.
    pub wgsl: &'a str,
}

impl PartialEq for Effect<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Effect<'_> {}

/// Path of the file that effects are plugged into.
pub(crate) const SOCKET: &str = "interface/epilogue.wgsl";
/// Folder of effects.
pub(crate) const FOLDER: &str = "effect/";

/// Texts that stand in for embedded files or beside them, by path.
pub(crate) type Overlay<'a> = Vec<(String, Cow<'a, str>)>;

/// The socket filled with `effects`, and the files of those that are not embedded.
///
/// # Errors
/// When two effects of one name have different texts, or a name is no identifier.
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
