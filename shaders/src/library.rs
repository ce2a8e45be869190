//! WGSL files: the embedded files of this crate, and shaders of other crates that import them.
//!
//! Embedded files are part of the program, so nothing is read from disk at run time. `build.rs` lists the folder.

use crate::Feature;

/// WGSL file that shaders can import from.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// Path with slashes, as errors name it. Imports leave out the extension: `lib/ggx.wgsl` is `package::lib::ggx`.
    /// Paths of embedded files are relative to `wgsl/`.
    pub path: &'a str,
    /// WGSL text with `import` statements and `@if` attributes.
    pub wgsl: &'a str,
}

/// All embedded files, sorted by path.
pub const SOURCES: &[Source<'static>] = include!(concat!(env!("OUT_DIR"), "/sources.rs"));

/// Returns the text of an embedded file, by its path relative to `wgsl/`. In a constant, a wrong path is a compile
/// error:
///
/// ```
/// const EXPOSE: &str = framegraph_shaders::library::text("effect/expose.wgsl").unwrap();
/// ```
pub const fn text(path: &str) -> Option<&'static str> {
    let mut index = 0;
    while index < SOURCES.len() {
        if same(SOURCES[index].path, path) {
            return Some(SOURCES[index].wgsl);
        }
        index += 1;
    }
    None
}

/// Returns the text of an embedded file for use in shaders. This is [`text`], unless the feature `replaced` is on and
/// the folder in the environment variable `FRAMEGRAPH_WGSL` contains the file. A replacement is read once, on first
/// use.
pub fn in_use(path: &str) -> Option<&'static str> {
    let embedded = text(path)?;
    #[cfg(feature = "replaced")]
    if let Some(other) = crate::replaced::text(path) {
        return Some(other);
    }
    Some(embedded)
}

/// Returns an embedded pass, by its path relative to `wgsl/`. In a constant, a wrong path is a compile error:
///
/// ```
/// use framegraph_shaders::{Module, library};
/// const COLOR: Module<'_> = library::pass("pass/color.wgsl").unwrap();
/// assert_eq!(COLOR.name(), "color");
/// ```
pub const fn pass(path: &'static str) -> Option<Module<'static>> {
    match text(path) {
        Some(wgsl) => Some(Module::new(path, wgsl)),
        None => None,
    }
}

/// Returns all embedded passes, sorted by path.
pub fn passes() -> impl Iterator<Item = Module<'static>> {
    SOURCES.iter().filter(|source| source.path.starts_with("pass/")).map(|source| Module::new(source.path, source.wgsl))
}

/// Compares texts in constants.
const fn same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut index = 0;
    while index < a.len() && index < b.len() && a[index] == b[index] {
        index += 1;
    }
    index == a.len() && index == b.len()
}

/// Shader: a file with entry points, and everything it needs besides the embedded files. Two modules are equal if their
/// paths are equal.
///
/// ```
/// use framegraph_shaders::{Feature, Features, Module, resolve};
///
/// const SNOW: Feature = Feature::new("SNOW");
/// // Usually `include_str!("ground.wgsl")`.
/// const TEXT: &str = "import package::lib::luminance::luminance;
/// @group(0) @binding(0) var picture: texture_2d<f32>;
/// @if(SNOW) const BRIGHTER: f32 = 2.0;
/// @else const BRIGHTER: f32 = 1.0;
/// @fragment fn fs_main(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
///     return vec4<f32>(BRIGHTER * luminance(textureLoad(picture, vec2<i32>(at.xy), 0).rgb));
/// }";
/// const GROUND: Module<'_> = Module { features: &[SNOW], ..Module::new("ground.wgsl", TEXT) };
///
/// let shader = resolve(&GROUND, &Features::NONE.with(SNOW), &[])?;
/// assert!(shader.wgsl.contains("BRIGHTER: f32 = 2.0"));
/// # Ok::<(), framegraph_shaders::ShaderError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Module<'a> {
    /// Path that names the file in errors and in the resolved text.
    pub path: &'a str,
    /// WGSL text.
    pub wgsl: &'a str,
    /// Features that the shader or its sources test, besides those of the embedded files.
    pub features: &'a [Feature],
    /// Files that the shader or its sources import, besides the embedded files. They cannot replace embedded files.
    pub sources: &'a [Source<'a>],
}

impl<'a> Module<'a> {
    /// Creates a shader that needs only the embedded files.
    pub const fn new(path: &'a str, wgsl: &'a str) -> Self {
        Self { path, wgsl, features: &[], sources: &[] }
    }

    /// Returns the last part of the path without extension, for labels: `color`.
    pub fn name(&self) -> &'a str {
        let file = self.path.rsplit(['/', '\\']).next().unwrap_or(self.path);
        file.strip_suffix(".wgsl").unwrap_or(file)
    }
}

impl PartialEq for Module<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path
    }
}

impl Eq for Module<'_> {}
