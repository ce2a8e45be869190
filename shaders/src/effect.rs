//! Point-wise effects: what may happen to a color between shading and the target.
//!
//! An effect is a WGSL module with a function of the same name, from a color and the position in pixels to a color.
//! [`resolve_with`](crate::resolve_with) calls a list of them in the socket `interface/epilogue.wgsl`, which shading
//! passes and full-screen passes end with: one text of each effect serves both.

use std::borrow::Cow;
use std::fmt::Write;

use crate::{ShaderError, library};

/// A WGSL module `package::effect::NAME` with a function
/// `NAME(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32>`.
///
/// It may import the library, declare overrides, and bind resources of its own in
/// [`GROUP_EFFECTS`](crate::bindings::GROUP_EFFECTS). The embedded ones are constants of this type; one of an
/// application's own chooses a binding from [`FREE_EFFECT_BINDING`](crate::bindings::FREE_EFFECT_BINDING) on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Effect {
    /// Name of the module and of its function.
    pub name: &'static str,
    /// The text.
    pub text: &'static str,
}

macro_rules! embedded {
    ($name:literal) => {
        Effect { name: $name, text: include_str!(concat!("../wgsl/effect/", $name, ".wgsl")) }
    };
}

impl Effect {
    /// Exposure compensation. Binds `exposing`.
    pub const EXPOSE: Self = embedded!("expose");
    /// Darker corners. Binds `vignetting`.
    pub const VIGNETTE: Self = embedded!("vignette");
    /// Color grading. Binds `grading`.
    pub const GRADE: Self = embedded!("grade");
    /// The tone curve. Override `TONE_MAP`.
    pub const TONE: Self = embedded!("tone");
    /// Codes of the target, with dither. Binds `encoding`; overrides `OUTPUT_ENCODED`, `LUMA_IN_ALPHA`.
    pub const ENCODE: Self = embedded!("encode");
    /// What storing as Rgba16Float leaves. Override `RGBA16FLOAT_TOWARD_ZERO`.
    pub const STORE_RGBA16FLOAT: Self = embedded!("store_rgba16float");
    /// What storing as Rg11b10Ufloat leaves. Override `RG11B10UFLOAT_TOWARD_ZERO`.
    pub const STORE_RG11B10UFLOAT: Self = embedded!("store_rg11b10ufloat");

    /// The embedded ones, in the order in which a frame applies them.
    pub const ALL: [Self; 7] = [
        Self::STORE_RGBA16FLOAT,
        Self::STORE_RG11B10UFLOAT,
        Self::EXPOSE,
        Self::VIGNETTE,
        Self::GRADE,
        Self::TONE,
        Self::ENCODE,
    ];

    /// Path of its module, relative to `wgsl/`.
    pub fn path(&self) -> String {
        format!("effect/{}.wgsl", self.name)
    }
}

/// Path of the module that effects are plugged into.
pub(crate) const SOCKET: &str = "interface/epilogue.wgsl";

/// Texts that stand in for embedded modules or beside them, by path.
pub(crate) type Overlay = Vec<(String, Cow<'static, str>)>;

/// The socket filled with `effects`, and the modules of those that are not embedded.
///
/// # Errors
/// Two effects of one name with different texts, or a name that is no module name.
pub(crate) fn overlay(effects: &[Effect]) -> Result<Overlay, ShaderError> {
    let mut modules = Overlay::new();
    if effects.is_empty() {
        return Ok(modules);
    }
    let is_word = |c: char| c == '_' || c.is_ascii_alphanumeric();
    let (mut imports, mut calls) = (String::new(), String::new());
    for effect in effects {
        let path = effect.path();
        let refused = |reason| ShaderError::FileName { file: path.clone(), reason };
        if effect.name.is_empty() || !effect.name.chars().all(is_word) || effect.name.starts_with(char::is_numeric) {
            return Err(refused("the name of an effect is no module name"));
        }
        let known = modules.iter().find(|(p, _)| *p == path).map(|(_, text)| text.as_ref()).or(library::text(&path));
        match known {
            Some(text) if text != effect.text => return Err(refused("another effect has this name")),
            Some(_) => {}
            None => modules.push((path, Cow::Borrowed(effect.text))),
        }
        let import = format!("import package::effect::{0}::{0};\n", effect.name);
        if !imports.contains(&import) {
            imports += &import;
        }
        // Writing to a string cannot fail.
        let _ = writeln!(calls, "    color = {}(color, pixel);", effect.name);
    }
    let text = format!(
        "// The effects of this program, in order.\n\n{imports}\n\
         fn epilogue(shaded: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {{\n    \
             var color = shaded;\n{calls}    return color;\n}}\n"
    );
    modules.push((SOCKET.to_owned(), Cow::Owned(text)));
    Ok(modules)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Features, ShaderId, resolve_with};

    const SEPIA: Effect = Effect {
        name: "sepia",
        text: "import package::lib::luminance::luminance;\n\
               fn sepia(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {\n    \
                   return vec4<f32>(luminance(color.rgb) * vec3<f32>(1.0, 0.9, 0.7), color.a);\n}\n",
    };

    #[test]
    fn effects_are_called_in_order_and_as_often_as_listed() -> Result<(), ShaderError> {
        let effects = [Effect::EXPOSE, SEPIA, Effect::TONE, SEPIA];
        for id in [ShaderId::Post, ShaderId::Color, ShaderId::Sky] {
            let shader = resolve_with(id, Features::NONE, &effects)?;
            let from = shader.wgsl.find("fn epilogue(").unwrap_or_default();
            let body = &shader.wgsl[from..];
            let body = &body[..body.find("\n}").unwrap_or_default()];
            let calls: Vec<_> = body.lines().filter_map(|l| l.trim().strip_prefix("color = ")).collect();
            let names: Vec<_> = calls.iter().filter_map(|c| c.split_once('(')).map(|(name, _)| name).collect();
            assert_eq!(names, ["expose", "sepia", "tone", "sepia"], "{}", id.name());
            assert_eq!(shader.wgsl.matches("fn sepia(").count(), 1);
            let bound = shader.reflection.entry_points.iter().flat_map(|e| &e.bindings);
            assert!(bound.clone().any(|b| b.name == "exposing") && !bound.clone().any(|b| b.name == "encoding"));
        }
        Ok(())
    }

    #[test]
    fn wrong_names_are_refused() {
        let refused = |effects: &[Effect]| resolve_with(ShaderId::Post, Features::NONE, effects).map(|_| ()).is_err();
        assert!(refused(&[Effect { name: "no name", ..SEPIA }]));
        assert!(refused(&[SEPIA, Effect { text: "fn sepia() {}", ..SEPIA }]));
        assert!(refused(&[Effect { name: "tone", ..SEPIA }]), "an embedded one cannot be replaced");
    }

    #[test]
    fn a_fault_in_an_effect_is_reported_where_it_is() {
        let text = "fn sepia(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {\n    let x = 1;\n    return lost;\n}\n";
        let told = resolve_with(ShaderId::Post, Features::NONE, &[Effect { text, ..SEPIA }]);
        let told = told.map(|_| ()).map_err(|e| e.to_string()).err().unwrap_or_default();
        assert!(told.starts_with("effect/sepia.wgsl:3:"), "{told}");
    }

    #[test]
    fn constants_are_the_embedded_files() {
        for effect in Effect::ALL {
            assert_eq!(library::text(&effect.path()), Some(effect.text), "{}", effect.name);
        }
        let files = library::SOURCES.iter().filter(|s| s.path.starts_with("effect/"));
        assert_eq!(files.count(), Effect::ALL.len());
    }
}
