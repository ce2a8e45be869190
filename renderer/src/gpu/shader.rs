//! Shader modules, compiled once for each text.

use super::trouble::{DeviceError, Scopes};
use std::collections::HashMap;
use std::hash::{Hash, Hasher};
use wgpu::{Device, ShaderModule, ShaderModuleDescriptor, ShaderSource};

/// A WGSL module with its name.
///
/// Two shaders are the same when name and text are; a changed text under an old name is compiled anew, with all
/// pipelines made from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shader<'a> {
    /// The name that errors and debuggers show.
    pub name: &'a str,
    /// WGSL, with every import resolved.
    pub text: &'a str,
}

impl<'a> Shader<'a> {
    /// A shader of that name and text.
    pub const fn new(name: &'a str, text: &'a str) -> Self {
        Self { name, text }
    }
}

impl Hash for Shader<'_> {
    /// By name and length: hashing kilobytes for each draw would cost more than comparing them once.
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.name.hash(state);
        self.text.len().hash(state);
    }
}

/// A shader or pipeline could not be compiled.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ShaderError {
    /// The text is wrong.
    #[error("shader `{name}` does not compile: {message}")]
    Module {
        /// The shader.
        name: String,
        /// Where and why.
        message: String,
    },
    /// The text is right, but not for this pipeline.
    #[error("pipeline of shader `{name}` ({entries}) is refused: {message}")]
    Pipeline {
        /// The shader.
        name: String,
        /// Its entry points.
        entries: String,
        /// Why.
        message: String,
    },
    /// The device failed.
    #[error(transparent)]
    Device(DeviceError),
}

/// Compiled modules by name.
#[derive(Debug, Default)]
pub struct ShaderModules {
    modules: HashMap<String, Vec<(String, ShaderModule)>>,
    created: u64,
}

impl ShaderModules {
    /// Modules compiled since the beginning.
    pub fn created(&self) -> u64 {
        self.created
    }

    /// The module of that name and text.
    ///
    /// # Errors
    /// [`ShaderError::Module`] with the name, place and reason when the text does not compile.
    pub fn get(&mut self, device: &Device, shader: &Shader<'_>) -> Result<ShaderModule, ShaderError> {
        let known = self.modules.get(shader.name).and_then(|texts| texts.iter().find(|(text, _)| text == shader.text));
        if let Some((_, module)) = known {
            return Ok(module.clone());
        }
        let scopes = Scopes::open(device);
        let source = ShaderSource::Wgsl(shader.text.into());
        let module = device.create_shader_module(ShaderModuleDescriptor { label: Some(shader.name), source });
        scopes.close("a shader").map_err(|error| match error {
            DeviceError::Refused { message, .. } => ShaderError::Module { name: shader.name.to_owned(), message },
            other => ShaderError::Device(other),
        })?;
        self.created += 1;
        let texts = self.modules.entry(shader.name.to_owned()).or_default();
        texts.push((shader.text.to_owned(), module.clone()));
        Ok(module)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::device::Gpu;

    #[test]
    fn a_module_is_compiled_once_for_each_text() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::noop()?;
        let mut modules = ShaderModules::default();
        let good = Shader::new("good", "@compute @workgroup_size(1) fn main() {}");
        let first = modules.get(&gpu.device, &good)?;
        assert_eq!(modules.get(&gpu.device, &good)?, first);
        let changed = Shader::new("good", "@compute @workgroup_size(2) fn main() {}");
        assert_ne!(modules.get(&gpu.device, &changed)?, first);
        assert_eq!(modules.created(), 2);
        Ok(())
    }

    #[test]
    fn a_wrong_text_is_an_error_with_name_and_place() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::noop()?;
        let bad = Shader::new("effects/bad", "fn f() -> f32 {\n  return nonsense;\n}");
        let told = ShaderModules::default()
            .get(&gpu.device, &bad)
            .map(|_| ())
            .map_err(|e| e.to_string())
            .err()
            .unwrap_or_default();
        assert!(told.contains("effects/bad") && told.contains("nonsense") && told.contains("2:"), "{told}");
        Ok(())
    }
}
