//! Views of a scene: camera, exposure, sun and lights as the shaders read them, and what is drawn.
//!
//! Positions are sent relative to the eye, subtracted in double precision, so that a scene a thousand kilometers from its
//! origin does not jitter. Lights are multiplied by the exposure here, in f32: what the shaders see fits half floats.
//!
//! A frame may have several views ([`Views`]).

mod camera_view;
mod gpu_view;

pub use camera_view::{Background, BackgroundUniforms, CameraView, ViewSettings};
pub use gpu_view::{GpuView, ViewId, Views};
