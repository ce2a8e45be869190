//! Reflection of a surface with all lobes under one light or a whole sky, in f64, for one point.
//!
//! Implemented from the papers and glTF's specifications: Heitz's Λ instead of visibility terms, and Fresnel's formula
//! instead of an approximation under a coat. Layers from the top: clear coat, sheen, then GGX over Lambert.

use super::albedo::{Masking, cloth, ggx};
use glam::DVec3;
use std::f64::consts::PI;

/// Anisotropy of the base (KHR_materials_anisotropy).
#[derive(Clone, Copy, Debug)]
pub struct Grooves {
    /// Unit direction of anisotropy, perpendicular to the normal: the lobe is wider along it.
    pub along: DVec3,
    /// Strength of anisotropy, 0…1.
    pub strength: f64,
}

/// Sheen over the base (KHR_materials_sheen).
#[derive(Clone, Copy, Debug)]
pub struct Sheen {
    /// Reflectance of the lobe.
    pub color: DVec3,
    /// Perceptual roughness.
    pub roughness: f64,
}

/// Clear coat over all other layers (KHR_materials_clearcoat).
#[derive(Clone, Copy, Debug)]
pub struct Coat {
    /// Unit normal of the coat.
    pub normal: DVec3,
    /// Coverage, 0…1.
    pub factor: f64,
    /// Perceptual roughness.
    pub roughness: f64,
}

/// A surface at one point.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Unit normal of the base.
    pub normal: DVec3,
    /// Albedo of the Lambert layer.
    pub diffuse: DVec3,
    /// Reflectance at normal incidence.
    pub f0: DVec3,
    /// Reflectance at grazing incidence.
    pub f90: f64,
    /// Perceptual roughness of the base.
    pub roughness: f64,
    /// Anisotropy of the base.
    pub grooves: Option<Grooves>,
    /// Sheen, if there is one.
    pub sheen: Option<Sheen>,
    /// Clear coat, if there is one.
    pub coat: Option<Coat>,
}

fn mix(a: f64, b: f64, share: f64) -> f64 {
    a * (1.0 - share) + b * share
}

fn schlick(f0: f64, f90: f64, cos: f64) -> f64 {
    f0 + (f90 - f0) * (1.0 - cos).powi(5)
}

/// Returns the reflectance at the interface with glass of index 1.5, for a material with `f0` in air.
fn under_glass(f0: f64) -> f64 {
    let index = (1.0 + f0.sqrt()) / (1.0 - f0.sqrt()).max(1e-12);
    ((index - 1.5) / (index + 1.5)).powi(2)
}

/// `Surface` in the frame of its normal, for GGX with two roughness values.
struct Microfacets {
    axes: [DVec3; 3],
    alpha: [f64; 2],
}

impl Microfacets {
    fn tail(&self, w: DVec3) -> f64 {
        let [t, b, n] = self.axes;
        let slope2 = (self.alpha[0] * w.dot(t)).powi(2) + (self.alpha[1] * w.dot(b)).powi(2);
        0.5 * ((1.0 + slope2 / w.dot(n).powi(2)).sqrt() - 1.0)
    }

    /// Returns D · G / (4 n·v): the reflection of GGX with the cosine, for a Fresnel term of 1.
    fn reflected(&self, view: DVec3, to_light: DVec3) -> f64 {
        let [t, b, n] = self.axes;
        let h = (view + to_light).normalize();
        let e = (h.dot(t) / self.alpha[0]).powi(2) + (h.dot(b) / self.alpha[1]).powi(2) + h.dot(n).powi(2);
        let d = 1.0 / (PI * self.alpha[0] * self.alpha[1] * e * e);
        d / (1.0 + self.tail(view) + self.tail(to_light)) / (4.0 * view.dot(n))
    }
}

impl Surface {
    /// Returns a Lambert surface without specular reflection.
    pub fn chalk(albedo: DVec3, normal: DVec3) -> Self {
        let (f0, grooves, sheen, coat) = (DVec3::ZERO, None, None, None);
        Self { normal, diffuse: albedo, f0, f90: 0.0, roughness: 1.0, grooves, sheen, coat }
    }

    /// Returns glTF's metallic-roughness surface over a dielectric of `f0`.
    pub fn metal_rough(base_color: DVec3, metallic: f64, roughness: f64, f0: f64, normal: DVec3) -> Self {
        let f0 = DVec3::splat(f0).lerp(base_color, metallic);
        Self { f0, f90: 1.0, roughness, ..Self::chalk(base_color * (1.0 - metallic), normal) }
    }

