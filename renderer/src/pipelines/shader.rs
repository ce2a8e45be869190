//! Cache of shader modules by name and source.

use crate::cache::Cache;
use crate::device::error::{DeviceError, ErrorScopes};
use crate::hash::{FNV_START, fnv_append};
use crate::pipelines::loops::first_endless;
use crate::pipelines::pipeline::Source;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::hash::{Hash, Hasher};
use std::sync::Arc;
use wgpu::naga::front::wgsl;
use wgpu::{Device, ShaderModule, ShaderModuleDescriptor, ShaderRuntimeChecks, ShaderSource};

/// A named WGSL module.
///
/// Shaders are compared by a hash of name and source. If the source changes under a name, module and pipelines are
/// compiled again.
///
/// Creating a `Shader` hashes the whole source. For constants this happens at compile time. Programs that generate
/// source at run time should keep its [`Shader::hash`] and use [`Shader::hashed`].
#[derive(Clone, Copy, Debug)]
pub struct Shader<'a> {
    name: &'a str,
    text: &'a str,
    hash: u64,
}

impl<'a> Shader<'a> {
    /// Creates a shader from a name, which errors and debuggers show, and WGSL source with all imports resolved.
    pub const fn new(name: &'a str, text: &'a str) -> Self {
        // Name and source are separated by a byte that does not occur in UTF-8.
        let named = fnv_append(fnv_append(FNV_START, name.as_bytes()), &[0xff]);
        Self::hashed(name, text, fnv_append(named, text.as_bytes()))
    }

    /// Creates a shader with the hash of an earlier `Shader` of equal name and source. A wrong hash may select
    /// pipelines of another shader.
    pub const fn hashed(name: &'a str, text: &'a str, hash: u64) -> Self {
        Self { name, text, hash }
    }

    /// Returns the name that errors and debuggers show.
    pub const fn name(&self) -> &'a str {
        self.name
    }

    /// Returns the WGSL source.
    pub const fn text(&self) -> &'a str {
        self.text
    }

    /// Returns the 64-bit hash of name and source, which identifies the shader.
    pub const fn hash(&self) -> u64 {
        self.hash
    }
}

impl PartialEq for Shader<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.hash == other.hash
    }
}

impl Eq for Shader<'_> {}

impl Hash for Shader<'_> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.hash.hash(state);
    }
}

/// Error: a shader or pipeline does not compile.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum ShaderError {
    /// The source does not compile.
    #[error("shader `{name}` does not compile: {message}")]
    Module {
        /// Name of the shader.
        name: String,
        /// Location and reason.
        message: String,
    },
    /// The source compiles, but does not match the pipeline.
    #[error("pipeline of shader `{name}` ({}) was rejected: {message}", .entries.join(", "))]
    Pipeline {
        /// Name of the shader.
        name: String,
        /// Entry points, in the order of their stages.
        entries: Vec<String>,
        /// Reason given by wgpu.
        message: String,
    },
    /// A new source does not fit the recorders of the old one, which stays in use.
    #[error(transparent)]
    Reload(Box<InterfaceChange>),
    /// The device failed.
    #[error(transparent)]
    Device(DeviceError),
}

/// Error: a new source of a shader expects something else of recorders than the old one.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "shader `{name}` keeps its old source: {place} would change from {old} to {new}; restart the program with a recorder \
     that fits"
)]
pub struct InterfaceChange {
    /// Name of the shader.
    pub name: String,
    /// Entry points, binding, vertex inputs, outputs or constant that would change.
    pub place: String,
    /// Declaration in the old source.
    pub old: String,
    /// Declaration in the new source.
    pub new: String,
}

impl std::fmt::Debug for InterfaceChange {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl std::fmt::Debug for ShaderError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// A compiled module with its source.
#[derive(Clone, Debug)]
pub(crate) struct Compiled {
    pub(crate) module: ShaderModule,
    pub(crate) source: Arc<Source>,
}

/// Compiled modules by shader hash.
#[derive(Debug, Default)]
pub(crate) struct ShaderModules {
    compiled: Cache<u64, Compiled>,
    /// Modules that replace a shader's original source. Never dropped, since the source is not kept elsewhere.
    reloaded: BTreeMap<u64, Compiled>,
}

impl ShaderModules {
    /// Returns the number of compiled modules, without reloaded ones.
    pub(crate) fn created(&self) -> u64 {
        self.compiled.counts().created
    }

