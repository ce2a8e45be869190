//! Samplers, made once for each set of choices.

use super::hash::Keyed;
use std::collections::HashMap;
use wgpu::{AddressMode, CompareFunction, Device, FilterMode, MipmapFilterMode, Sampler, SamplerDescriptor};

/// How a texture is sampled. The defaults clamp and filter nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SamplerShape {
    /// What lies beyond the edges, in u, v and w.
    pub address: [AddressMode; 3],
    /// Magnified, minified.
    pub filter: [FilterMode; 2],
    /// Between levels.
    pub mipmap: MipmapFilterMode,
    /// Compares with a reference instead of returning the value (shadow maps).
    pub compare: Option<CompareFunction>,
    /// Samples along the axis of anisotropy, 1 to 16; above 1 all filters must be linear.
    pub anisotropy: u16,
}

impl SamplerShape {
    /// The nearest texel of the nearest level, clamped to the edge.
    pub const NEAREST: Self = Self {
        address: [AddressMode::ClampToEdge; 3],
        filter: [FilterMode::Nearest; 2],
        mipmap: MipmapFilterMode::Nearest,
        compare: None,
        anisotropy: 1,
    };

    /// Linear in all three directions, clamped to the edge.
    pub const LINEAR: Self =
        Self { filter: [FilterMode::Linear; 2], mipmap: MipmapFilterMode::Linear, ..Self::NEAREST };

    /// Linear in all three directions, repeated.
    pub const REPEAT: Self = Self { address: [AddressMode::Repeat; 3], ..Self::LINEAR };

    /// Linear comparison for shadow maps with reversed depth: lit where the reference is nearer or equal.
    pub const SHADOW: Self =
        Self { compare: Some(CompareFunction::GreaterEqual), mipmap: MipmapFilterMode::Nearest, ..Self::LINEAR };
}

impl Default for SamplerShape {
    fn default() -> Self {
        Self::NEAREST
    }
}

/// All samplers that were asked for; there are few, and none is ever dropped.
#[derive(Debug, Default)]
pub struct SamplerCache {
    samplers: HashMap<SamplerShape, Sampler, Keyed>,
}

impl SamplerCache {
    /// Samplers made since the beginning.
    pub fn created(&self) -> u64 {
        self.samplers.len() as u64
    }

    /// The sampler of that shape.
    pub fn get(&mut self, device: &Device, shape: SamplerShape) -> Sampler {
        self.samplers.entry(shape).or_insert_with(|| create(device, shape)).clone()
    }
}

fn create(device: &Device, shape: SamplerShape) -> Sampler {
    let SamplerShape { address, filter, mipmap, compare, anisotropy } = shape;
    device.create_sampler(&SamplerDescriptor {
        label: None,
        address_mode_u: address[0],
        address_mode_v: address[1],
        address_mode_w: address[2],
        mag_filter: filter[0],
        min_filter: filter[1],
        mipmap_filter: mipmap,
        compare,
        anisotropy_clamp: anisotropy,
        ..Default::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::device::{Gpu, OpenError};

    #[test]
    fn one_sampler_for_one_shape() -> Result<(), OpenError> {
        let gpu = Gpu::noop()?;
        let mut cache = SamplerCache::default();
        let nearest = cache.get(&gpu.device, SamplerShape::NEAREST);
        assert_eq!(cache.get(&gpu.device, SamplerShape::default()), nearest);
        let all = [SamplerShape::LINEAR, SamplerShape::REPEAT, SamplerShape::SHADOW];
        assert!(
            all.into_iter()
                .all(|s| { gpu.guard("a sampler", || cache.get(&gpu.device, s)).is_ok_and(|s| s != nearest) })
        );
        Ok(())
    }
}
