// Monte Carlo integration of the DFG table.

import package::lib::cloth::{d_charlie, v_neubelt};
import package::lib::ggx::{v_smith_ggx_correlated, v_smith_ggx_correlated_fast};
import package::lib::math::{PI, sq};
import package::lib::real::real;
import package::lib::sampling::{
    hammersley, sample_half_hemisphere, g1_smith_ggx, sample_visible_normal,
};

/// Integrates (∫ D·V·Fc·cos, ∫ D·V·cos) of the GGX lobe for one view direction, with Fc = (1 -
/// voh)⁵. It samples visible normals, so that only G2/G1 and Fresnel add noise. nov and roughness
/// must be above zero.
fn dfg_ggx(nov: f32, roughness: f32, fast_visibility: bool, samples: u32) -> vec2<f32> {
    let alpha = roughness * roughness;
    let view = vec3<f32>(sqrt(max(1.0 - nov * nov, 0.0)), 0.0, nov);
    let scale = 4.0 * nov / g1_smith_ggx(nov, alpha);
    var sum = vec2<f32>(0.0);
    for (var i = 0u; i < samples; i++) {
        let h = sample_visible_normal(view, alpha, hammersley(i, samples));
        let voh = saturate(dot(view, h));
        let nol = min(2.0 * voh * h.z - nov, 1.0);
        if nol > 0.0 {
            var v = real(0.0);
            if fast_visibility {
                v = v_smith_ggx_correlated_fast(real(nov), real(nol), real(alpha));
            } else {
                v = v_smith_ggx_correlated(real(nov), real(nol), real(alpha));
            }
            let c = 1.0 - voh;
            // D·V·cos over the density G1·D / (4·nov).
            sum += vec2<f32>(sq(sq(c)) * c, 1.0) * (f32(v) * nol * scale);
        }
    }
    return sum / f32(samples);
}

/// Integrates ∫ D·V·cos of the cloth lobe for one view direction, by half vectors uniform over the
/// hemisphere. Charlie's peak is at the horizon, where sampling by D gains little. The Jacobian
/// from h to l is 4·voh.
fn dfg_cloth(nov: f32, roughness: f32, samples: u32) -> f32 {
    let alpha = roughness * roughness;
    let view = vec3<f32>(sqrt(max(1.0 - nov * nov, 0.0)), 0.0, nov);
    var sum = 0.0;
    for (var i = 0u; i < samples; i++) {
        let h = sample_half_hemisphere(hammersley(i, samples));
        let voh = saturate(dot(view, h));
        let nol = min(2.0 * voh * h.z - nov, 1.0);
        if nol > 0.0 {
            let v = f32(v_neubelt(real(nov), real(nol)));
            sum += v * f32(d_charlie(real(h.z), real(alpha))) * nol * voh;
        }
    }
    return sum * (8.0 * PI / f32(samples));
}
