// Reflectance of a thin film between air and a base, as KHR_materials_iridescence defines it.
//
// Light reflected at the two sides of the film interferes. The model is that of Belcour and Barla,
// "A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence", 2017.
//
// The sample code holds the product of the two reflectances at 1e-5, which shows as waves of 0.015
// where nothing is reflected. Here it is not held.
//
// Every build computes it in f32: phases are differences of many waves.

import package::lib::math::PI;

/// Linear Rec.709 of a wave in the spectrum: how the eye sees reflectance that oscillates as
/// cos(2π·(path / wavelength + turns)), with `path_nm` in nm. Gaussian fits of the color matching
/// functions, whose Fourier transforms are Gaussians again. A path beyond 100 µm leaves nothing of
/// any wave.
fn film_sensitivity(path_nm: f32, turns: vec3<f32>) -> vec3<f32> {
    let path_um = min(path_nm, 1e5) * 1e-3;
    let cycles = vec3<f32>(1.6810, 1.7953, 2.2084) * path_um + turns;
    let blue_red = 2.2399 * path_um + turns.x;
    // Within half a turn, where WGSL promises what a cosine is.
    let wave = cos((2.0 * PI) * (cycles - round(cycles)));
    let second = cos((2.0 * PI) * (blue_red - round(blue_red)));
    let path2 = path_um * path_um;
    let fall = exp(vec3<f32>(-0.17085470, -0.36733088, -0.26103525) * path2);
    let xyz = vec3<f32>(0.84659000, 1.00022189, 1.00112249) * wave * fall
        + vec3<f32>(0.15386831 * second * exp(-0.17876618 * path2), 0.0, 0.0);
    return vec3<f32>(
        dot(xyz, vec3<f32>(3.2404542, -1.5371385, -0.4985314)),
        dot(xyz, vec3<f32>(-0.9692660, 1.8760108, 0.0415560)),
        dot(xyz, vec3<f32>(0.0556434, -0.2040259, 1.0572252)),
    );
}

/// Reflectance of a film of index `ior` (1 or more) on a base that reflects `base_f0` in air, at
/// the angle whose cosine is `cosine`. Light that goes to and fro in the film up to twice is
/// summed up.
fn thin_film_reflectance(
    cosine: f32,
    ior: f32,
    thickness_nm: f32,
    base_f0: vec3<f32>,
) -> vec3<f32> {
    let outside = saturate(cosine);
    let index = max(ior, 1.0);
    // Snell's law, written so that nothing is subtracted from a smaller number.
    let inside = sqrt((index * index - 1.0) + outside * outside) / index;

    let top_root = (index - 1.0) / (index + 1.0);
    let top_f0 = top_root * top_root;
    let up = 1.0 - outside;
    let top = top_f0 + (1.0 - top_f0) * (up * up * up * up * up);
    let through = 1.0 - top;

    let root = sqrt(clamp(base_f0, vec3<f32>(0.0), vec3<f32>(0.9999)));
    let base = (1.0 + root) / (1.0 - root);
    let bottom_root = (base - index) / (base + index);
    let bottom_f0 = bottom_root * bottom_root;
    let down = 1.0 - inside;
    let bottom = bottom_f0 + (1.0 - bottom_f0) * (down * down * down * down * down);

    // Half a turn at the top from below, and at the bottom where the base is the thinner medium.
    let turns = 0.5 + 0.5 * vec3<f32>(base < vec3<f32>(index));
    let path_nm = 2.0 * index * thickness_nm * inside;
    let trips = min(top * bottom, vec3<f32>(0.9999));
    let amplitude = sqrt(trips);
    let returned = through * through * bottom / (1.0 - trips);
    let first = (returned - through) * amplitude;
    let waves = first * film_sensitivity(path_nm, turns)
        + first * amplitude * film_sensitivity(2.0 * path_nm, 2.0 * turns);
    // Colors of the spectrum lie outside of Rec.709, and no film gives back more than it gets.
    return saturate(top + returned + 2.0 * waves);
}

/// Reflectance at normal incidence for which Schlick's approximation, with `f90` at grazing, gives
/// `reflectance` at the angle whose cosine is `cosine`. At grazing everything does, so it is held.
fn f0_from_reflectance(reflectance: vec3<f32>, f90: f32, cosine: f32) -> vec3<f32> {
    let up = 1.0 - cosine;
    let grazing = min(up * up * up * up * up, 0.9999);
    return saturate((reflectance - f90 * grazing) / (1.0 - grazing));
}
