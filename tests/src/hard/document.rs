//! Rows of the tables in `docs/measurements/hard-cases.md`, printed by the program `hard_cases` and compared by a test.

use super::guard::guards;
use super::judge::Questions;
use super::probe;
use super::rows::{Place, ROWS};
use super::strict::strict;
use framegraph_wgpu::Gpu;
use std::collections::BTreeMap;
use std::error::Error;

/// A guard of the library, with a test case that fails without it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kept {
    /// File and function.
    pub function: String,
    /// Source text of the guard.
    pub guard: String,
    /// First test case that fails without the guard; `None` if every case passes.
    pub by: Option<String>,
}

/// Reason that removing a guard changes no result on Mesa's software driver.
const LOGARITHM: &str = "this driver's logarithm of zero and negative numbers is finite, which WGSL does not guarantee";
const SWALLOWED: &str = "the enclosing limit turns NaN into a number on this driver, which WGSL does not guarantee";
const ROUNDED_SUMS: &str = "sums in half floats may match no surfaces; tests of the mirror cover them";
const ROUNDING: &str = "guards against rounding beyond the limit; no input is known that causes it here";
const TWICE: &str = "the following code limits the same values by WGSL's rules; the guard makes it explicit";
const UNCHOSEN: &str = "a later select discards the result";
const WHOLE: &str = "for the center, where the angle has no effect";
const BEFORE: &str = "for rays that end before the fog starts, where its density has no effect";

/// Guards that no test case needs on this driver, with or without strict evaluation, and the reason.
pub const UNNOTICED: &[(&str, &str, &str)] = &[
    ("aces::aces_glow", "max(chroma2, 0.0)", ROUNDING),
    ("aces::aces_glow", "max(brightness, 1e-6)", SWALLOWED),
    ("aces::aces_redness", "select(along, 1.0, is_grey)", UNCHOSEN),
    ("agx::agx_look", "max(color * slope, vec3<f32>(1e-10))", LOGARITHM),
    ("display_range::display_range_color", "min(index, 15u)", TWICE),
    ("dfg_integration::dfg_cloth", "saturate(dot(view, h))", ROUNDING),
    ("dfg_integration::dfg_cloth", "min(2.0 * voh * h.z - nov, 1.0)", ROUNDING),
    ("dfg_integration::dfg_ggx", "saturate(dot(view, h))", ROUNDING),
    ("dfg_integration::dfg_ggx", "min(2.0 * voh * h.z - nov, 1.0)", ROUNDING),
    ("flare::starburst", "clamp(v.x / max(d, 1e-6), -1.0, 1.0)", WHOLE),
    ("fog::fog_optical_depth", "saturate(start_m / max(way_m, 1e-6))", BEFORE),
    ("fog::fog_optical_depth", "clamp(decay * clear, -FOG_MOST_EXPONENT, FOG_MOST_EXPONENT)", TWICE),
    ("fog::mean_decay", "select(x, 1.0, small)", SWALLOWED),
    ("upscale::kernel_of", "max(length2, 1e-12)", TWICE),
    ("froxel::froxel_number", "max(pixel, vec2<f32>(0.0))", TWICE),
    ("froxel::froxel_slice", "select(ahead_m, 0.0, is_nowhere)", SWALLOWED),
    ("gamut::map_into_gamut", "max(e * e - 2.0 * abs(from_middle), 0.0)", ROUNDING),
    ("grading::scale_luminance", "max(luminance, 1e-30)", ROUNDING),
    ("grading::scale_luminance", "max(peak, 1e-10)", SWALLOWED),
    ("grading::vibrance", "clamp(color.x - max(color.y, color.z), -20.0, 20.0)", SWALLOWED),
    ("gt7::nits_from_pq", "max(x - 0.8359375, vec3<f32>(0.0))", LOGARITHM),
    ("gtao::sector_bits", "clamp(floor(32.0 * low + jitter), 0.0, 32.0)", TWICE),
    ("gtao::slice_share", "saturate(below / slice_whole(n))", ROUNDING),
    ("moment_transparency::moment_transmittance", "max(b.y - b.x * b.x, 1e-7)", ROUNDED_SUMS),
    ("moment_transparency::moment_transmittance", "max(b.w - b.y * b.y - skew * l, 1e-8)", ROUNDED_SUMS),
    ("moment_transparency::moment_transmittance", "max(half_p * half_p - q, 0.0)", ROUNDING),
    ("moment_transparency::moment_transmittance", "select(-half_p - root, -half_p + root, half_p < 0.0)", ROUNDING),
    ("moment_transparency::moment_transmittance", "clamp(share, 0.0, 1.0)", ROUNDED_SUMS),
    ("weighted_blending::blend_weight", "clamp(abs(distance_m), 0.0, 1e4)", SWALLOWED),
    ("numerics::normalize_or", "max(largest, 1e-30)", SWALLOWED),
    ("numerics::saturate_half", "select(min(x, HALF_MAX), HALF_MAX, magnitude >= 0x7f800000u)", TWICE),
    ("occlusion::specular_occlusion", "max(nov + visibility, 0.0)", LOGARITHM),
    ("occlusion::specular_occlusion_cones", "saturate(overlap / max(1.0 - cos_lobe, 1e-6))", ROUNDING),
    ("refraction::refracted_path", "max(1.0 - eta * eta * (1.0 - cosine * cosine), 0.0)", ROUNDING),
    ("refraction::seen_transmission_spread", "max(ior, 1.0)", SWALLOWED),
    ("sampling::sample_visible_normal", "max(1.0 - p1 * p1, 0.0)", ROUNDING),
    ("sampling::sample_visible_normal", "max(1.0 - p1 * p1 - p2 * p2, 0.0)", ROUNDING),
    ("sampling::sample_visible_normal", "max(h.z, 0.0)", ROUNDING),
    ("sao::sao_term", "min(uu, 1.0)", ROUNDING),
    ("screen_ray::ray_length_m", "max(way_z, 1e-9)", TWICE),
    ("sky::sun_halo", "max(left, 1e-6)", UNCHOSEN),
    ("table::table_coordinates", "min(color, vec3<f32>(65504.0))", TWICE),
    ("tone_map::tone_map_neutral", "max(peak, 0.76)", UNCHOSEN),
    ("tone_map::tone_map_neutral", "saturate(mix(shifted * (new_peak / high), vec3<f32>(new_peak), white))", ROUNDING),
    ("tone_map::tone_map_neutral", "select(compressed, shifted, peak < 0.76)", TWICE),
    ("vignette::edge_share", "saturate(abs(from_middle) * shape.x * vec2<f32>(shape.y, 1.0))", TWICE),
    (
        "aces::tone_aces",
        "clamp(vec3<f32>( dot(ap0, vec3<f32>(1.45143932, -0.23651075, -0.21492857)), dot(ap0, vec3<f32>(-0.07655377, \
         1.17622970, -0.09967593)), dot(ap0, vec3<f32>(0.00831615, -0.00603245, 0.99771630)), ), vec3<f32>(0.0), \
         vec3<f32>(65504.0))",
        ROUNDING,
    ),
];

