//! The wgpu back end: device, executor, pools, timing, scene import and upload.
//!
//! [`frame`] is what authors of passes see, [`wgpu`](mod@wgpu) executes on a device, [`null`] writes down what it is told.

pub mod backend;
pub mod frame;
pub mod null;
pub mod picture;
mod recorders;
pub mod scene;
pub mod wgpu;

pub use frame::{Frame, Record};
