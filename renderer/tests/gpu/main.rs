//! Frames executed end to end: on wgpu's Noop device, which validates and draws nothing, and on the adapter that there is.
//!
//! A test that needs an adapter and finds none says so: a line `SKIP: …` on standard output, and one in the file that
//! `FRAMEGRAPH_SKIP_LOG` names.

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
mod random;
mod raster;
mod refusals;
mod resolve;
mod steady;
mod submission;
mod threads;
mod timing;
mod trace;
