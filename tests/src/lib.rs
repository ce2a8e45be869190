//! Helpers of the tests across packages: comparison of pictures, and documentation examples as tests.

pub mod compare;
pub mod cube_file;
pub mod executors;
pub mod files;
pub mod filtered;
pub mod fuzz;
pub mod hard;
pub mod lab;
pub mod lookup;
pub mod measure;
pub mod mirror;
pub mod reference;
pub mod soak;
pub mod stage;

/// Examples of the README, run as doc tests.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;

/// Guides in `docs/guide`, run as doc tests.
#[cfg(doctest)]
mod guide {
    #[doc = include_str!("../../docs/guide/own-device.md")]
    pub struct OwnDevice;
    #[doc = include_str!("../../docs/guide/buffers-and-compute.md")]
    pub struct BuffersAndCompute;
    #[doc = include_str!("../../docs/guide/mip-chains.md")]
    pub struct MipChains;
    #[doc = include_str!("../../docs/guide/history-and-resize.md")]
    pub struct HistoryAndResize;
    #[doc = include_str!("../../docs/guide/two-views.md")]
    pub struct TwoViews;
    #[doc = include_str!("../../docs/guide/files-and-plugins.md")]
    pub struct FilesAndPlugins;
    #[doc = include_str!("../../docs/guide/counts.md")]
    pub struct Counts;
    #[doc = include_str!("../../docs/guide/plans-in-ci.md")]
    pub struct PlansInCi;
    #[doc = include_str!("../../docs/guide/standard-frame.md")]
    pub struct StandardFrame;
    #[doc = include_str!("../../docs/guide/migrating.md")]
    pub struct Migrating;
    #[doc = include_str!("../../docs/guide/threads.md")]
    pub struct Threads;
}

/// Returns true if an adapter exists. Otherwise reports `test` as skipped.
pub fn has_adapter(test: &str) -> bool {
    let opened = framegraph_wgpu::Gpu::open(&framegraph_wgpu::AdapterRequest::from_env());
    if let Err(error) = &opened {
        test_report::skip(test, &error.to_string());
    }
    opened.is_ok()
}
