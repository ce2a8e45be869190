//! The standard frame with a pass inserted and a stage replaced: the teaching program `stages`. See its `README.md`.

pub mod fog;
pub mod frame;
pub mod sharpen;
