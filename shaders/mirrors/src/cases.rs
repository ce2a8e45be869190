//! Every library function with its domain and error bound, as data.
//!
//! A test on a device compares all functions with three calls per [`Case`]. [`Case::shader`] returns a compute shader
//! that evaluates the function for every element of a buffer. [`Case::inputs`] returns the contents of this buffer.
//! [`Case::check`] compares the results with the f64 mirror. A test of this crate verifies that no function is missing.
//!
//! [`all`] covers the f32 build. [`half()`] lists the functions that compute in f16 with
//! [`Feature::HALF`](framegraph_shaders::Feature::HALF), with their own domains and bounds. A test verifies that all other functions
//! have the same text in both builds.

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

/// Returns all cases, by file.
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

/// Returns the cases of functions that compute in f16 with [`Feature::HALF`](framegraph_shaders::Feature::HALF), for that build.
pub fn half() -> impl Iterator<Item = Case> {
    all().filter_map(|case| {
        let HalfCase { parameters, bound } = case.half?;
        Some(Case { parameters, bound, in_half: true, ..*case })
    })
}
