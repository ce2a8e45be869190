//! Teaching program `custom_pass`: a render graph in an existing engine. `README.md` lists the files in reading order.

pub mod app;
pub mod blur;
pub mod compose;
pub mod engine;
pub mod frame;
pub mod outline;
pub mod shapes;
