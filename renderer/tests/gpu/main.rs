//! End-to-end tests on wgpu's noop device, which validates and draws nothing, and on the available adapter.
//!
//! A test that needs an adapter and finds none prints a line `SKIP: …`, and writes it to the file in
//! `FRAMEGRAPH_SKIP_LOG`.

mod bench;
mod compute;
mod contents;
mod copy;
mod debug;
mod epilogue;
mod failures;
mod frame_loop;
mod history;
mod import;
mod inspect;
mod inspect_random;
mod merge;
mod msaa;
mod parts;
mod placed;
mod poison;
mod promise;
mod random;
mod raster;
mod refusals;
mod reload;
mod remote;
mod resolve;
mod split_draws;
mod steady;
mod submission;
mod threads;
mod timing;
mod trace;
