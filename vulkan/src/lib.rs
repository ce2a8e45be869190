#![cfg_attr(docsrs, feature(doc_cfg))]
#![doc = include_str!("../README.md")]

mod begin;
mod clear;
mod compile;
mod convert;
mod cx;
mod driver;
mod error;
mod executor;
mod features;
mod gpu;
mod imports;
mod lanes;
mod layouts;
mod limits;
mod owners;
mod prepared;
mod render_pass;
mod resources;
mod run;
mod shape;
mod subpass;
#[cfg(feature = "testing")]
pub mod testing;
mod timing;
mod views;

pub use ash;
pub use convert::vk_format;
pub use cx::{BoundBuffer, BoundImage, Cx, RecordError};
pub use error::Error;
#[cfg(feature = "testing")]
pub use executor::stream;
pub use executor::{Executor, ExecutorOptions, Exported};
pub use features::{DeviceFeatures, Synchronization};
pub use gpu::{DeviceQueue, Gpu, GpuDesc};
pub use imports::Imports;
pub use resources::MemoryReport;
pub use views::ViewShape;

/// The guide in `docs/guide`, run as a doc test. Skipped because "the program needs a Vulkan device" if there is none.
#[cfg(doctest)]
#[doc = include_str!("../../docs/guide/vulkan.md")]
pub struct Guide;
