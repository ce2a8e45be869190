//! What facts leave out of a frame changes its picture by no more than they say.

mod late;
mod masks;
mod measured;
mod pictures;
mod random;
mod rules;
mod settings;
mod table;

type TestResult = Result<(), Box<dyn std::error::Error>>;
