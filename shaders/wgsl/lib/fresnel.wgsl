// Fresnel reflectance.

import package::lib::math::pow5;

/// Schlick's approximation (1994): reflectance at the angle whose cosine is voh, between f0
/// at normal incidence and f90 at grazing. voh is clamped to [0, 1].
fn f_schlick(f0: vec3<f32>, f90: f32, voh: f32) -> vec3<f32> {
    return f0 + (vec3<f32>(f90) - f0) * pow5(1.0 - saturate(voh));
}
