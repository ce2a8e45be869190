//! A render graph in an engine that has everything already: the teaching program `custom_pass`. Its `README.md` walks
//! through the files in the order in which they are best read.

pub mod app;
pub mod blur;
pub mod compose;
pub mod engine;
pub mod frame;
pub mod outline;
pub mod shapes;
