//! Every library function with its domain and error bound, as data.
//!
//! A harness with a device runs three calls per [`Case`] and knows none of the functions:
//! [`Case::shader`] gives a compute shader that evaluates the function over a buffer,
//! [`Case::inputs`] the numbers to put there, and [`Case::check`] judges what came back
//! against the f64 mirror. A test of this crate sees to it that no function is missing.
//!
//! [`all`] is the build in f32. [`half()`] lists the functions that compute in f16 with
//! [`Feature::HALF`](crate::Feature::HALF), with a domain and a bound of their own; a test sees to it that every other
//! function has the same text in both builds.

mod ambient;
mod case;
mod color;
mod domain;
mod froxels;
mod harness;
mod lens;
mod lobes;
mod picture;
mod reflections;
mod screen;
mod shading;
mod shadows;
mod space;
mod table;
mod temporal;
mod transmission;
mod transparency;

pub use case::{Bound, Case, Deviation, Disagreement, Domain, HalfCase};

/// All cases, by file.
pub fn all() -> impl Iterator<Item = &'static Case> {
    let lit = shading::CASES.iter().chain(lobes::CASES).chain(ambient::CASES).chain(froxels::CASES);
    lit.chain(transmission::CASES)
        .chain(transparency::CASES)
        .chain(space::CASES)
        .chain(screen::CASES)
        .chain(lens::CASES)
        .chain(reflections::CASES)
        .chain(shadows::CASES)
        .chain(picture::CASES)
        .chain(color::CASES)
        .chain(temporal::CASES)
}

/// The cases of the functions that compute in half floats with [`Feature::HALF`](crate::Feature::HALF), in that build.
pub fn half() -> impl Iterator<Item = Case> {
    all().filter_map(|case| {
        let HalfCase { parameters, bound } = case.half?;
        Some(Case { parameters, bound, in_half: true, ..*case })
    })
}
