//! Measurement of the error and cost of each approximation of the frame.
//!
//! A [`technique::Technique`] is a setting with its options, reference and metric. [`techniques`] has those of the
//! standard frame, and external passes can add their own. [`run`] measures them into a [`record::Record`], which
//! [`markdown`] and [`html`] display. [`budget`] measures options as parts of one frame and verifies the chosen
//! settings. The program is `accuracy`.

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
pub mod temporal;
