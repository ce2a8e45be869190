//! The tables of `docs/hard-cases.md`, as rows: printed by the program `hard_cases`, found again by tests.

use super::guard::guards;
use super::judge::Questions;
use super::probe;
use super::rows::{Place, ROWS};
use super::strict::strict;
use framegraph_wgpu::Gpu;
use std::collections::BTreeMap;
use std::error::Error;

/// A guard of the library, and the named case that fails without it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kept {
    /// File and function.
    pub function: String,
    /// The guard as it is written.
    pub guard: String,
    /// The first case that fails; nothing if none does.
    pub by: Option<String>,
}

/// Why taking a guard out changes no result on Mesa's software driver.
const LOGARITHM: &str = "this driver's logarithm of zero and of less is finite; WGSL leaves it open";
const SWALLOWED: &str = "the limit around it makes a number of what is none on this driver; WGSL leaves it open";
const ROUNDED_SUMS: &str = "sums in half floats need not be those of any surfaces; tests of the mirror ask for such";
const ROUNDING: &str = "for what rounding may carry past the limit; no input is known that it does so to here";
const TWICE: &str = "what follows holds the same values, by WGSL's rules; the guard says it without them";
const UNCHOSEN: &str = "a select behind it does not choose what is computed from it";
const WHOLE: &str = "for the middle, whose share is 1 whatever the angle";
const BEFORE: &str = "for ways that end before fog begins, which are in none whatever its mean density";

/// Guards that no case misses on this driver, nor where the function is read strictly, and why.
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
    ("table::table_coordinates", "min(color, vec3<f32>(65504.0))", TWICE),
    ("tone_map::tone_map_neutral", "max(peak, 0.76)", UNCHOSEN),
    ("tone_map::tone_map_neutral", "saturate(mix(shifted * (new_peak / high), vec3<f32>(new_peak), white))", ROUNDING),
    ("tone_map::tone_map_neutral", "select(compressed, shifted, peak < 0.76)", TWICE),
    ("vignette::edge_share", "saturate(abs(from_middle) * shape.x * vec2<f32>(shape.y, 1.0))", TWICE),
    (
        "aces::tone_aces",
        "clamp(vec3<f32>( dot(ap0, vec3<f32>(1.45143932, -0.23651075, -0.21492857)), \
         dot(ap0, vec3<f32>(-0.07655377, 1.17622970, -0.09967593)), \
         dot(ap0, vec3<f32>(0.00831615, -0.00603245, 0.99771630)), \
         ), vec3<f32>(0.0), vec3<f32>(65504.0))",
        ROUNDING,
    ),
];

/// The table of rows: number, input, where it is held.
pub fn rows() -> Vec<String> {
    let line = |row: &super::rows::Row| {
        let functions = row.functions().into_iter().map(|function| format!("`{function}`"));
        let places = row.places.iter().map(|place| match place {
            Place::Test(file, test) => format!("[{test}](../{file})"),
            Place::Elsewhere(why) => (*why).to_owned(),
        });
        let held: Vec<String> = functions.chain(places).collect();
        format!("| {} | {} | {} |", row.number, row.what, held.join(", "))
    };
    ROWS.iter().map(line).collect()
}

/// Every guard of every function in every build, taken out one at a time; or every `step`th one from `start` on.
///
/// # Errors
/// When the device fails, or refuses a text without a guard.
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
                // As a driver may read it, where the guarded function itself is sound so.
                let of_numbers = Questions::of_numbers(case);
                if place.by.is_none() && of_numbers.failures(gpu, &strict(&wgsl, case.function))?.is_empty() {
                    let failed = of_numbers.failures(gpu, &strict(&without, case.function))?;
                    place.by = failed.into_iter().next().map(|f| format!("{}, read strictly", f.name));
                }
            }
        }
    }
    Ok(found.into_values().collect())
}
