//! The rows of hard inputs, and where each is held.

use super::probe;
use Place::{Elsewhere, Test};

/// Where a row is held, beside the probes that name it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A test, by its file and name.
    Test(&'static str, &'static str),
    /// Nothing in the project has such an input, and why.
    Elsewhere(&'static str),
}

/// A kind of input that breaks arithmetic.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// 1…57.
    pub number: u8,
    /// The input, with what must come of it.
    pub what: &'static str,
    /// Where else than by probes it is held.
    pub places: &'static [Place],
}

const OCCLUSION: &str = "tests/tests/it/occlusion/hard.rs";
const PICTURES: &str = "tests/tests/it/shadow_rays/hard.rs";
const RAYS: &str = "tests/tests/it/shadow_rays.rs";
const FIT: &str = "passes/src/shadow/tests.rs";
const SHADOW: &str = "shaders/src/reference/shadow.rs";
const MOMENTS: &str = "shaders/src/reference/shadow_moments.rs";
const BLOOM: &str = "tests/tests/it/bloom.rs";
const CAMERA: &str = "scene/src/camera/tests.rs";
const POISON: &str = "tests/tests/it/poison.rs";
const SCENES: &str = "tests/tests/it/degenerate.rs";
const GLOW: &str = "shaders/src/reference/bloom.rs";
const LEVELS: &str = "passes/src/bloom/chain.rs";
const FOG: &str = "shaders/src/reference/fog.rs";
const LENS: &str = "passes/src/dof/settings.rs";
const DOF: &str = "tests/tests/it/dof.rs";
const BLENDED: &str = "shaders/src/reference/moment_transparency.rs";
const HALF: &str = "tests/tests/it/half.rs";
const HALF_HARD: &str = "tests/tests/it/half/hard.rs";

const fn row(number: u8, what: &'static str, places: &'static [Place]) -> Row {
    Row { number, what, places }
}

