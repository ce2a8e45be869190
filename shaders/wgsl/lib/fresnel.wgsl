// Fresnel reflectance.

import package::lib::math::pow5;
import package::lib::real::{real, real3};

/// Schlick's approximation (1994): reflectance at the angle whose cosine is voh, between f0
/// at normal incidence and f90 at grazing. voh is clamped to [0, 1].
fn f_schlick(f0: real3, f90: real, voh: real) -> real3 {
    return f0 + (real3(f90) - f0) * pow5(1.0 - saturate(voh));
}

/// Evaluates Schlick's approximation for one channel.
fn f_schlick_scalar(f0: real, f90: real, voh: real) -> real {
    return f0 + (f90 - f0) * pow5(1.0 - saturate(voh));
}

/// Returns the reflectance at grazing incidence for an f0. It is one for every real material and
/// fades out below f0 = 0.02. Only artists use such values, to disable specular reflection (Lagarde
/// and de Rousiers, "Moving Frostbite to PBR", 2014, section 3.1.3).
fn f90_from_f0(f0: real3) -> real {
    return saturate(dot(f0, real3(16.5)));
}
