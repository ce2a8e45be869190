//! Cache of samplers by their descriptions.

use crate::cache::Cache;
use crate::hash::KeyHashBuilder;
use std::convert::Infallible;
use std::hash::BuildHasher;
use wgpu::{AddressMode, CompareFunction, Device, FilterMode, MipmapFilterMode, Sampler, SamplerDescriptor};

/// Description of a sampler. The default clamps to the edge and uses nearest filtering.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SamplerDesc {
    /// Address modes for u, v and w outside of 0…1.
    pub address: [AddressMode; 3],
    /// Magnification and minification filter.
    pub filter: [FilterMode; 2],
    /// Filter between mip levels.
    pub mipmap: MipmapFilterMode,
    /// Comparison function, for shadow maps; `None` returns the sampled value.
    pub compare: Option<CompareFunction>,
    /// Maximum anisotropy, 1 to 16. Values above 1 require linear filters.
    pub anisotropy: u16,
}

impl SamplerDesc {
    /// Nearest texel of the nearest mip level, clamped to the edge.
    pub const NEAREST: Self = Self {
        address: [AddressMode::ClampToEdge; 3],
        filter: [FilterMode::Nearest; 2],
        mipmap: MipmapFilterMode::Nearest,
        compare: None,
        anisotropy: 1,
    };

    /// Trilinear filtering, clamped to the edge.
    pub const LINEAR: Self =
        Self { filter: [FilterMode::Linear; 2], mipmap: MipmapFilterMode::Linear, ..Self::NEAREST };

    /// Trilinear filtering, repeated.
    pub const REPEAT: Self = Self { address: [AddressMode::Repeat; 3], ..Self::LINEAR };

    /// Linear comparison sampler for shadow maps with reversed depth: returns 1 where the reference is nearer or equal.
    pub const SHADOW: Self =
        Self { compare: Some(CompareFunction::GreaterEqual), mipmap: MipmapFilterMode::Nearest, ..Self::LINEAR };
}

impl Default for SamplerDesc {
    fn default() -> Self {
        Self::NEAREST
    }
}

/// Cache of samplers. They are few and never dropped.
#[derive(Debug, Default)]
pub(crate) struct SamplerCache(Cache<SamplerDesc, Sampler>);

impl SamplerCache {
    /// Returns the number of samplers created.
    pub(crate) fn created(&self) -> u64 {
        self.0.counts().created
    }

    /// Begins a frame.
    pub(crate) fn begin_frame(&mut self) {
        self.0.begin_frame(u64::MAX);
    }

    /// Returns the sampler with this description.
    pub(crate) fn get(&self, device: &Device, desc: SamplerDesc) -> Sampler {
        let hash = KeyHashBuilder::default().hash_one(desc);
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
    use crate::device::gpu::Gpu;
    use crate::device::open_error::OpenError;

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
