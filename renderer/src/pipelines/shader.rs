//! Shader modules, compiled once for each text.

use crate::cache::Cache;
use crate::device::error::{DeviceError, ErrorScopes};
use crate::hash::{FNV_START, fnv_append};
use crate::pipelines::bounds::first_unproved;
use crate::pipelines::loops::first_endless;
use crate::pipelines::pipeline::Source;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::hash::{Hash, Hasher};
use std::sync::Arc;
use wgpu::naga::front::wgsl;
use wgpu::{Device, ShaderModule, ShaderModuleDescriptor, ShaderRuntimeChecks, ShaderSource};

/// A WGSL module with its name.
///
/// Two shaders are the same when the hash of name and text is; a changed text under an old name is compiled anew, with all
/// pipelines made from it. Making a `Shader` reads the whole text once: a constant does that when the program is
/// compiled; a program that keeps a text from frame to frame should keep its [`Shader::hash`] beside it ([`Shader::hashed`]).
#[derive(Clone, Copy, Debug)]
pub struct Shader<'a> {
    name: &'a str,
    text: &'a str,
    hash: u64,
}

impl<'a> Shader<'a> {
    /// A shader of that name and text: WGSL with every import resolved. Errors and debuggers show the name.
    pub const fn new(name: &'a str, text: &'a str) -> Self {
        // A byte that no UTF-8 has stands between the two.
        let named = fnv_append(fnv_append(FNV_START, name.as_bytes()), &[0xff]);
        Self::hashed(name, text, fnv_append(named, text.as_bytes()))
    }

    /// As [`Shader::new`], with the hash that an earlier `Shader` of the same name and text had. With another hash, the
    /// pipelines of another shader may be taken for this one's.
    pub const fn hashed(name: &'a str, text: &'a str, hash: u64) -> Self {
        Self { name, text, hash }
    }

    /// The name that errors and debuggers show.
    pub const fn name(&self) -> &'a str {
        self.name
    }

    /// The WGSL.
    pub const fn text(&self) -> &'a str {
        self.text
    }

    /// What tells shaders apart: a hash of name and text, of 64 bits.
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

/// A shader or pipeline could not be compiled.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum ShaderError {
    /// The text is wrong.
    #[error("shader `{name}` does not compile: {message}")]
    Module {
        /// Name of the shader.
        name: String,
        /// Line and reason.
        message: String,
    },
    /// The text is right, but not for this pipeline.
    #[error("pipeline of shader `{name}` ({}) is refused: {message}", .entries.join(", "))]
    Pipeline {
        /// Name of the shader.
        name: String,
        /// The entry points, in the order of their stages.
        entries: Vec<String>,
        /// wgpu's reason.
        message: String,
    },
    /// The device failed meanwhile.
    #[error(transparent)]
    Device(DeviceError),
}

impl std::fmt::Debug for ShaderError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// A module with what it was compiled from.
#[derive(Clone, Debug)]
pub(crate) struct Compiled {
    pub(crate) module: ShaderModule,
    pub(crate) source: Arc<Source>,
}

/// Compiled modules by the hash of the shader that is asked for.
#[derive(Debug, Default)]
pub(crate) struct ShaderModules {
    compiled: Cache<u64, Compiled>,
    /// What took the place of a shader's own text; kept, since nobody else has it.
    reloaded: BTreeMap<u64, Compiled>,
}

impl ShaderModules {
    /// Modules compiled since the beginning, reloaded ones apart.
    pub(crate) fn created(&self) -> u64 {
        self.compiled.counts().created
    }

    /// Begins a frame, and drops what no pipeline was made from during `max_age` frames.
    pub(crate) fn begin_frame(&mut self, max_age: u64) {
        self.compiled.begin_frame(max_age);
    }

    /// The module of that name and text.
    ///
    /// # Errors
    /// [`ShaderError::Module`] with the name, place and reason when the text does not compile.
    pub(crate) fn get(&self, device: &Device, shader: &Shader<'_>) -> Result<Compiled, ShaderError> {
        if let Some(reloaded) = self.reloaded.get(&shader.hash) {
            return Ok(reloaded.clone());
        }
        let compile = || Ok((shader.hash, Self::compile(device, shader.name, shader.text)?));
        self.compiled.get(shader.hash, |hash| *hash == shader.hash, compile)
    }

    /// A module that is not kept.
    ///
    /// # Errors
    /// As [`ShaderModules::get`].
    pub(crate) fn compile(device: &Device, name: &str, text: &str) -> Result<Compiled, ShaderError> {
        let of_source = |source: ShaderSource<'_>| {
            let scopes = ErrorScopes::open(device);
            let module = create_module(device, ShaderModuleDescriptor { label: Some(name), source });
            scopes.close("a shader").map(|()| module)
        };
        // What naga has read is not read again. Of a module wgpu could not quote the line that it refuses.
        let read = wgsl::parse_str(text).ok().and_then(|read| of_source(ShaderSource::Naga(Cow::Owned(read))).ok());
        let module = read.map_or_else(|| of_source(ShaderSource::Wgsl(text.into())), Ok);
        let module = module.map_err(|error| match error {
            DeviceError::Refused { message, .. } => ShaderError::Module { name: name.to_owned(), message },
            other => ShaderError::Device(other),
        })?;
        Ok(Compiled { module, source: Arc::new(Source::new(device, name, text)) })
    }

    /// Takes `compiled` for the shader of that hash from now on.
    pub(crate) fn replace(&mut self, hash: u64, compiled: Compiled) {
        self.reloaded.insert(hash, compiled);
    }
}

/// A module in which loops are not counted if they are proved to end, and indices not tested if they are proved to be in range.
#[allow(unsafe_code, reason = "wgpu takes the promise that loops end, and indices are in range, by a call of its own")]
fn create_module(device: &Device, descriptor: ShaderModuleDescriptor<'_>) -> ShaderModule {
    let ShaderSource::Naga(module) = &descriptor.source else { return device.create_shader_module(descriptor) };
    let (force_loop_bounding, bounds_checks) = (first_endless(module).is_some(), first_unproved(module).is_some());
    if force_loop_bounding && bounds_checks {
        return device.create_shader_module(descriptor);
    }
    let checks = ShaderRuntimeChecks { force_loop_bounding, bounds_checks, ..ShaderRuntimeChecks::checked() };
    // SAFETY: all checks stay but two. One asks that no loop is endless, the other that no index is out of range; each loop was proved
    // to end, or each index to be in range, of the module that is compiled.
    unsafe { device.create_shader_module_trusted(descriptor, checks) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::gpu::Gpu;

    #[test]
    fn a_module_is_compiled_once_for_each_text() -> Result<(), Box<dyn std::error::Error>> {
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
    fn a_wrong_text_is_an_error_with_name_and_place() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::noop()?;
        // What cannot be read, and what can but makes no sense.
        for line in ["return nonsense;", "return array<f32, 2>()[4u32];", "if 1.0 { } return 0.0;"] {
            let text = format!("fn f() -> f32 {{\n  {line}\n}}\n@fragment fn fs() {{ _ = f(); }}");
            let refused = ShaderModules::default().get(&gpu.device, &Shader::new("effects/bad", &text));
            let told = refused.map(|_| ()).map_err(|error| error.to_string()).err().unwrap_or_default();
            let placed = told.contains("2:") || told.contains("2 │");
            assert!(told.contains("effects/bad") && told.contains(line) && placed, "{told}");
        }
        Ok(())
    }
}