/// Returns the table of hard inputs: number, input, tests.
pub fn rows() -> Vec<String> {
    let line = |row: &super::rows::Row| {
        let functions = row.functions().into_iter().map(|function| format!("`{function}`"));
        let places = row.places.iter().map(|place| match place {
            Place::Test(file, test) => format!("[{test}](../../{file})"),
            Place::Elsewhere(why) => (*why).to_owned(),
        });
        let held: Vec<String> = functions.chain(places).collect();
        format!("| {} | {} | {} |", row.number, row.what, held.join(", "))
    };
    ROWS.iter().map(line).collect()
}

/// Tests every guard of every function in every build by removing it, or every `step`th guard from `start`.
///
/// # Errors
/// The device fails, or rejects a shader without a guard.
pub fn kept(gpu: &Gpu, start: usize, step: usize) -> Result<Vec<Kept>, Box<dyn Error>> {
    let mut found: BTreeMap<(String, usize), Kept> = BTreeMap::new();
    let mut count = 0;
    for case in probe::builds() {
        let wgsl = case.shader()?.wgsl;
        let function = format!("{}::{}", case.file, case.function);
        let guards = guards(&wgsl, case.function);
        let questions = Questions::of(case);
        for (index, guard) in guards.into_iter().enumerate() {
            let place = found.entry((function.clone(), index)).or_insert_with(|| {
                count += 1;
                Kept { function: function.clone(), guard: guard.text.clone(), by: None }
            });
            let chosen = (count - 1) % step == start % step;
            if place.by.is_none() && (step == 1 || chosen) {
                let without = guard.removed_from(&wgsl);
                place.by = questions.failures(gpu, &without)?.into_iter().next().map(|f| f.name);
                // Strict evaluation, if the guarded function itself passes under it.
                let of_numbers = Questions::of_numbers(case);
                if place.by.is_none() && of_numbers.failures(gpu, &strict(&wgsl, case.function))?.is_empty() {
                    let failed = of_numbers.failures(gpu, &strict(&without, case.function))?;
                    place.by = failed.into_iter().next().map(|f| format!("{}, evaluated strictly", f.name));
                }
            }
        }
    }
    Ok(found.into_values().collect())
}
