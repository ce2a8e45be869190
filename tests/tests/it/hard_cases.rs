//! Where the design's hard cases of ambient occlusion (30 to 36), of shadows (40 to 46) and of froxels (57) are tested, by their
//! numbers.

use std::error::Error;
use std::fs;
use std::path::Path;

const OCCLUSION: &str = "tests/tests/it/occlusion/hard.rs";
const PICTURES: &str = "tests/tests/it/shadow_rays/hard.rs";
const RAYS: &str = "tests/tests/it/shadow_rays.rs";
const FIT: &str = "passes/src/shadow/tests.rs";
const SHADOW: &str = "shaders/src/reference/shadow.rs";
const LIGHTS: &str = "tests/tests/it/lights/hard.rs";
const MOMENTS: &str = "shaders/src/reference/shadow_moments.rs";

/// Number, what is hard, and the tests with their files.
const CASES: [(u8, &str, &[(&str, &str)]); 15] = [
    (30, "sky at depth 0", &[(OCCLUSION, "hard_30_sky_is_open")]),
    (31, "surfaces a millimeter and less away", &[(OCCLUSION, "hard_31_what_is_before_the_eye_is_open")]),
    (32, "a radius of 0", &[(OCCLUSION, "hard_32_a_radius_of_nothing_leaves_the_passes_out")]),
    (33, "steps and strips", &[(OCCLUSION, "hard_33_normals_hold_at_edges_and_on_strips")]),
    (34, "positions far away", &[(OCCLUSION, "hard_34_far_ground_is_open")]),
    (35, "collinear vectors", &[(OCCLUSION, "hard_35_collinear_vectors_have_an_angle")]),
    (
        36,
        "the border of the picture",
        &[
            (OCCLUSION, "hard_36_borders_do_not_wrap"),
            ("shaders/src/reference/contact_shadow.rs", "hard_case_36_nothing_hides_at_the_edge"),
        ],
    ),
    (
        40,
        "light along the view and along up",
        &[
            (FIT, "hard_case_40_light_along_the_view_and_up"),
            (PICTURES, "hard_case_40_light_along_the_view_shades_as_rays_do"),
        ],
    ),
    (
        41,
        "casters before the near plane",
        &[
            (FIT, "hard_case_41_casters_before_the_near_plane"),
            (PICTURES, "hard_case_41_a_caster_behind_the_eye_shades_the_picture"),
        ],
    ),
    (
        42,
        "grazing light",
        &[
            (SHADOW, "hard_case_42_bias_covers_the_kernel_and_no_more"),
            (RAYS, "hard_case_42_a_field_of_100_m_agrees_with_rays"),
        ],
    ),
    (
        43,
        "no blocker, and blockers at the near end",
        &[
            (SHADOW, "hard_case_43_penumbrae_stay_finite"),
            (PICTURES, "hard_cases_43_to_45_a_floor_without_blockers_is_lit"),
            (PICTURES, "hard_case_43_blockers_at_both_ends_shade_as_rays_do"),
        ],
    ),
    (
        44,
        "moments beyond their format",
        &[
            (MOMENTS, "hard_case_44_moments_are_finite_in_their_formats"),
            (PICTURES, "hard_cases_43_to_45_a_floor_without_blockers_is_lit"),
        ],
    ),
    (
        45,
        "variance of a plane",
        &[
            (MOMENTS, "hard_case_45_a_lit_plane_is_lit_in_half_floats"),
            (PICTURES, "hard_case_45_moments_agree_with_rays"),
            (PICTURES, "hard_cases_43_to_45_a_floor_without_blockers_is_lit"),
        ],
    ),
    (
        46,
        "edges between the faces about a lamp",
        &[(SHADOW, "hard_case_46_ties_of_faces_go_to_the_first"), (RAYS, "hard_case_46_local_lights_agree_with_rays")],
    ),
    (57, "distances that have no slice", &[(LIGHTS, "hard_case_57_every_distance_has_a_froxel")]),
];

/// Whether a file has a test of that name.
fn is_tested(file: &str, test: &str) -> Result<bool, Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(file);
    let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let lines: Vec<_> = text.lines().map(str::trim).collect();
    let declared = format!("fn {test}()");
    Ok(lines.windows(2).any(|pair| pair[0] == "#[test]" && pair[1].starts_with(&declared)))
}

#[test]
fn every_case_has_its_tests() -> Result<(), Box<dyn Error>> {
    let numbers: Vec<u8> = CASES.iter().map(|case| case.0).collect();
    assert_eq!(numbers, (30..=36).chain(40..=46).chain([57]).collect::<Vec<_>>());
    for (number, what, tests) in CASES {
        assert!(!tests.is_empty(), "{number}");
        for (file, test) in tests {
            assert!(is_tested(file, test)?, "{number}, {what}: {file} has no test {test}");
        }
    }
    assert!(!is_tested(FIT, "hard_case_40")?, "a part of a name is no name");
    Ok(())
}
