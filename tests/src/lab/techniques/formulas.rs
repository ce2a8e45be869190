//! Techniques of formulas, compared with what they approximate.

use super::{Choice, Technique, formula, number};
use crate::lab::technique::Measured;
use framegraph_passes::light::shading::TransmissionBlur;
use framegraph_shader_mirrors::clear_coat::{f0_under_clear_coat, f0_under_clear_coat_fast, v_kelemen};
use framegraph_shader_mirrors::depth_normal::continues_ahead;
use framegraph_shader_mirrors::fresnel::f_schlick_scalar;
use framegraph_shader_mirrors::ggx::{v_smith_ggx_correlated, v_smith_ggx_correlated_fast};
use framegraph_shader_mirrors::refraction::{seen_transmission_spread, transmission_spread};
use framegraph_wgpu::Gpu;
use glam::DVec3;

pub(super) fn techniques() -> Vec<Technique> {
    vec![
        visibility_term(),
        fresnel(),
        coat_visibility(),
        coat_base(),
        transmission_blur(),
        depth_format(),
        depth_normals(),
    ]
}

/// Creates an option from differences: root mean square and signed mean.
fn rms(name: &str, apart: impl Fn() -> Vec<f64> + 'static) -> Choice {
    number(name, move |_: &Gpu| {
        let apart = apart();
        let count = apart.len() as f64;
        let error = (apart.iter().map(|d| d * d).sum::<f64>() / count).sqrt();
        Ok(Measured { bias: Some(apart.iter().sum::<f64>() / count), ..Measured::exact(error) })
    })
}

/// Returns cosines toward viewer and light in 0.02 … 1, and alpha for roughness 0.089 … 1.
fn angles() -> impl Iterator<Item = [f64; 3]> {
    let cosine = |i: u32| 0.02 + 0.98 * f64::from(i) / 19.0;
    let alpha = |i: u32| (0.089 + 0.911 * f64::from(i) / 14.0_f64).powi(2);
    (0..20 * 20 * 15).map(move |i| [cosine(i % 20), cosine(i / 20 % 20), alpha(i / 400)])
}

fn visibility_term() -> Technique {
    let against = |other: fn(f64, f64, f64) -> f64| {
        move || angles().map(|[v, l, a]| other(v, l, a) / v_smith_ggx_correlated(v, l, a) - 1.0).collect()
    };
    fn separable(v: f64, l: f64, a: f64) -> f64 {
        let g1 = |c: f64| 1.0 / (c + (a * a + (1.0 - a * a) * c * c).sqrt());
        g1(v) * g1(l)
    }
    fn schlick(v: f64, l: f64, a: f64) -> f64 {
        let g1 = |c: f64| 1.0 / (c * (1.0 - 0.5 * a) + 0.5 * a);
        0.25 * g1(v) * g1(l)
    }
    let choices = vec![
        rms("height-correlated Smith", against(v_smith_ggx_correlated))
            .counted("v_smith_ggx_correlated", false)
            .found_in(|f| f.settings.shading.visibility == framegraph_shader_mirrors::dfg::Visibility::Exact),
        rms("Hammon", against(v_smith_ggx_correlated_fast))
            .counted("v_smith_ggx_correlated_fast", false)
            .found_in(|f| f.settings.shading.visibility == framegraph_shader_mirrors::dfg::Visibility::Fast),
        rms("separable Smith", against(separable)),
        rms("Schlick, k = α/2", against(schlick)),
    ];
    let what = "Formula of the visibility term, over cosines 0.02 … 1 and roughness 0.089 … 1: relative error.";
    formula("visibility-term", what, "the height-correlated Smith term in f64.", "share, RMS", choices)
}

/// Returns Fresnel reflectance of a dielectric for unpolarized light.
fn dielectric(cosine: f64, ior: f64) -> f64 {
    let g = (ior * ior - 1.0 + cosine * cosine).sqrt();
    let a = ((g - cosine) / (g + cosine)).powi(2);
    let b = ((cosine * (g + cosine) - 1.0) / (cosine * (g - cosine) + 1.0)).powi(2);
    0.5 * a * (1.0 + b)
}

