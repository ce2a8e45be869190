//! The adapter that tests of this room draw with.

use framegraph_wgpu::{AdapterRequest, Gpu};

/// A working device; `None`, which is counted as a skip of `test`, on a machine without any.
pub(crate) fn working(test: &str) -> Option<Gpu> {
    match Gpu::open(&AdapterRequest::from_env()) {
        Ok(gpu) => {
            test_report::adapter(&gpu.describe());
            Some(gpu)
        }
        Err(error) => {
            test_report::skip(test, &error.to_string());
            None
        }
    }
}
