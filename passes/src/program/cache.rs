//! Programs by what they were made from, kept from frame to frame.

use super::{Program, ProgramDesc};
use crate::error::PassError;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, PoisonError, RwLock};

/// The programs of a world's passes, each made when it is first asked for: which effects a shader ends with is the plan's
/// choice. What it is made of is static, so what another `Programs` of the process has made is taken and not made again.
#[derive(Debug, Default)]
pub struct Programs {
    known: Table,
}

/// Programs of this process.
static MADE: LazyLock<Table> = LazyLock::new(Table::default);

/// Programs by the hashes of their descriptions.
#[derive(Debug, Default)]
struct Table(RwLock<HashMap<u64, Vec<Known>>>);

/// A program with the description that it was made from.
#[derive(Debug)]
struct Known {
    addresses: Box<[(usize, usize)]>,
    program: Arc<Program>,
}

impl Table {
    /// The program of a description that has that hash; what `make` returns, where there is none.
    fn get(
        &self,
        desc: &ProgramDesc<'_>,
        hash: u64,
        make: impl FnOnce() -> Result<Arc<Program>, PassError>,
    ) -> Result<Arc<Program>, PassError> {
        let same = |known: &&Known| known.addresses.iter().copied().eq(desc.addresses());
        // A panic in another thread leaves the table as it was.
        let known = self.0.read().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = known.get(&hash).and_then(|bucket| bucket.iter().find(same)) {
            return Ok(Arc::clone(&known.program));
        }
        drop(known);
        let program = make()?;
        let mut known = self.0.write().unwrap_or_else(PoisonError::into_inner);
        let bucket = known.entry(hash).or_default();
        // Another thread may have been quicker; all are to hold one program.
        if let Some(known) = bucket.iter().find(same) {
            return Ok(Arc::clone(&known.program));
        }
        bucket.push(Known { addresses: desc.addresses().collect(), program: Arc::clone(&program) });
        Ok(program)
    }
}

impl Programs {
    /// None yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// The program of that description.
    ///
    /// # Errors
    /// As [`Program::new`].
    pub fn get(&self, desc: &ProgramDesc<'_>) -> Result<Arc<Program>, PassError> {
        let hash = desc.hash();
        self.known.get(desc, hash, || MADE.get(desc, hash, || Program::new(desc).map(Arc::new)))
    }

    /// All that were made so far, ordered by the hashes of their shaders: for who reloads them
    /// ([`Executor::reload_shader`](framegraph_wgpu::Executor::reload_shader)).
    pub fn made(&self) -> Vec<Arc<Program>> {
        let known = self.known.0.read().unwrap_or_else(PoisonError::into_inner);
        let mut made: Vec<_> = known.values().flatten().map(|known| Arc::clone(&known.program)).collect();
        made.sort_by_key(|program| program.shader().hash());
        made
    }
}

/// Passes that need no more than programs are executed with them alone.
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

    /// Two shaders of one text that import different files are two programs.
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