fn fresnel() -> Technique {
    let over = |reflectance: fn(f64, f64) -> f64| {
        move || {
            let pairs = [1.333, 1.5, 1.77, 2.42]
                .into_iter()
                .flat_map(|ior| (1..=100).map(move |i| (ior, f64::from(i) / 100.0)));
            pairs.map(|(ior, cosine)| reflectance(cosine, ior) - dielectric(cosine, ior)).collect()
        }
    };
    let choices = vec![
        rms("Schlick", over(|cosine, ior| f_schlick_scalar(((ior - 1.0) / (ior + 1.0)).powi(2), 1.0, cosine)))
            .counted("f_schlick_scalar", false)
            .found_in(|_| true),
        rms("none: f0", over(|_, ior| ((ior - 1.0) / (ior + 1.0)).powi(2))),
    ];
    let what = "Reflectance by angle for water, glass, sapphire and diamond.";
    formula("fresnel", what, "Fresnel's equations for unpolarized light.", "reflectance, RMS", choices)
}

fn coat_visibility() -> Technique {
    // In the mirror direction, where the lobe of a coat is, l·h is the cosine of both angles.
    let over = |most_roughness: f64| {
        move || {
            let grid = (0..20).flat_map(move |r| (1..=20).map(move |c| (r, f64::from(c) / 20.0)));
            let apart = grid.map(move |(r, cosine)| {
                let roughness: f64 = 0.089 + (most_roughness - 0.089) * f64::from(r) / 19.0;
                v_kelemen(cosine) / v_smith_ggx_correlated(cosine, cosine, roughness * roughness) - 1.0
            });
            apart.collect()
        }
    };
    let choices = vec![
        rms("Kelemen, roughness to 0.1", over(0.1)).counted("v_kelemen", false).found_in(|_| true),
        rms("Kelemen, roughness to 0.3", over(0.3)),
        rms("Kelemen, roughness to 0.6", over(0.6)),
    ];
    let what = "Kelemen's visibility term of a clear coat in the mirror direction: relative error, for glossy and rough coats.";
    formula("coat-visibility", what, "the height-correlated Smith term.", "share, RMS", choices)
}

fn coat_base() -> Technique {
    let exact = |f0: f64| {
        let n = (1.0 + f0.sqrt()) / (1.0 - f0.sqrt());
        ((n - 1.5) / (n + 1.5)).powi(2)
    };
    let over = move |shown: fn(DVec3) -> DVec3| {
        move || {
            (0..=95).map(|i| f64::from(i) / 100.0).map(|f0| shown(DVec3::splat(f0)).x - exact(f0)).collect::<Vec<_>>()
        }
    };
    let choices = vec![
        rms("exact", over(f0_under_clear_coat))
            .counted("f0_under_clear_coat", false)
            .found_in(|f| !f.settings.shading.fast_coat),
        rms("polynomial", over(f0_under_clear_coat_fast))
            .counted("f0_under_clear_coat_fast", false)
            .found_in(|f| f.settings.shading.fast_coat),
        rms("left as in air", over(|f0| f0)),
    ];
    let what = "Reflectance of a base under a clear coat of index 1.5, for f0 of 0 … 0.95.";
    formula("coat-base", what, "Fresnel's equations at the inner interface.", "reflectance, RMS", choices)
}

fn transmission_blur() -> Technique {
    /// Returns the tangent of the exit angle of light that meets a facet of this tilt and leaves the flat far side, by
    /// Snell's law at both.
    fn bent(tilt: f64, ior: f64) -> f64 {
        let inside = tilt - (tilt.sin() / ior).asin();
        (ior * inside.sin()).asin().tan()
    }
    // Half of the facets of GGX's distribution have a slope below alpha, and half of a Gaussian is within 1.1774
    // standard deviations.
    let half = (2.0 * 2.0_f64.ln()).sqrt();
    let over = move |sigma_rad: fn(f64, f64, f64) -> f64| {
        move || {
            let roughness = (2..=7).map(|i| 0.1 * f64::from(i));
            let grid = roughness.flat_map(|r| [1.2, 1.33, 1.5, 1.8].map(|ior| (r, ior)));
            // Share of the distance from the eye to the visible surface that lies behind the glass.
            let grid = grid.flat_map(|(r, ior)| [0.02, 0.1, 0.3, 0.6, 0.9].map(|behind| (r, ior, behind)));
            let apart = grid.map(|(r, ior, behind)| {
                let truth = (bent((r * r).atan(), ior) * behind).atan();
                half * sigma_rad(r, ior, behind) - truth
            });
            apart.map(f64::to_degrees).collect::<Vec<_>>()
        }
    };
    let choices = vec![
        rms("by the distance behind", over(|r, ior, behind| transmission_spread(r * r, ior) * behind))
            .counted("transmission_spread", false)
            .found_in(|f| f.settings.shading.transmission_blur == TransmissionBlur::Distance),
        rms("by an angle from the eye, Filament's", over(|r, ior, _| seen_transmission_spread(r, ior)))
            .counted("seen_transmission_spread", false)
            .found_in(|f| f.settings.shading.transmission_blur == TransmissionBlur::Angle),
        rms("none", over(|_, _, _| 0.0)),
    ];
    let what = "Blur of objects behind a rough pane at normal incidence: the angle from the eye that contains half of the light. Tested over roughness 0.2 … 0.7, index 1.2 … 1.8, and near and far distances behind the pane.";
    let truth = "Snell's law at GGX's median facet, and at the flat far side.";
    formula("transmission-blur", what, truth, "degrees, RMS", choices)
}

