//! Draw lists, and the arguments of indirect draws: one call draws many consecutive batches.
//!
//! A draw call costs about half a microsecond of CPU time in wgpu. An indirect batch costs only the 20 bytes of its
//! arguments, so long lists are drawn indirectly. Materials without textures are then read from an array, since a bind
//! group per material would end each run.
//!
//! Materials with textures still use bind groups. Helper invocations outside a triangle take part in mip selection,
//! and some drivers (Mesa's llvmpipe) load nothing from buffers for them.

use crate::gpu_scene::upload::MeshRange;
use framegraph_scene::Batch;
use framegraph_wgpu::Gpu;
use wgpu::{Features, Limits};

/// Minimum number of batches of an indirect list. Shorter lists are faster with direct draws.
pub const LEAST_BATCHES: usize = 512;
/// Minimum number of consecutive batches for one indirect call.
pub const LEAST_RUN: usize = 4;

/// Arguments of an indexed indirect draw: index count, instance count, first index, base vertex, first instance
/// (wgpu's `DrawIndexedIndirectArgs`).
pub type Arguments = [u32; 5];

/// Size of [`Arguments`] in bytes.
pub const ARGUMENTS_BYTES: u64 = size_of::<Arguments>() as u64;

/// Batches in draw order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DrawList {
    batches: Vec<Batch>,
    /// Index of the first batch's arguments in the view's array, if the list has arguments.
    first_arguments: Option<u32>,
}

impl DrawList {
    /// Returns the index of the first batch's arguments in the view's array. The others follow. `None` for short
    /// lists.
    #[must_use]
    pub fn first_arguments(&self) -> Option<u32> {
        self.first_arguments
    }

    /// Appends the arguments of the batches to `arguments` if the list is long enough. `mesh` returns the range of an
    /// instance in a level.
    pub(crate) fn argue(&mut self, mesh: impl Fn(u32, u8) -> MeshRange, arguments: &mut Vec<Arguments>) {
        if self.batches.len() >= LEAST_BATCHES {
            self.first_arguments = Some(arguments.len() as u32);
            arguments.extend(self.batches.iter().map(|batch| of_batch(*batch, mesh(batch.instance, batch.level))));
        }
    }
}

impl From<Vec<Batch>> for DrawList {
    fn from(batches: Vec<Batch>) -> Self {
        Self { batches, first_arguments: None }
    }
}

impl std::ops::Deref for DrawList {
    type Target = [Batch];

    fn deref(&self) -> &[Batch] {
        &self.batches
    }
}

impl<'a> IntoIterator for &'a DrawList {
    type Item = &'a Batch;
    type IntoIter = std::slice::Iter<'a, Batch>;

    fn into_iter(self) -> Self::IntoIter {
        self.batches.iter()
    }
}

fn of_batch(batch: Batch, mesh: MeshRange) -> Arguments {
    // Base vertices are in two's complement.
    [mesh.index_count, batch.count, mesh.first_index, mesh.base_vertex as u32, batch.first]
}

/// Returns true if the device supports indirect draws with a first instance.
#[must_use]
pub fn draws_indirectly(gpu: &Gpu) -> bool {
    gpu.device.features().contains(Features::INDIRECT_FIRST_INSTANCE)
}

/// Returns true if the device can bind the material array in addition to the other bindings of shading. This needs
/// eight storage buffers per stage, the WebGPU default.
#[must_use]
pub fn binds_materials(limits: &Limits) -> bool {
    limits.max_storage_buffers_per_shader_stage >= 8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_those_of_the_direct_draw() {
        let mesh = MeshRange { first_index: 30, index_count: 6, base_vertex: -2, ..MeshRange::default() };
        let batch = |first| Batch { instance: 7, first, count: 3, level: 1 };
        let mut long = DrawList::from((0..LEAST_BATCHES as u32).map(batch).collect::<Vec<_>>());
        let mut short = DrawList::from(vec![batch(0); LEAST_BATCHES - 1]);
        let mut arguments = vec![[0; 5]; 2];
        let of = |_, level| if level == 1 { mesh } else { MeshRange::default() };
        short.argue(of, &mut arguments);
        long.argue(of, &mut arguments);
        assert_eq!((short.first_arguments(), long.first_arguments()), (None, Some(2)));
        let own = arguments[2 + 9];
        let expected = wgpu::util::DrawIndexedIndirectArgs {
            index_count: 6,
            instance_count: 3,
            first_index: 30,
            base_vertex: -2,
            first_instance: 9,
        };
        assert_eq!(bytemuck::bytes_of(&own), expected.as_bytes());
    }
}
