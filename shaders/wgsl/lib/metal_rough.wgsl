// glTF's metallic-roughness parameters turned into what the BRDF wants (glTF 2.0, appendix B).

import package::lib::real::{real, real3};

/// Diffuse albedo: dielectrics keep their base color, metals have none.
fn diffuse_from_base_color(base_color: real3, metallic: real) -> real3 {
    return base_color * (1.0 - metallic);
}

/// Reflectance at normal incidence: `dielectric_f0` (0.04 for an index of 1.5) for
/// dielectrics, the base color for metals.
fn f0_from_base_color(base_color: real3, metallic: real, dielectric_f0: real3) -> real3 {
    return mix(dielectric_f0, base_color, metallic);
}
