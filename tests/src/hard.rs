//! The shader library at inputs that break arithmetic, the rows of them, and what each guard in it is good for.
//!
//! [`probe`] says what is asked of a function and what must come of it, [`judge`] asks the device, [`guard`] finds what
//! holds values back and makes texts without it, [`strict`] reads texts as other drivers may, [`rows`] says where each kind of hard input is tested. The program
//! `hard_cases` prints `docs/hard-cases.md`; tests find its rows again.

pub mod document;
pub mod guard;
pub mod judge;
pub mod probe;
mod probes;
pub mod rows;
pub mod strict;
