//! Kinds of hard inputs, and the tests of each.

use super::probe;
use Place::{Elsewhere, Test};

/// A test of a row in addition to its probes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A test, by file and name.
    Test(&'static str, &'static str),
    /// No such input occurs in the project: the reason.
    Elsewhere(&'static str),
}

/// A kind of input that breaks arithmetic.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Number of the row, 1…57.
    pub number: u8,
    /// Description of the input and of the required result.
    pub what: &'static str,
    /// Tests in addition to probes.
    pub places: &'static [Place],
}

const OCCLUSION: &str = "tests/tests/it/occlusion/hard.rs";
const PICTURES: &str = "tests/tests/it/shadow_rays/hard.rs";
const RAYS: &str = "tests/tests/it/shadow_rays.rs";
const FIT: &str = "passes/src/gpu_scene/shadow_views/tests.rs";
const SHADOW: &str = "shaders/mirrors/src/shadow.rs";
const MOMENTS: &str = "shaders/mirrors/src/shadow_moments.rs";
const BLOOM: &str = "tests/tests/it/bloom.rs";
const CAMERA: &str = "scene/src/camera/tests.rs";
const POISON: &str = "tests/tests/it/poison.rs";
const SCENES: &str = "tests/tests/it/degenerate.rs";
const GLOW: &str = "shaders/mirrors/src/bloom.rs";
const LEVELS: &str = "passes/src/effects/bloom/chain.rs";
const FOG: &str = "shaders/mirrors/src/fog.rs";
const LENS: &str = "passes/src/effects/dof/settings.rs";
const DOF: &str = "tests/tests/it/dof.rs";
const BLENDED: &str = "shaders/mirrors/src/moment_transparency.rs";
const HALF: &str = "tests/tests/it/half.rs";
const HALF_HARD: &str = "tests/tests/it/half/hard.rs";

const fn row(number: u8, what: &'static str, places: &'static [Place]) -> Row {
    Row { number, what, places }
}

