//! Comparison of a shader's source with the one that is to replace it.

use crate::device::error::DeviceError;
use crate::pipelines::bind_groups::BindGroupCache;
use crate::pipelines::interface::Interface;
use crate::pipelines::pipeline::Pipeline;
use crate::pipelines::shader::{InterfaceChange, Shader, ShaderError};
use std::cell::RefCell;
use std::collections::BTreeSet;
use wgpu::Device;

/// Interfaces of the old and the new source of a shader.
pub(crate) struct ComparedSources<'s> {
    name: &'s str,
    /// `None` if one of them cannot be read.
    interfaces: Option<[Interface; 2]>,
    /// Entry points of pipelines.
    checked: RefCell<BTreeSet<String>>,
    /// True if no pipeline has explicit layouts.
    derived: std::cell::Cell<bool>,
}

impl<'s> ComparedSources<'s> {
    /// Reads both interfaces.
    ///
    /// # Errors
    /// Fails if the new source lacks an entry point.
    pub(crate) fn new(shader: &Shader<'s>, text: &str) -> Result<Self, ShaderError> {
        let interfaces = Interface::read(shader.text()).zip(Interface::read(text)).map(|(old, new)| [old, new]);
        if let Some([old, new]) = &interfaces {
            old.check_entries(shader.name(), new)?;
        }
        Ok(Self { name: shader.name(), interfaces, checked: RefCell::default(), derived: true.into() })
    }

    /// Checks the bindings and constants of a pipeline. `derived` says that its layouts are derived from the source.
    pub(crate) fn check(&self, entries: &[&str], constants: &[(&str, f64)], derived: bool) -> Result<(), ShaderError> {
        self.checked.borrow_mut().extend(entries.iter().map(|entry| (*entry).to_owned()));
        self.derived.set(self.derived.get() && derived);
        let Some([old, new]) = &self.interfaces else { return Ok(()) };
        old.check_bindings(self.name, new, entries, derived)?;
        old.check_constants(self.name, new, constants)
    }

    /// Checks the entry points without a pipeline.
    pub(crate) fn check_others(&self) -> Result<(), ShaderError> {
        let (Some([old, new]), checked) = (&self.interfaces, self.checked.borrow()) else { return Ok(()) };
        old.entries().filter(|entry| !checked.contains(*entry)).try_for_each(|entry| {
            old.check_bindings(self.name, new, &[entry], self.derived.get())?;
            old.check_locations(self.name, new, entry)
        })
    }

    /// Replaces wgpu's error about a pipeline by one that names old and new declarations, if they differ.
    pub(crate) fn explain(&self, vertex: &str, fragment: Option<&str>, error: ShaderError) -> ShaderError {
        let Some([old, new]) = self.interfaces.as_ref().filter(|_| matches!(error, ShaderError::Pipeline { .. }))
        else {
            return error;
        };
        let mut entries = [Some(vertex), fragment].into_iter().flatten();
        entries.find_map(|entry| old.check_locations(self.name, new, entry).err()).unwrap_or(error)
    }

    /// Checks that the resources which recent frames bound fit the layouts of the new pipeline.
    pub(crate) fn check_bound<P>(
        &self,
        device: &Device,
        groups: &BindGroupCache,
        old: &Pipeline<P>,
        new: &Pipeline<P>,
    ) -> Result<(), ShaderError> {
        for index in 0..old.groups() {
            let ((Ok(before), group), true) = ((old.group(index).layout(), new.group(index)), index < new.groups())
            else {
                continue;
            };
            let Ok(after) = group.layout() else { continue };
            groups.check(device, before, after).map_err(|(bindings, error)| match error {
                DeviceError::Refused { message, .. } => ShaderError::Reload(Box::new(InterfaceChange {
                    name: self.name.to_owned(),
                    place: format!("bind group {index}"),
                    old: "a layout that fits the bound resources".to_owned(),
                    new: format!("one that does not ({})", group.explain(&bindings, message)),
                })),
                other => ShaderError::Device(other),
            })?;
        }
        Ok(())
    }
}
