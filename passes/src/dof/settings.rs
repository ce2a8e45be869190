//! What depth of field is made of.

use crate::structure::Resolution;
use framegraph_shaders::layout::Projection;

/// Height of the film in m: that of a frame of 35 mm, as in Filament.
pub const FILM_HEIGHT_M: f32 = 0.024;
/// What is in focus is at least so many focal lengths away: a lens has nothing nearer in focus.
const NEAREST_FOCUS: f32 = 1.01;

/// The lens, and how it is gathered. Defaults are Filament's, but for the aperture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct DofSettings {
    /// Distance of what is in focus, in m from the eye's plane, above 0.
    pub focus_m: f32,
    /// The f-number: focal length over diameter of the aperture, above 0; more is sharper.
    pub f_number: f32,
    /// Focal length in m, above 0; none is that of the view's angle on film of 24 mm.
    pub focal_length_m: Option<f32>,
    /// Factor on circles of confusion, 0 or more; 0 leaves depth of field out.
    pub scale: f32,
    /// Size of what is gathered.
    pub resolution: Resolution,
    /// The largest radius of a circle before what is in focus, in pixels, 0 to 32.
    pub most_before_px: f32,
    /// The largest radius of a circle behind it, in pixels, 0 to 32.
    pub most_behind_px: f32,
    /// Rings of taps before what is in focus, 3 to 17: one in the middle, and eight more a ring.
    pub rings_before: u8,
    /// Rings behind it, 3 to 17.
    pub rings_behind: u8,
    /// Rings where all circles of a tile are alike, 3 to 17.
    pub rings_even: u8,
    /// A median of three by three texels takes out what taps leave over.
    pub median: bool,
    /// Blended surfaces that need no order ([`Transparency`](crate::Transparency)) are drawn over the blurred picture: they are
    /// sharp, at every distance. Off, they are blurred like what is behind them. Asks for one sample per texel and no
    /// anti-aliasing over time; otherwise it has no effect.
    pub blended_after: bool,
}

impl Default for DofSettings {
    /// [`DofSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl DofSettings {
    /// Filament's on desktops, at an aperture of f/2.8 and 5 m.
    pub const DEFAULT: Self = Self {
        focus_m: 5.0,
        f_number: 2.8,
        focal_length_m: None,
        scale: 1.0,
        resolution: Resolution::Half,
        most_before_px: 32.0,
        most_behind_px: 32.0,
        rings_before: 5,
        rings_behind: 5,
        rings_even: 5,
        median: true,
        blended_after: false,
    };

    /// Whether anything is out of focus.
    pub fn is_seen(&self) -> bool {
        self.scale > 0.0 && (self.most_before_px > 0.0 || self.most_behind_px > 0.0)
    }

    /// Distance in focus in m, and the diameter in pixels that what is infinitely far away has, in a picture of that height.
    pub fn lens(&self, projection: &Projection, height_px: u32) -> (f32, f32) {
        // tan of half the view's angle is half of the film over the focal length.
        let seen = 0.5 * FILM_HEIGHT_M * projection.scale.y.abs();
        let focal = self.focal_length_m.unwrap_or(seen).clamp(1e-4, 10.0);
        let focus = self.focus_m.clamp(NEAREST_FOCUS * focal, 1e9);
        let aperture = focal / self.f_number.max(1e-3);
        let on_film = aperture * focal / (focus - focal);
        (focus, (self.scale * on_film / FILM_HEIGHT_M * height_px as f32).min(1e6))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat4, DVec4};

    fn seen(fov_rad: f64) -> Projection {
        let scale = (0.5 * fov_rad).tan().recip();
        Projection::new(&DMat4::from_cols(DVec4::X * scale / 1.5, DVec4::Y * scale, -DVec4::W, DVec4::Z * 0.1))
    }

    /// 50 mm at f/2, focused at 2 m: 25 mm · 50 / (2000 − 50) = 0.641 mm on film.
    #[test]
    fn circles_are_those_of_the_lens() {
        let settings = DofSettings { focus_m: 2.0, f_number: 2.0, focal_length_m: Some(0.05), ..DofSettings::DEFAULT };
        let (focus, diameter) = settings.lens(&seen(1.0), 1000);
        assert!(focus == 2.0 && (diameter - 26.709).abs() < 0.01, "{diameter}");
        // The angle of 50 mm on 24 mm of film.
        let fov = 2.0 * (0.012_f64 / 0.05).atan();
        let of_view = DofSettings { focal_length_m: None, ..settings }.lens(&seen(fov), 1000);
        assert!((of_view.1 - diameter).abs() < 0.01, "{of_view:?}");
    }

    #[test]
    fn hard_case_54_nothing_nearer_than_the_focal_length_is_in_focus() {
        for focus_m in [0.0, 0.05, 0.05 + 1e-7, 1e-6, 1e30] {
            for f_number in [0.0, 1e-6, 1.4] {
                let settings = DofSettings { focus_m, f_number, focal_length_m: Some(0.05), ..DofSettings::DEFAULT };
                let (focus, diameter) = settings.lens(&seen(1.0), 1080);
                assert!(
                    focus >= 0.05 * NEAREST_FOCUS && diameter.is_finite() && diameter >= 0.0,
                    "{focus_m}: {diameter}"
                );
            }
        }
    }
}
