//! Emission is factor times strength; either or both may be animated.

use glam::Vec3;
use serde_json::{Value, json};

use super::{animate, loaded, posed, with_material};

const FACTOR: &str = "/materials/0/emissiveFactor";
const STRENGTH: &str = "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength";

fn glowing(factor: [f32; 3], strength: f32) -> Value {
    let extension = json!({"KHR_materials_emissive_strength": {"emissiveStrength": strength}});
    json!({"emissiveFactor": factor, "extensions": extension})
}

/// Returns the emission for channels of `pointers`: the factor goes from (0, 1, 0) to (1, 1, 0), the strength from 2 to
/// 6.
fn emission(factor: [f32; 3], strength: f32, pointers: &[&str]) -> Vec3 {
    let mut fixture = with_material(glowing(factor, strength));
    for pointer in pointers {
        let keys: [&[f32]; 2] =
            if *pointer == FACTOR { [&[0.0, 1.0, 0.0], &[1.0, 1.0, 0.0]] } else { [&[2.0], &[6.0]] };
        animate(&mut fixture, pointer, keys);
    }
    let rest = loaded(&fixture);
    assert_eq!(rest.materials[0].emissive, Vec3::from_array(factor) * strength);
    let mut scene = posed(&fixture, 1.0);
    let emission = scene.materials[0].emissive;
    scene.pose(None, 0.0).expect("it can be posed");
    assert_eq!(scene.materials, rest.materials);
    emission
}

/// Emission stays finite, although cubics overshoot and products overflow.
#[test]
fn emission_is_finite() {
    let mut fixture = with_material(glowing([1.0; 3], 1.0));
    let large: [&[f32]; 2] = [&[f32::MAX], &[f32::MAX]];
    animate(&mut fixture, STRENGTH, large);
    animate(&mut fixture, FACTOR, [&[2.0; 3], &[2.0; 3]]);
    assert_eq!(posed(&fixture, 1.0).materials[0].emissive, Vec3::MAX);
    let mut fixture = with_material(glowing([1.0; 3], 1.0));
    animate(&mut fixture, STRENGTH, large);
    // Tangents that take the cubic beyond the f32 range.
    let output = fixture.floats(1, &[0.0, f32::MAX, f32::MAX, -f32::MAX, f32::MAX, 0.0]);
    fixture.set("/animations/0/samplers/0/output", json!(output));
    fixture.set("/animations/0/samplers/0/interpolation", json!("CUBICSPLINE"));
    assert_eq!(posed(&fixture, 1.0).materials[0].emissive, Vec3::MAX);
}

#[test]
fn factor_and_strength_multiply() {
    let rest = [0.25, 0.5, 1.0];
    assert_eq!(emission(rest, 8.0, &[FACTOR]), Vec3::new(4.0, 8.0, 0.0));
    assert_eq!(emission(rest, 8.0, &[STRENGTH]), Vec3::new(1.0, 2.0, 4.0));
    // Both, in either order, for a material that is dark at rest for either reason.
    for (factor, strength) in [(rest, 8.0), (rest, 0.0), ([0.0; 3], 8.0)] {
        assert_eq!(emission(factor, strength, &[FACTOR, STRENGTH]), Vec3::new(2.0, 4.0, 0.0));
        assert_eq!(emission(factor, strength, &[STRENGTH, FACTOR]), Vec3::new(2.0, 4.0, 0.0));
    }
    assert_eq!(emission(rest, 0.0, &[STRENGTH]), Vec3::new(1.0, 2.0, 4.0));
}
