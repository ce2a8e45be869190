//! Pipeline cache on disk: wgpu's pipeline cache data with a checksum and the name of the device.

use crate::device::gpu::Gpu;
use crate::hash::fnv;
use std::fmt;
use wgpu::{Features, PipelineCache, PipelineCacheDescriptor};

/// Error: pipeline cache data of an earlier run cannot be used.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum PipelineCacheError {
    /// The data are damaged.
    #[error("the pipeline cache is damaged: the checksum of its {found} bytes is wrong; delete the file")]
    Damaged {
        /// Size of the data in bytes.
        found: usize,
    },
    /// The data belong to another device or driver.
    #[error("the pipeline cache belongs to {theirs}, not to {ours}; delete the file, or keep one per device")]
    OtherDevice {
        /// Name of the device and driver that wrote the data.
        theirs: String,
        /// Name of this device and driver.
        ours: String,
    },
}

impl fmt::Debug for PipelineCacheError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// Magic number. It is followed by checksum, key length, key and data.
const MAGIC: &[u8; 8] = b"FGPIPES1";
/// Bytes of magic number, checksum and key length.
const HEAD_BYTES: usize = 8 + 8 + 4;

/// Creates a pipeline cache filled with `earlier` data. `None` if the device has no pipeline caches. The second value
/// says why `earlier` was not used.
#[allow(unsafe_code, reason = "wgpu cannot verify the data")]
pub(crate) fn open_cache(gpu: &Gpu, earlier: Option<&[u8]>) -> (Option<PipelineCache>, Option<PipelineCacheError>) {
    if !gpu.device.features().contains(Features::PIPELINE_CACHE) {
        return (None, None);
    }
    let (data, refused) = match earlier.map(|bytes| unpack(&key(gpu), bytes)) {
        Some(Ok(data)) => (Some(data), None),
        Some(Err(error)) => (None, Some(error)),
        None => (None, None),
    };
    let descriptor = PipelineCacheDescriptor { label: Some("pipelines"), data, fallback: true };
    // SAFETY: wgpu requires data that `PipelineCache::get_data` returned. `unpack` only accepts data that `pack` wrote.
    // The checksum detects damage, the key other devices and drivers, and wgpu checks its own header again. A forged
    // file with a valid checksum is trusted like the program's own files.
    let cache = unsafe { gpu.device.create_pipeline_cache(&descriptor) };
    (Some(cache), refused)
}

/// Returns the data of a cache for a later [`open_cache`].
pub(crate) fn cache_bytes(gpu: &Gpu, cache: &PipelineCache) -> Option<Vec<u8>> {
    Some(pack(&key(gpu), &cache.get_data()?))
}

/// Returns a name of device and driver, including the driver's version.
fn key(gpu: &Gpu) -> String {
    let info = gpu.info();
    let known = wgpu::util::pipeline_cache_key(info);
    format!("{} {} {}", known.unwrap_or_default(), info.driver, info.driver_info)
}

fn pack(key: &str, data: &[u8]) -> Vec<u8> {
    let mut body = (key.len() as u32).to_le_bytes().to_vec();
    body.extend_from_slice(key.as_bytes());
    body.extend_from_slice(data);
    let checksum = fnv(body.iter().copied());
    [MAGIC, &checksum.to_le_bytes()[..], &body].concat()
}

fn unpack<'b>(ours: &str, bytes: &'b [u8]) -> Result<&'b [u8], PipelineCacheError> {
    let damaged = || PipelineCacheError::Damaged { found: bytes.len() };
    let (head, rest) = bytes.split_at_checked(HEAD_BYTES).ok_or_else(damaged)?;
    let (checksum, body) = (&head[8..16], &bytes[16..]);
    if &head[..8] != MAGIC || fnv(body.iter().copied()).to_le_bytes() != *checksum {
        return Err(damaged());
    }
    let length = u32::from_le_bytes([head[16], head[17], head[18], head[19]]) as usize;
    let (theirs, data) = rest.split_at_checked(length).ok_or_else(damaged)?;
    if theirs != ours.as_bytes() {
        let theirs = String::from_utf8_lossy(theirs).into_owned();
        return Err(PipelineCacheError::OtherDevice { theirs, ours: ours.to_owned() });
    }
    Ok(data)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_intact_data_of_this_device_is_accepted() {
        let kept = pack("card 1.0", b"machine code");
        assert_eq!(unpack("card 1.0", &kept), Ok(&b"machine code"[..]));
        let other = unpack("card 1.1", &kept);
        assert!(matches!(other, Err(PipelineCacheError::OtherDevice { .. })), "{other:?}");
        for at in 0..kept.len() {
            let mut damaged = kept.clone();
            damaged[at] ^= 0x10;
            assert_eq!(
                unpack("card 1.0", &damaged),
                Err(PipelineCacheError::Damaged { found: kept.len() }),
                "byte {at}"
            );
            assert_eq!(unpack("card 1.0", &kept[..at]), Err(PipelineCacheError::Damaged { found: at }), "{at} bytes");
        }
    }
}
