//! What facts leave out of a frame changes its picture by no more than they say.

mod masks;

type TestResult = Result<(), Box<dyn std::error::Error>>;
