//! The lab: what each approximation of the frame errs by, and what it costs, in one schema.
//!
//! A [`technique::Technique`] is a choice with its options, its truth and its metric; [`techniques`] has those of the standard
//! frame, and a pass from outside brings its own. [`run`] measures them into a [`record::Record`], which
//! [`markdown`] and [`html`] show. [`budget`] measures what frames within a budget are chosen from, and how they turn out. The program is `accuracy`.

pub mod answers;
pub mod budget;
pub mod html;
pub mod markdown;
pub mod record;
pub mod run;
pub mod statistics;
pub mod studio;
pub mod technique;
pub mod techniques;
