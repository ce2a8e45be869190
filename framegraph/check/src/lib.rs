//! Tools to test plans of `framegraph`, for its own tests and for engines that compile plans in their CI.
//!
//! - [`Budget`]: limits on loads, stores, steps and bytes, with errors that name the responsible decisions.
//! - [`golden`]: committed texts of plans, with a diff.
//! - [`check()`]: an independent checker of plans, the *oracle*. It shares no code with the compiler.
//! - [`generate`]: random graphs, devices and options.
//! - [`mutation`]: broken plans that [`check()`] must report.
//! - [`planted`]: packing problems with a known optimum.
//! - [`csv`]: published instances of memory packing problems.
//!
//! ```
//! use framegraph::{Caps, Options, Plan, Scratch, compile};
//! use framegraph_check::generate::{self, Entropy, Profile};
//! use framegraph_check::{check, check::examine};
//!
//! let graph = generate::graph(&mut Entropy::seeded(7), &Profile::default());
//! let mut plan = Plan::new();
//! compile(&graph, &Caps::tiler(), &Options::for_frame(64, 32), &mut Scratch::new(), &mut plan)?;
//! assert_eq!(check(&plan), Ok(()));
//! assert!(examine(&plan).wastes.is_empty(), "no load or store is unnecessary");
//! # Ok::<(), framegraph::CompileErrors>(())
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod budget;
pub mod check;
pub mod generate;
pub mod golden;
pub mod mutation;

#[doc(inline)]
pub use budget::Budget;
#[doc(inline)]
pub use check::check;
pub use framegraph_pack::{csv, planted};