    /// Returns f0 and perceptual roughness of the base under its coat.
    fn coated(&self) -> (DVec3, f64) {
        let Some(coat) = self.coat else { return (self.f0, self.roughness) };
        let f0 = self.f0.to_array().map(|f0| mix(f0, under_glass(f0).min(f0), coat.factor));
        (DVec3::from(f0), mix(self.roughness, self.roughness.max(coat.roughness), coat.factor))
    }

    /// Returns BRDF · cosine toward a light, times π: radiance in nits per π lux.
    pub fn per_light(&self, view: DVec3, to_light: DVec3) -> DVec3 {
        let h = (view + to_light).normalize();
        let loh = to_light.dot(h);
        let (f0, roughness) = self.coated();
        let alpha = roughness * roughness;
        let (nol, nov) = (self.normal.dot(to_light), self.normal.dot(view));
        let mut reflected = DVec3::ZERO;
        if nol > 0.0 {
            let along = self.grooves.map_or_else(|| self.normal.any_orthonormal_vector(), |g| g.along);
            let wide = self.grooves.map_or(alpha, |g| mix(alpha, 1.0, g.strength * g.strength));
            let base = Microfacets { axes: [along, self.normal.cross(along), self.normal], alpha: [wide, alpha] };
            let fresnel = f0.to_array().map(|f0| schlick(f0, self.f90, loh));
            reflected = self.diffuse * nol + DVec3::from(fresnel) * (PI * base.reflected(view, to_light));
        }
        if let Some(sheen) = self.sheen {
            reflected *= 1.0 - sheen.color.max_element() * cloth(nov, sheen.roughness);
            if nol > 0.0 {
                let inverse = 1.0 / sheen.roughness.powi(2);
                let sin2 = (1.0 - self.normal.dot(h).powi(2)).max(1.0 / 128.0);
                let d = (2.0 + inverse) * sin2.powf(0.5 * inverse) / 2.0;
                reflected += sheen.color * (d * nol / (4.0 * (nol + nov - nol * nov)));
            }
        }
        if let Some(coat) = self.coat {
            let fresnel = coat.factor * schlick(0.04, 1.0, loh);
            let (alpha2, noh) = (coat.roughness.powi(4), coat.normal.dot(h));
            let d = alpha2 / (noh * noh * (alpha2 - 1.0) + 1.0).powi(2);
            let own = d * fresnel / (4.0 * loh * loh) * coat.normal.dot(to_light).max(0.0);
            reflected = reflected * (1.0 - fresnel) + own;
        }
        reflected
    }

    /// Returns the radiance under a sky. `gathered` returns the radiance of a lobe with a direction and roughness,
    /// `irradiance` the irradiance over π for a normal. Energy lost between microfacets is compensated (Turquin).
    pub fn of_sky(
        &self,
        view: DVec3,
        gathered: impl Fn(DVec3, f64) -> DVec3,
        irradiance: impl Fn(DVec3) -> DVec3,
    ) -> DVec3 {
        let mirrored = |n: DVec3| 2.0 * n.dot(view) * n - view;
        let (f0, roughness) = self.coated();
        let nov = self.normal.dot(view);
        let [grazing, all] = ggx(nov, roughness, Masking::Smith);
        let albedo = DVec3::splat(self.f90 * grazing) + f0 * (all - grazing);
        let axis = self.grooves.map_or(self.normal, |grooves| {
            // Direction across the anisotropy; the bent normal is perpendicular to it.
            let across = self.normal.cross(grooves.along);
            let toward = (view - across * view.dot(across)).normalize();
            let bend = grooves.strength * (5.0 * roughness).min(1.0);
            self.normal.lerp(toward, bend).normalize()
        });
        let dominant = mirrored(axis).lerp(self.normal, roughness.powi(4)).normalize();
        let kept = DVec3::ONE + f0 * (1.0 / all - 1.0);
        let mut radiance = albedo * kept * gathered(dominant, roughness)
            + self.diffuse * (DVec3::ONE - albedo) * irradiance(self.normal);
        if let Some(sheen) = self.sheen {
            let share = cloth(nov, sheen.roughness);
            radiance *= 1.0 - sheen.color.max_element() * share;
            radiance += sheen.color * share * gathered(mirrored(self.normal), sheen.roughness);
        }
        if let Some(coat) = self.coat {
            let fresnel = coat.factor * schlick(0.04, 1.0, coat.normal.dot(view));
            radiance = radiance * (1.0 - fresnel) + gathered(mirrored(coat.normal), coat.roughness) * fresnel;
        }
        radiance
    }
}
