//! Distances without a slice: the design's hard case 57, for the shader's functions in both builds.

use super::{PLAIN, TestResult, punctual_lights};
use crate::stage::{gpu, precisions};
use framegraph_passes::Precision;
use framegraph_passes::gpu_scene::punctual::{FroxelSettings, LightSearch};
use framegraph_shader_mirrors::cases::{Case, Domain, all};
use tests::measure::lights::Night;
use tests::mirror;

/// Distance, scale and offset of slices, their number; then pixel, tiles per pixel, tiles across and down.
const WORDS: &[Domain] = &[Domain::Vector(9, 0.0, 1.0)];

/// Distances before every slice, and NaN of any sign and payload.
const NOWHERE: [f32; 9] = [
    0.0,
    -0.0,
    -1e-3,
    f32::MIN,
    f32::NEG_INFINITY,
    f32::MIN_POSITIVE,
    f32::from_bits(0x7fc0_0000),
    f32::from_bits(0xffc0_0000),
    f32::from_bits(0x7f80_0001),
];

/// Distances beyond every slice.
const BEYOND: [f32; 3] = [1e20, f32::MAX, f32::INFINITY];

/// Case 57: points at, behind or directly before the eye, and NaN, are in the first slice; infinity is in the last.
/// Every pixel, even outside of the picture, has a froxel with a list. Tested in pictures down to one pixel, with one
/// slice and many.
#[test]
fn hard_case_57_every_distance_has_a_froxel() -> TestResult {
    let Some(gpu) = gpu("hard_case_57_every_distance_has_a_froxel") else { return Ok(()) };
    let scene = punctual_lights(8)?;
    let camera = scene.cameras[1].clone();
    let mut night = Night::new(&gpu, scene, camera, [1, 1], PLAIN)?;
    let (mut rows, mut expected) = (Vec::new(), Vec::new());
    for size in [[1, 1], [1, 777], [1281, 720]] {
        for slices in [1, 16, 64] {
            night.seen.size_px = size;
            let search = LightSearch::Froxels(FroxelSettings { slices, ..FroxelSettings::DEFAULT });
            let lists = night.view(search).light_lists.ok_or("lists")?;
            let cut = lists.uniforms;
            let [across, down, slices] = cut.counts;
            assert!(lists.words.len() > (across * down * slices) as usize, "a list for each froxel, and where it ends");
            let last = size.map(|side| side as f32 - 0.5);
            for (pixel, tile) in [([0.5; 2], [0; 2]), (last, [across - 1, down - 1]), ([-3.0, 1e6], [0, down - 1])] {
                let nowhere = NOWHERE.map(|ahead| (ahead, 0));
                for (ahead, slice) in nowhere.into_iter().chain(BEYOND.map(|ahead| (ahead, slices - 1))) {
                    rows.extend([ahead, cut.slice_scale, cut.slice_offset, slices as f32]);
                    rows.extend([pixel[0], pixel[1], cut.tiles_per_px, across as f32, down as f32]);
                    expected.push(((slice * down + tile[1]) * across + tile[0]) as f32);
                }
            }
        }
    }
    let case = all().find(|case| case.function == "froxel_number").ok_or("froxel_number")?;
    let case = Case {
        function: "{froxel_number, froxel_slice}",
        parameters: WORDS,
        call: "f32(froxel_number(v2(4u), x[6], froxel_slice(x[0], x[1], x[2], u32(x[3])), \
               vec3<u32>(u32(x[7]), u32(x[8]), u32(x[3]))))",
        ..*case
    };
    for precision in precisions("hard_case_57_every_distance_has_a_froxel", &gpu) {
        let case = Case { in_half: precision == Precision::Half, ..case };
        let found = mirror::results(&gpu, &case, &rows)?;
        for ((row, found), expected) in rows.chunks_exact(9).zip(&found).zip(&expected) {
            assert_eq!(found, expected, "{precision:?}: {row:?}");
        }
        // Negative control: the logarithm without its bounds.
        let naive = Case {
            call: "f32(froxel_number(v2(4u), x[6], log2(x[0]) * x[1] + x[2], \
                   vec3<u32>(u32(x[7]), u32(x[8]), 4294967295u)))",
            ..case
        };
        assert_ne!(mirror::results(&gpu, &naive, &rows)?, expected, "{precision:?}");
    }
    Ok(())
}
