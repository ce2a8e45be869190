//! Helpers of examples and tests: a device with validation layers, pipelines from WGSL, and readback. They favor
//! brevity over speed: each draw creates what it needs, and objects live until [`Kit::reset`].

mod copies;
mod device;
mod draw;
mod imports;
mod kit;
mod memory;
mod mock;
mod raster;
mod spirv;

pub use device::{DeviceRequest, OpenError, TestDevice};
pub use draw::{Bound, DepthTest, Dispatch, Draw};
pub use imports::{WORD, imports, imports_again};
pub use kit::Kit;
pub use memory::Part;
pub use mock::Mock;
pub use spirv::{InputAttachment, spirv};