fn depth_format() -> Technique {
    const NEAR_M: f64 = 0.1;
    const FAR_M: f64 = 1000.0;
    let over = |stored: fn(f64) -> f64| {
        move || {
            let at = (0..400).map(|i| 10.0 + 0.001 * f64::from(i));
            at.map(|z| stored(z) - z).collect::<Vec<_>>()
        }
    };
    fn standard(z: f64) -> f64 {
        FAR_M / (FAR_M - NEAR_M) * (1.0 - NEAR_M / z)
    }
    fn back(depth: f64) -> f64 {
        NEAR_M / (1.0 - depth * (FAR_M - NEAR_M) / FAR_M)
    }
    let choices = vec![
        rms("reversed, f32", over(|z| NEAR_M / f64::from((NEAR_M / z) as f32))).found_in(|_| true),
        rms("standard, f32", over(|z| back(f64::from(standard(z) as f32)))),
        rms("standard, 24 bits", over(|z| back((standard(z) * 16_777_215.0).round() / 16_777_215.0))),
        rms("standard, 16 bits", over(|z| back((standard(z) * 65_535.0).round() / 65_535.0))),
    ];
    let what = "Depth format: error of distances around 10 m, with a near plane of 0.1 m and a far plane of 1 km.";
    formula("depth-format", what, "the exact distance.", "m, RMS", choices)
}

fn depth_normals() -> Technique {
    /// Returns the distance in m at a column 1 cm wide. The profile is a wall that leans back, a step of 0.5 m, a wall that leans forward, a crease, and a strip two columns wide.
    fn distance(column: i32) -> f64 {
        let x = 0.01 * f64::from(column);
        match column {
            ..40 => 5.0 + 0.6 * x,
            40..80 => 5.8 - 0.3 * x,
            80..120 => 5.56 + 0.8 * (x - 0.8),
            120..122 => 4.0,
            _ => 5.9 + 0.2 * x,
        }
    }
    /// Returns the slope of the surface at a column, in m per column.
    fn rise(column: i32) -> f64 {
        0.01 * match column {
            ..40 => 0.6,
            40..80 => -0.3,
            80..120 => 0.8,
            120..122 => 0.0,
            _ => 0.2,
        }
    }
    let over = |found: fn([f64; 5]) -> f64| {
        move || {
            let angle = |rise: f64| (rise / 0.01).atan().to_degrees();
            let at = |column: i32| [-2, -1, 0, 1, 2].map(|step| distance(column + step));
            (2..158).map(|column| angle(found(at(column))) - angle(rise(column))).collect::<Vec<_>>()
        }
    };
    fn nearer([far_back, back, here, ahead, far_ahead]: [f64; 5]) -> f64 {
        let goes_on = continues_ahead([far_back, back], here, [ahead, far_ahead]);
        if goes_on { ahead - here } else { here - back }
    }
    let choices = vec![
        rms("three taps: toward one side", over(|z| z[3] - z[2])),
        rms("three taps: across both sides", over(|z| 0.5 * (z[3] - z[1]))),
        rms("five taps: the side that goes on", over(nearer))
            .counted("continues_ahead", false)
            .found_in(|f| f.settings.occlusion.is_some_and(|o| o.fine_normals)),
    ];
    let what = "Normals from depth across steps, a crease and a strip of two pixels: error of the angle.";
    formula("depth-normals", what, "the slope of the surface.", "degrees, RMS", choices)
}
