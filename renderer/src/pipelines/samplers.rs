//! Samplers, made once for each set of choices.

use crate::cache::Cache;
use crate::hash::Keyed;
use std::convert::Infallible;
use std::hash::BuildHasher;
use wgpu::{AddressMode, CompareFunction, Device, FilterMode, MipmapFilterMode, Sampler, SamplerDescriptor};

/// How a texture is sampled. The defaults clamp and filter nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SamplerDesc {
    /// How coordinates outside of 0…1 are wrapped, in u, v and w.
    pub address: [AddressMode; 3],
    /// Filter within a level, where the texture is magnified and where it is minified.
    pub filter: [FilterMode; 2],
    /// Filter between mip levels.
    pub mipmap: MipmapFilterMode,
    /// Compares with a reference instead of returning the value (shadow maps).
    pub compare: Option<CompareFunction>,
    /// Samples along the axis of anisotropy, 1 to 16; above 1 all filters must be linear.
    pub anisotropy: u16,
}

impl SamplerDesc {
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

impl Default for SamplerDesc {
    fn default() -> Self {
        Self::NEAREST
    }
}

/// All samplers that were asked for; there are few, and none is ever dropped.
#[derive(Debug, Default)]
pub(crate) struct SamplerCache(Cache<SamplerDesc, Sampler>);

impl SamplerCache {
    /// Samplers made since the beginning.
    pub(crate) fn created(&self) -> u64 {
        self.0.counts().created
    }

    /// Begins a frame.
    pub(crate) fn begin_frame(&mut self) {
        self.0.begin_frame(u64::MAX);
    }

    /// The sampler of that description.
    pub(crate) fn get(&self, device: &Device, desc: SamplerDesc) -> Sampler {
        let hash = Keyed::default().hash_one(desc);
        let made = self.0.get::<Infallible>(hash, |known| *known == desc, || Ok((desc, create(device, desc))));
        made.unwrap_or_else(|never| match never {})
    }
}

fn create(device: &Device, desc: SamplerDesc) -> Sampler {
    let SamplerDesc { address, filter, mipmap, compare, anisotropy } = desc;
    device.create_sampler(&SamplerDescriptor {
        label: Some(&format!("{filter:?} {mipmap:?} {address:?} {compare:?}")),
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
    use crate::device::gpu::{Gpu, OpenError};

    #[test]
    fn one_sampler_for_one_description() -> Result<(), OpenError> {
        let gpu = Gpu::noop()?;
        let cache = SamplerCache::default();
        let nearest = cache.get(&gpu.device, SamplerDesc::NEAREST);
        assert_eq!(cache.get(&gpu.device, SamplerDesc::default()), nearest);
        let all = [SamplerDesc::LINEAR, SamplerDesc::REPEAT, SamplerDesc::SHADOW];
        assert!(
            all.into_iter()
                .all(|s| { gpu.guard("a sampler", || cache.get(&gpu.device, s)).is_ok_and(|s| s != nearest) })
        );
        Ok(())
    }
}
