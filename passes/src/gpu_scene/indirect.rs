//! Lists of draws, and the arguments of those that are drawn indirectly: one call draws a run of batches.
//!
//! What a call takes the CPU in wgpu is half a microsecond, whatever it draws. Indirectly a batch costs the twenty bytes of its
//! arguments, so long lists of small batches are drawn so. Materials without textures then come from an array, since a bind group for
//! each would end every run. Those with textures are bound: fragments that a triangle does not cover take part in choosing mip levels,
//! and some drivers (Mesa's llvmpipe) load nothing from buffers for them.

use crate::gpu_scene::upload::MeshRange;
use framegraph_scene::Batch;
use framegraph_wgpu::Gpu;
use wgpu::{Features, Limits};

/// Batches of which a list has arguments: fewer take less time than their arguments and the variant of the shader would.
pub const LEAST_BATCHES: usize = 512;
/// Batches in a row that are worth a call of their own.
pub const LEAST_RUN: usize = 4;

/// The arguments of an indexed indirect draw: indices, instances, first index, base vertex, first instance (wgpu's
/// `DrawIndexedIndirectArgs`).
pub type Arguments = [u32; 5];

/// Bytes of one.
pub const ARGUMENTS_BYTES: u64 = size_of::<Arguments>() as u64;

/// Batches that are drawn in this order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DrawList {
    batches: Vec<Batch>,
    /// Where the arguments of its batches begin among the view's; none where they have none.
    first_arguments: Option<u32>,
}

impl DrawList {
    /// Where the arguments of its batches begin among the view's, one after another; none where it is too short to have any.
    #[must_use]
    pub fn first_arguments(&self) -> Option<u32> {
        self.first_arguments
    }

    /// Appends the arguments of its batches to `arguments`, where it is long enough. `mesh` is that of an instance in a
    /// level.
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
    // Base vertices are two's complements.
    [mesh.index_count, batch.count, mesh.first_index, mesh.base_vertex as u32, batch.first]
}

/// Whether the device draws batches indirectly: they begin at instances of their own.
#[must_use]
pub fn draws_indirectly(gpu: &Gpu) -> bool {
    gpu.device.features().contains(Features::INDIRECT_FIRST_INSTANCE)
}

/// Whether the device binds an array of materials beside all else that shading binds: eight storage buffers a stage, as WebGPU
/// asks of every device.
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
