//! The strip: a skin, a morph target and an animation.

use glam::DVec3;

use super::{bytes, ordered};

/// Returns positions in world axes at a time of the animation.
fn posed(name: &str, time_s: f64) -> Vec<DVec3> {
    let mut scene = ordered(&bytes(name), name);
    scene.pose(Some(0), time_s).expect("it has an animation");
    let instance = &scene.instances[0];
    let positions = &scene.meshes[instance.mesh.index()].positions;
    positions.iter().map(|p| instance.world_from_model.transform_point3(p.as_dvec3())).collect()
}

/// The files differ by quantization. Draco uses 16 bits for positions over 2 m. The filters of meshopt use 15-bit
/// mantissas for positions below 4 m and for the target. Rotations have 14 bits and affect 1 m of the strip.
#[test]
fn skins_and_morph_targets_of_compressed_meshes_move_alike() {
    for (name, allowed) in [("strip_draco", 2.0 / 65535.0), ("strip_meshopt", 1e-3)] {
        for time_s in [0.0, 0.375, 1.0] {
            let (raw, found) = (posed("strip_raw", time_s), posed(name, time_s));
            assert_eq!((raw.len(), found.len()), (18, 18), "{name}");
            let off = raw.iter().zip(&found).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max);
            assert!(off <= allowed, "{name} after {time_s} s: {off:.2e} m off");
            // The second keyframe bends the strip, and the target bulges it.
            let moved = raw.iter().zip(posed("strip_raw", 0.0)).map(|(a, b)| (*a - b).length()).fold(0.0, f64::max);
            assert!(time_s == 0.0 || moved > 0.1, "{moved}");
            assert!(raw.iter().any(|p| p.z > 0.3), "the target adds up to 0.5 m");
        }
    }
}