/// All rows, in order.
pub const ROWS: [Row; 58] = [
    row(1, "n·v of 0, negative, 1e-4: V fits half floats", &[]),
    row(2, "n·l of 0, −0, negative: exactly no light", &[]),
    row(3, "n·h above 1: D at most its peak", &[]),
    row(4, "roughness below the minimum: D is finite", &[Test(HALF_HARD, "highlights_beyond_half_floats_are_kept")]),
    row(5, "l·h of 0: Kelemen's V fits half floats", &[]),
    row(6, "v·h above 1: F between F0 and F90", &[]),
    row(7, "light opposite the viewer: finite", &[Test(HALF_HARD, "opposite_light_is_finite")]),
    row(8, "a normal of length 0, a triangle of area 0", &[Test(SCENES, "meshes_without_area_and_direction")]),
    row(9, "the mean of opposite normals", &[]),
    row(10, "a missing tangent, or one parallel to the normal", &[Test(SCENES, "meshes_without_area_and_direction")]),
    row(11, "anisotropy of ±1 and beyond", &[]),
    row(12, "cloth with roughness 0, n·h of 1, both cosines 0", &[]),
    row(13, "a DFG table entry of 0 or NaN: compensation between 1 and 1 + 2.34·f0", &[]),
    row(14, "the border of the DFG table", &[]),
    row(15, "f0 of 1, an index of refraction below 1", &[]),
    row(16, "a light at the lit surface", &[Test(SCENES, "lights_at_surfaces_and_along_the_view")]),
    row(17, "a light with range 0", &[Test("scene/src/import/tests/shading.rs", "broken_lights_are_errors")]),
    row(18, "a spot light with equal inner and outer angles", &[Test(SCENES, "lights_at_surfaces_and_along_the_view")]),
    row(19, "a sun of 110,000 lux before exposure", &[Test(SCENES, "exposures_from_cave_to_sun")]),
    row(20, "the sun's disc, beyond the range of half floats", &[]),
    row(
        21,
        "EV −10…24",
        &[Test(CAMERA, "exposure_follows_the_formula_and_stays_finite"), Test(SCENES, "exposures_from_cave_to_sun")],
    ),
    row(22, "unpremultiplying with alpha 0", &[Elsewhere("no pass divides by alpha")]),
    row(
        23,
        "a NaN pixel before bloom",
        &[
            Test(BLOOM, "hard_case_23_and_26_what_is_not_finite_does_not_spread"),
            Test(POISON, "a_poisoned_pixel_stays_where_it_is"),
        ],
    ),
    row(24, "one bright pixel of four before bloom", &[Test(GLOW, "hard_case_24_a_firefly_does_not_rule_the_mean")]),
    row(25, "a bloom threshold on black", &[Test(GLOW, "hard_case_25_black_and_thresholds_of_nothing_glow_finitely")]),
    row(
        26,
        "values outside the range of R11G11B10F",
        &[Test(BLOOM, "hard_case_23_and_26_what_is_not_finite_does_not_spread")],
    ),
    row(27, "negative spherical harmonics", &[]),
    row(28, "a coefficient of 65504", &[]),
    row(29, "albedo above 1 with interreflections", &[]),
    row(30, "sky at depth 0", &[Test(OCCLUSION, "hard_30_sky_is_open")]),
    row(31, "surfaces at a distance of 1 mm and less", &[Test(OCCLUSION, "hard_31_what_is_before_the_eye_is_open")]),
    row(32, "an occlusion radius of 0", &[Test(OCCLUSION, "hard_32_a_radius_of_nothing_leaves_the_passes_out")]),
    row(33, "depth steps and thin strips", &[Test(OCCLUSION, "hard_33_normals_hold_at_edges_and_on_strips")]),
    row(34, "distant positions", &[Test(OCCLUSION, "hard_34_far_ground_is_open")]),
    row(35, "cosines above 1, collinear vectors", &[Test(OCCLUSION, "hard_35_collinear_vectors_have_an_angle")]),
    row(
        36,
        "the border of the picture",
        &[
            Test(OCCLUSION, "hard_36_borders_do_not_wrap"),
            Test("shaders/mirrors/src/contact_shadow.rs", "hard_case_36_nothing_hides_at_the_edge"),
        ],
    ),
    row(
        37,
        "1e6 m from the origin",
        &[
            Test(FIT, "hard_case_37_far_from_the_origin"),
            Test(CAMERA, "far_from_the_origin_pixels_stay_put"),
            Test(SCENES, "a_thousand_kilometers_from_the_origin"),
        ],
    ),
    row(
        38,
        "scales of 0, 1e-13, −1, and 1e8 with 1e-8",
        &[
            Test("shaders/src/layout/object.rs", "extreme_scales_stay_finite_and_keep_their_sign"),
            Test(SCENES, "scales_of_nothing_and_less"),
        ],
    ),
    row(
        39,
        "empty bounds",
        &[Test(FIT, "hard_case_39_empty_and_flat_scenes"), Test(CAMERA, "orbit_of_nothing_is_still_a_camera")],
    ),
    row(
        40,
        "light along the view and along the up vector",
        &[
            Test(FIT, "hard_case_40_light_along_the_view_and_up"),
            Test(PICTURES, "hard_case_40_light_along_the_view_shades_as_rays_do"),
        ],
    ),
    row(
        41,
        "shadow casters in front of the near plane",
        &[
            Test(FIT, "hard_case_41_casters_before_the_near_plane"),
            Test(PICTURES, "hard_case_41_a_caster_behind_the_eye_shades_the_picture"),
        ],
    ),
    row(
        42,
        "grazing light, receivers seen edge-on",
        &[
            Test(SHADOW, "hard_case_42_bias_covers_the_kernel_and_no_more"),
            Test(RAYS, "hard_case_42_a_field_of_100_m_agrees_with_rays"),
        ],
    ),
    row(
        43,
        "no blocker, and blockers at the near plane",
        &[
            Test(SHADOW, "hard_case_43_penumbrae_stay_finite"),
            Test(PICTURES, "hard_cases_43_to_45_a_floor_without_blockers_is_lit"),
            Test(PICTURES, "hard_case_43_blockers_at_both_ends_shade_as_rays_do"),
        ],
    ),
    row(
        44,
        "moments outside the range of their format",
        &[
            Test(MOMENTS, "hard_case_44_moments_are_finite_in_their_formats"),
            Test(PICTURES, "hard_cases_43_to_45_a_floor_without_blockers_is_lit"),
        ],
    ),
    row(
        45,
        "variance of a plane",
        &[
            Test(MOMENTS, "hard_case_45_a_lit_plane_is_lit_in_half_floats"),
            Test(PICTURES, "hard_case_45_moments_agree_with_rays"),
            Test(PICTURES, "hard_cases_43_to_45_a_floor_without_blockers_is_lit"),
        ],
    ),
    row(
        46,
        "edges between the cube faces of a point light",
        &[
            Test(SHADOW, "hard_case_46_ties_of_faces_go_to_the_first"),
            Test(RAYS, "hard_case_46_local_lights_agree_with_rays"),
        ],
    ),
    row(47, "tone curves of negative values, 161.6, 65504, ∞", &[]),
    row(48, "coordinates of color tables for the same values", &[]),
    row(49, "transfer functions below 0 and above 1", &[]),
    row(50, "FXAA on a uniform picture, and on one of 50 nits", &[]),
    row(51, "a history with NaN", &[Test("tests/tests/it/taa.rs", "spoilt_sums_are_gone_after_a_frame")]),
    row(
        52,
        "targets of 1×1, 1×777, 3×2",
        &[Test(SCENES, "targets_of_a_pixel_and_of_a_line"), Test(LEVELS, "hard_case_52_every_level_has_texels")],
    ),
    row(53, "fog with density 0, infinite distance", &[Test(FOG, "hard_case_53_transmittance_stays_a_share")]),
    row(
        54,
        "a focus distance equal to the focal length",
        &[
            Test(LENS, "hard_case_54_nothing_nearer_than_the_focal_length_is_in_focus"),
            Test(DOF, "hard_case_54_pictures_stay_finite"),
        ],
    ),
    row(55, "noise at pixel coordinates of a million", &[]),
    row(56, "denormal half floats", &[Test(HALF, "bounds_hold_whether_or_not_small_numbers_are_flushed")]),
    row(
        57,
        "froxels behind the eye and at NaN",
        &[
            Test("passes/src/gpu_scene/punctual/tests.rs", "no_light_is_missed_by_other_cuts_and_far_away"),
            Test("tests/tests/it/lights/hard.rs", "hard_case_57_every_distance_has_a_froxel"),
        ],
    ),
    row(
        58,
        "blended surfaces at one distance, of alpha 1, over any range",
        &[
            Test(BLENDED, "hard_case_58_one_distance_hides_what_is_behind_it_and_nothing_in_front"),
            Test(BLENDED, "hard_case_58_a_layer_that_hides_everything_hides_it"),
            Test(BLENDED, "hard_case_58_nothing_makes_it_other_than_a_share"),
            Test("tests/tests/it/transparency.rs", "hard_stacks"),
        ],
    ),
];

impl Row {
    /// Returns the functions whose probes name the row, without duplicates.
    pub fn functions(&self) -> Vec<&'static str> {
        let mut functions: Vec<_> = probe::all().filter(|probe| probe.row == self.number).map(|p| p.function).collect();
        functions.dedup();
        functions
    }

    /// Returns true if a test covers the row, or a reason says why none is needed.
    pub fn is_held(&self) -> bool {
        !self.functions().is_empty() || !self.places.is_empty()
    }
}
