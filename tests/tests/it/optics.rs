//! Thin films, dispersion and diffuse transmission, compared with brute-force integration.

mod film;
mod slab;
mod through;

use framegraph_scene::environment::EquirectMap;
use framegraph_scene::{Environment, Material};
use glam::{DVec3, Vec3};
use std::error::Error;
use tests::measure::board::Seen;

type TestResult = Result<(), Box<dyn Error>>;

fn black(roughness: f32) -> Material {
    Material::dielectric("black", Vec3::ZERO, roughness)
}

/// Creates light that is linear in the direction, which three bands of spherical harmonics represent exactly.
fn gradient(of: impl Fn(DVec3) -> DVec3) -> Result<Environment, Box<dyn Error>> {
    let map = EquirectMap::from_fn(128, 64, of);
    Ok(Environment { map, name: "gradient".into(), ..Environment::uniform(DVec3::ONE)? })
}

/// Checks a color within a relative or an absolute tolerance.
fn near(name: &str, seen: &Seen, expected: DVec3, relative: f64, absolute: f64) {
    let apart = (seen.nits - expected).abs();
    let allowed = expected.abs() * relative + DVec3::splat(absolute);
    assert!(apart.cmple(allowed).all(), "{name}: {} for {expected}", seen.nits);
}
