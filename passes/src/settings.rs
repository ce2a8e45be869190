//! Building blocks of settings: tables of fields, options given as `key=value`, the precision of shading, and the frame
//! index.
//!
//! This folder uses no other one of this crate.

pub mod field;
pub mod frame_index;
pub mod key_value;
pub mod place;
pub mod precision;
pub mod table;