    /// Begins a frame. Drops modules that were not requested for `max_age` frames.
    pub(crate) fn begin_frame(&mut self, max_age: u64) {
        self.compiled.begin_frame(max_age);
    }

    /// Returns the module of a shader.
    ///
    /// # Errors
    /// Fails with [`ShaderError::Module`] if the source does not compile.
    pub(crate) fn get(&self, device: &Device, shader: &Shader<'_>) -> Result<Compiled, ShaderError> {
        if let Some(reloaded) = self.reloaded.get(&shader.hash) {
            return Ok(reloaded.clone());
        }
        let compile = || Ok((shader.hash, Self::compile(device, shader.name, shader.text)?));
        self.compiled.get(shader.hash, |hash| *hash == shader.hash, compile)
    }

    /// Compiles a module without caching it.
    ///
    /// # Errors
    /// Fails like [`ShaderModules::get`].
    pub(crate) fn compile(device: &Device, name: &str, text: &str) -> Result<Compiled, ShaderError> {
        let of_source = |source: ShaderSource<'_>| {
            let scopes = ErrorScopes::open(device);
            let module = create_module(device, ShaderModuleDescriptor { label: Some(name), source });
            scopes.close("a shader").map(|()| module)
        };
        // Passes naga's module to wgpu to avoid parsing twice. On errors, the source is passed instead, so that wgpu
        // can quote it.
        let read = wgsl::parse_str(text).ok().and_then(|read| of_source(ShaderSource::Naga(Cow::Owned(read))).ok());
        let module = read.map_or_else(|| of_source(ShaderSource::Wgsl(text.into())), Ok);
        let module = module.map_err(|error| match error {
            DeviceError::Refused { message, .. } => ShaderError::Module { name: name.to_owned(), message },
            other => ShaderError::Device(other),
        })?;
        Ok(Compiled { module, source: Arc::new(Source::new(device, name, text)) })
    }

    /// Uses `compiled` for the shader with this hash from now on.
    pub(crate) fn replace(&mut self, hash: u64, compiled: Compiled) {
        self.reloaded.insert(hash, compiled);
    }
}

/// Creates a shader module, without loop counters if all loops are proved to end.
#[allow(unsafe_code, reason = "the promise that loops end needs an unsafe call")]
fn create_module(device: &Device, descriptor: ShaderModuleDescriptor<'_>) -> ShaderModule {
    let ShaderSource::Naga(module) = &descriptor.source else { return device.create_shader_module(descriptor) };
    if first_endless(module).is_some() {
        return device.create_shader_module(descriptor);
    }
    let checks = ShaderRuntimeChecks { force_loop_bounding: false, ..ShaderRuntimeChecks::checked() };
    // SAFETY: all checks stay on except loop counters, and all loops of this module were proved to end.
    unsafe { device.create_shader_module_trusted(descriptor, checks) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::gpu::Gpu;

    #[test]
    fn a_module_is_compiled_once_per_source() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::noop()?;
        let modules = ShaderModules::default();
        let good = Shader::new("good", "@compute @workgroup_size(1) fn main() {}");
        let first = modules.get(&gpu.device, &good)?.module;
        assert_eq!(modules.get(&gpu.device, &good)?.module, first);
        let changed = Shader::new("good", "@compute @workgroup_size(2) fn main() {}");
        assert_ne!(modules.get(&gpu.device, &changed)?.module, first);
        assert_eq!(modules.created(), 2);
        Ok(())
    }

    #[test]
    fn a_wrong_source_is_an_error_with_name_and_location() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::noop()?;
        // A syntax error, and two sources that parse but are invalid.
        for line in ["return nonsense;", "return array<f32, 2>()[4u32];", "if 1.0 { } return 0.0;"] {
            let text = format!("fn f() -> f32 {{\n  {line}\n}}\n@fragment fn fs() {{ _ = f(); }}");
            let refused = ShaderModules::default().get(&gpu.device, &Shader::new("effects/bad", &text));
            let report = refused.map(|_| ()).map_err(|error| error.to_string()).err().unwrap_or_default();
            let placed = report.contains("2:") || report.contains("2 │");
            assert!(report.contains("effects/bad") && report.contains(line) && placed, "{report}");
        }
        Ok(())
    }
}
