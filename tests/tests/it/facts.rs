//! Feature culling changes pictures by no more than its error bounds.

mod late;
mod masks;
mod measured;
mod pictures;
mod random;
mod rules;
mod settings;
mod table;

type TestResult = Result<(), Box<dyn std::error::Error>>;
