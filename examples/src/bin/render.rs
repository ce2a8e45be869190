//! Renders a scene headless.
fn main() {}