/// All rows, in order.
pub const ROWS: [Row; 58] = [
    row(1, "n·v of 0, less, 1e-4: V within half floats", &[]),
    row(2, "n·l of 0, −0, less: exactly no light", &[]),
    row(3, "n·h past 1: D up to its peak", &[]),
    row(4, "roughness below the floor: D finite", &[Test(HALF_HARD, "highlights_beyond_half_floats_are_kept")]),
    row(5, "l·h of 0: Kelemen's V within half floats", &[]),
    row(6, "v·h past 1: F from F0 to F90", &[]),
    row(7, "light opposite to the viewer: finite", &[Test(HALF_HARD, "opposite_light_is_finite")]),
    row(8, "a normal of no length, a triangle of no area", &[Test(SCENES, "meshes_without_area_and_direction")]),
    row(9, "half way between opposite normals", &[]),
    row(10, "a tangent that is missing or along the normal", &[Test(SCENES, "meshes_without_area_and_direction")]),
    row(11, "grooves of strength ±1 and beyond", &[]),
    row(12, "cloth of roughness 0, at n·h of 1, both cosines 0", &[]),
    row(13, "a table entry of 0, or none: compensation from 1 to 1 + 2.34·f0", &[]),
    row(14, "the table's border", &[]),
    row(15, "f0 of 1, an index below 1", &[]),
    row(16, "a light where it shines", &[Test(SCENES, "lights_at_surfaces_and_along_the_view")]),
    row(17, "a light of range 0", &[Test("scene/src/import/tests/shading.rs", "broken_lights_are_errors")]),
    row(18, "a cone whose inner angle is the outer one", &[Test(SCENES, "lights_at_surfaces_and_along_the_view")]),
    row(19, "a sun of 110 000 lux before exposure", &[Test(SCENES, "exposures_from_cave_to_sun")]),
    row(20, "the sun's disc, more than a half float holds", &[]),
    row(
        21,
        "EV −10…24",
        &[Test(CAMERA, "exposure_follows_the_formula_and_stays_finite"), Test(SCENES, "exposures_from_cave_to_sun")],
    ),
    row(22, "unpremultiplying an alpha of 0", &[Elsewhere("no pass divides by alpha")]),
    row(
        23,
        "one pixel that is no number, before bloom",
        &[
            Test(BLOOM, "hard_case_23_and_26_what_is_not_finite_does_not_spread"),
            Test(POISON, "a_poisoned_pixel_stays_where_it_is"),
        ],
    ),
    row(24, "one bright pixel of four, before bloom", &[Test(GLOW, "hard_case_24_a_firefly_does_not_rule_the_mean")]),
    row(25, "a threshold on black", &[Test(GLOW, "hard_case_25_black_and_thresholds_of_nothing_glow_finitely")]),
    row(26, "what R11G11B10F does not hold", &[Test(BLOOM, "hard_case_23_and_26_what_is_not_finite_does_not_spread")]),
    row(27, "harmonics below zero", &[]),
    row(28, "a coefficient of 65504", &[]),
    row(29, "albedo past 1, several bounces", &[]),
    row(30, "sky at depth 0", &[Test(OCCLUSION, "hard_30_sky_is_open")]),
    row(31, "surfaces a millimeter and less away", &[Test(OCCLUSION, "hard_31_what_is_before_the_eye_is_open")]),
    row(32, "a radius of 0", &[Test(OCCLUSION, "hard_32_a_radius_of_nothing_leaves_the_passes_out")]),
    row(33, "steps and strips", &[Test(OCCLUSION, "hard_33_normals_hold_at_edges_and_on_strips")]),
    row(34, "positions far away", &[Test(OCCLUSION, "hard_34_far_ground_is_open")]),
    row(35, "cosines past 1, collinear vectors", &[Test(OCCLUSION, "hard_35_collinear_vectors_have_an_angle")]),
    row(
        36,
        "the border of the picture",
        &[
            Test(OCCLUSION, "hard_36_borders_do_not_wrap"),
            Test("shaders/src/reference/contact_shadow.rs", "hard_case_36_nothing_hides_at_the_edge"),
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
        "scales of 0, 1e-13, −1, and 1e8 beside 1e-8",
        &[
            Test("shaders/src/layout/object.rs", "extreme_scales_stay_finite_and_keep_their_sign"),
            Test(SCENES, "scales_of_nothing_and_less"),
        ],
    ),
    row(
        39,
        "bounds of nothing",
        &[Test(FIT, "hard_case_39_empty_and_flat_scenes"), Test(CAMERA, "orbit_of_nothing_is_still_a_camera")],
    ),
    row(
        40,
        "light along the view and along up",
        &[
            Test(FIT, "hard_case_40_light_along_the_view_and_up"),
            Test(PICTURES, "hard_case_40_light_along_the_view_shades_as_rays_do"),
        ],
    ),
    row(
        41,
        "casters before the near plane",
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
        "no blocker, and blockers at the near end",
        &[
            Test(SHADOW, "hard_case_43_penumbrae_stay_finite"),
            Test(PICTURES, "hard_cases_43_to_45_a_floor_without_blockers_is_lit"),
            Test(PICTURES, "hard_case_43_blockers_at_both_ends_shade_as_rays_do"),
        ],
    ),
    row(
        44,
        "moments beyond their format",
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
        "edges between the faces about a lamp",
        &[
            Test(SHADOW, "hard_case_46_ties_of_faces_go_to_the_first"),
            Test(RAYS, "hard_case_46_local_lights_agree_with_rays"),
        ],
    ),
    row(47, "tone curves of less than nothing, 161.6, 65504, ∞", &[]),
    row(48, "a table's coordinates of the same", &[]),
    row(49, "transfer functions of less than 0 and more than 1", &[]),
    row(50, "the edge filter on a flat picture, and on one of 50 nits", &[]),
    row(51, "a history that is no number", &[Test("tests/tests/it/taa.rs", "spoilt_sums_are_gone_after_a_frame")]),
    row(
        52,
        "targets of 1×1, 1×777, 3×2",
        &[Test(SCENES, "targets_of_a_pixel_and_of_a_line"), Test(LEVELS, "hard_case_52_every_level_has_texels")],
    ),
    row(53, "fog of no density, endless distance", &[Test(FOG, "hard_case_53_transmittance_stays_a_share")]),
    row(
        54,
        "a focus at the focal length",
        &[
            Test(LENS, "hard_case_54_nothing_nearer_than_the_focal_length_is_in_focus"),
            Test(DOF, "hard_case_54_pictures_stay_finite"),
        ],
    ),
    row(55, "noise a million pixels out", &[]),
    row(
        56,
        "half floats without all of their bits",
        &[Test(HALF, "bounds_hold_whether_or_not_small_numbers_are_flushed")],
    ),
    row(
        57,
        "froxels behind the eye and nowhere",
        &[
            Test("passes/src/punctual/tests.rs", "no_light_is_missed_by_other_cuts_and_far_away"),
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
    /// Functions whose probes name the row, each once.
    pub fn functions(&self) -> Vec<&'static str> {
        let mut functions: Vec<_> = probe::all().filter(|probe| probe.row == self.number).map(|p| p.function).collect();
        functions.dedup();
        functions
    }

    /// Whether something holds it, or says why nothing needs to.
    pub fn is_held(&self) -> bool {
        !self.functions().is_empty() || !self.places.is_empty()
    }
}
