//! What the tests across crates share: comparing pictures, the README's examples as tests.

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

/// The examples of the README, run as doc tests.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;

/// The guides of `docs/guide`, run as doc tests.
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
    #[doc = include_str!("../../docs/guide/threads.md")]
    pub struct Threads;
}

/// Whether there is an adapter to run `test` on; says that it is skipped where there is none.
pub fn has_adapter(test: &str) -> bool {
    let opened = framegraph_wgpu::Gpu::open(&framegraph_wgpu::AdapterRequest::from_env());
    if let Err(error) = &opened {
        test_report::skip(test, &error.to_string());
    }
    opened.is_ok()
}
