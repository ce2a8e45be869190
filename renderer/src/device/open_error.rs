//! Errors of opening a device.

use crate::device::adapter::{AdapterRequest, describe};
use crate::device::format::joined;
use wgpu::{AdapterInfo, Backends};

/// Error: no device could be opened.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum OpenError {
    /// `WGPU_BACKEND` contains words that name no graphics API.
    #[error("WGPU_BACKEND: {} names no graphics API; use vulkan, metal, dx12, gl or noop, separated by commas", quoted(.words))]
    UnknownBackend {
        /// The unknown words.
        words: Vec<String>,
    },
    /// The program was built without the requested graphics APIs.
    #[error(
        "the program was built without the requested graphics APIs ({}), only with {}; build `framegraph-wgpu` with one of the \
         features `vulkan`, `metal`, `dx12`, `gles`, or `noop` for a device that draws nothing",
        joined(.requested.iter_names()), joined(.built.iter_names())
    )]
    NotBuilt {
        /// Requested APIs.
        requested: Backends,
        /// APIs that are built in and exist on this system.
        built: Backends,
    },
    /// No adapter fulfills the request.
    #[error(
        "no adapter for {}{}; found: {}; install a driver (Mesa's llvmpipe renders without a GPU), or change WGPU_BACKEND and \
         WGPU_ADAPTER_NAME",
        joined(.requested.backends.iter_names()),
        .requested.name.as_ref().map(|n| format!(" with `{n}` in its name")).unwrap_or_default(),
        listed(.found.iter().map(describe))
    )]
    NoAdapter {
        /// The request.
        requested: AdapterRequest,
        /// All adapters that were found.
        found: Vec<AdapterInfo>,
    },
    /// wgpu found no adapter that fits the surface.
    #[error("no adapter can be used: {reason}; install a driver, or enable a graphics API of wgpu")]
    NoneFits {
        /// Reason given by wgpu.
        reason: String,
    },
    /// Every suitable adapter failed to open a device.
    #[error("no adapter could open a device: {}", listed(.refusals.iter().map(|(info, why)| format!("{}: {why}", describe(info)))))]
    Refused {
        /// Adapters with the driver's reasons.
        refusals: Vec<(AdapterInfo, String)>,
    },
}

impl std::fmt::Debug for OpenError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

fn quoted(words: &[String]) -> String {
    words.iter().map(|word| format!("{word:?}")).collect::<Vec<_>>().join(", ")
}

/// Joins strings with semicolons.
fn listed(words: impl Iterator<Item = String>) -> String {
    let all: Vec<_> = words.collect();
    if all.is_empty() { "none".to_owned() } else { all.join("; ") }
}

impl AdapterRequest {
    /// Fails if `WGPU_BACKEND` contained unknown words. APIs that are not built in are accepted here.
    ///
    /// # Errors
    /// Fails with [`OpenError::UnknownBackend`].
    pub fn check(&self) -> Result<(), OpenError> {
        let words = self.unknown.clone();
        if words.is_empty() { Ok(()) } else { Err(OpenError::UnknownBackend { words }) }
    }
}
