//! Cache of programs by description, kept from frame to frame.

use super::{Program, ProgramDesc};
use crate::error::PassError;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, PoisonError, RwLock};

/// Cache of the programs of a world's passes. Programs are made on first use, since the plan selects the effects of a
/// shader. Programs with equal descriptions are shared between all caches of the process.
#[derive(Debug, Default)]
pub struct Programs {
    known: Table,
}

/// Programs of this process.
static MADE: LazyLock<Table> = LazyLock::new(Table::default);

/// Programs by the hashes of their descriptions.
#[derive(Debug, Default)]
struct Table(RwLock<HashMap<u64, Vec<Known>>>);

/// Program with its description.
#[derive(Debug)]
struct Known {
    addresses: Box<[(usize, usize)]>,
    program: Arc<Program>,
}

impl Table {
    /// Returns the program of a description with this hash; if it is missing, inserts the result of `make`.
    fn get(
        &self,
        desc: &ProgramDesc<'_>,
        hash: u64,
        make: impl FnOnce() -> Result<Arc<Program>, PassError>,
    ) -> Result<Arc<Program>, PassError> {
        let same = |known: &&Known| known.addresses.iter().copied().eq(desc.addresses());
        // A panic in another thread leaves the table consistent.
        let known = self.0.read().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = known.get(&hash).and_then(|bucket| bucket.iter().find(same)) {
            return Ok(Arc::clone(&known.program));
        }
        drop(known);
        let program = make()?;
        let mut known = self.0.write().unwrap_or_else(PoisonError::into_inner);
        let bucket = known.entry(hash).or_default();
        // If another thread was faster, all use its program.
        if let Some(known) = bucket.iter().find(same) {
            return Ok(Arc::clone(&known.program));
        }
        bucket.push(Known { addresses: desc.addresses().collect(), program: Arc::clone(&program) });
        Ok(program)
    }
}

impl Programs {
    /// Creates an empty cache.
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns the program of a description, and makes it if it is missing.
    ///
    /// # Errors
    /// Fails as [`Program::new`] does.
    pub fn get(&self, desc: &ProgramDesc<'_>) -> Result<Arc<Program>, PassError> {
        let hash = desc.hash();
        self.known.get(desc, hash, || MADE.get(desc, hash, || Program::new(desc).map(Arc::new)))
    }

    /// Returns all programs made so far, ordered by the hashes of their shaders; used to reload shaders
    /// ([`Executor::reload_shader`](framegraph_wgpu::Executor::reload_shader)).
    pub fn made(&self) -> Vec<Arc<Program>> {
        let known = self.known.0.read().unwrap_or_else(PoisonError::into_inner);
        let mut made: Vec<_> = known.values().flatten().map(|known| Arc::clone(&known.program)).collect();
        made.sort_by_key(|program| program.shader().hash());
        made
    }
}

/// Lets programs be the whole world of passes that use nothing else.
impl AsRef<Self> for Programs {
    fn as_ref(&self) -> &Self {
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::Interface;
    use framegraph_shaders::{Module, Source};

    /// Shaders with the same text but different imports are different programs.
    #[test]
    fn shaders_of_one_text_are_told_apart_by_what_they_import() -> Result<(), PassError> {
        const TEXT: &str = "import package::own::tint::tint;
            @vertex fn vs_main() -> @builtin(position) vec4<f32> { return vec4<f32>(0.0); }
            @fragment fn fs_main() -> @location(0) vec4<f32> { return tint(); }";
        const fn tint(wgsl: &'static str) -> [Source<'static>; 1] {
            [Source { path: "own/tint.wgsl", wgsl }]
        }
        static RED: [Source<'static>; 1] = tint("fn tint() -> vec4<f32> { return vec4<f32>(1.0, 0.0, 0.0, 1.0); }");
        static BLUE: [Source<'static>; 1] = tint("fn tint() -> vec4<f32> { return vec4<f32>(0.0, 0.0, 1.0, 1.0); }");
        static IN_RED: Module<'static> = Module { sources: &RED, ..Module::new("tinted.wgsl", TEXT) };
        static IN_BLUE: Module<'static> = Module { sources: &BLUE, ..Module::new("tinted.wgsl", TEXT) };
        static NOTHING: Interface = Interface { groups: &[], constants: &[] };
        let programs = Programs::new();
        let [red, blue] = [&IN_RED, &IN_BLUE].map(|shader| programs.get(&ProgramDesc::new(shader, &NOTHING)));
        let (red, blue) = (red?, blue?);
        assert!(red.text.contains("1.0, 0.0, 0.0") && blue.text.contains("0.0, 0.0, 1.0"));
        let made = programs.made();
        assert!(made.len() == 2 && [&red, &blue].iter().all(|own| made.iter().any(|other| Arc::ptr_eq(own, other))));
        assert!(Arc::ptr_eq(&red, &programs.get(&ProgramDesc::new(&IN_RED, &NOTHING))?));
        let others = Programs::new();
        assert!(others.made().is_empty());
        assert!(Arc::ptr_eq(&red, &others.get(&ProgramDesc::new(&IN_RED, &NOTHING))?));
        assert_eq!(others.made().len(), 1);
        Ok(())
    }
}
