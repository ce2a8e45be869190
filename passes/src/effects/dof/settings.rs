//! Settings of depth of field.

use crate::effects::depth::structure::Resolution;
use crate::settings::field::{Field, choice, number};
use crate::settings::place::{Place, flag, num, word};
use crate::settings::table::SettingsTable;
use framegraph_shaders::layout::Projection;

/// Height of the film in meters: a 35 mm frame, as in Filament.
pub const FILM_HEIGHT_M: f32 = 0.024;
/// Minimum focus distance in focal lengths.
const NEAREST_FOCUS: f32 = 1.01;

/// The lens and the quality of the gather. Defaults are Filament's, except for the aperture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct DofSettings {
    /// Focus distance from the eye plane in meters, above 0.
    pub focus_m: f32,
    /// F-number: focal length over aperture diameter, above 0; more is sharper.
    pub f_number: f32,
    /// Focal length in meters, above 0; `None` derives it from the view's angle on 24 mm film.
    pub focal_length_m: Option<f32>,
    /// Factor on circles of confusion, 0 or more; 0 disables depth of field.
    pub scale: f32,
    /// Width of a blurred point divided by its height, above 0, as of an anamorphic lens: 1 is a circle. The longer axis
    /// keeps the size of the circle of confusion. Filament's `cocAspectRatio`.
    pub squeeze: f32,
    /// Resolution of the gather.
    pub resolution: Resolution,
    /// Maximum radius of foreground circles in pixels, 0 to 32.
    pub most_before_px: f32,
    /// Maximum radius of background circles in pixels, 0 to 32.
    pub most_behind_px: f32,
    /// Rings of foreground taps, 3 to 17: one tap in the center, and eight more per ring.
    pub rings_before: u8,
    /// Rings of background taps, 3 to 17.
    pub rings_behind: u8,
    /// Rings in tiles with a single radius, 3 to 17.
    pub rings_even: u8,
    /// Removes noise of the taps with a 3×3 median.
    pub median: bool,
    /// Draws order-independent blended surfaces ([`Transparency`](crate::Transparency)) after depth of field, so they
    /// are sharp at every distance. Otherwise they are blurred with the surface behind them. Requires one sample per
    /// texel and no temporal anti-aliasing; otherwise it has no effect.
    pub blended_after: bool,
}

impl Default for DofSettings {
    /// Returns [`DofSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl DofSettings {
    /// Filament's desktop defaults, with an aperture of f/2.8 and a focus distance of 5 m.
    pub const DEFAULT: Self = Self {
        focus_m: 5.0,
        f_number: 2.8,
        focal_length_m: None,
        scale: 1.0,
        squeeze: 1.0,
        resolution: Resolution::Half,
        most_before_px: 32.0,
        most_behind_px: 32.0,
        rings_before: 5,
        rings_behind: 5,
        rings_even: 5,
        median: true,
        blended_after: false,
    };

    /// Returns true if anything can be out of focus.
    pub fn is_seen(&self) -> bool {
        self.scale > 0.0 && (self.most_before_px > 0.0 || self.most_behind_px > 0.0)
    }

    /// Returns the half axes of a blurred point, relative to the radius of the circle of confusion.
    pub fn axes(&self) -> [f32; 2] {
        let squeeze = self.squeeze.clamp(0.1, 10.0);
        [squeeze.min(1.0), squeeze.recip().min(1.0)]
    }

    /// Returns the focus distance in meters, and the circle diameter at infinity in pixels, for a picture of this
    /// height.
    pub fn lens(&self, projection: &Projection, height_px: u32) -> (f32, f32) {
        // The tangent of half the view angle is half the film height over the focal length.
        let seen = 0.5 * FILM_HEIGHT_M * projection.scale.y.abs();
        let focal = self.focal_length_m.unwrap_or(seen).clamp(1e-4, 10.0);
        let focus = self.focus_m.clamp(NEAREST_FOCUS * focal, 1e9);
        let aperture = focal / self.f_number.max(1e-3);
        let on_film = aperture * focal / (focus - focal);
        (focus, (self.scale * on_film / FILM_HEIGHT_M * height_px as f32).min(1e6))
    }
}

/// Range of numbers of rings.
const RINGS: [f64; 2] = [3.0, 17.0];

impl SettingsTable for DofSettings {
    const OPTION: &'static str = "dof";
    const PATH: &'static str = "settings.dof";
    const ABOUT: &'static str = "depth of field";
    const DEFAULT: Self = Self::DEFAULT;
    const METHODS: &'static [(&'static str, Self)] = &[("on", Self::DEFAULT)];
    const FIELDS: &'static [Field<Self>] = &[
        number("focus", "focus_m", [1e-3, 1e9], |s: &mut Self| num(&mut s.focus_m))
            .about("focus distance from the eye plane"),
        number("aperture", "f_number", [0.1, 1e3], |s: &mut Self| num(&mut s.f_number))
            .about("f-number: focal length over aperture diameter; more is sharper"),
        number("focal", "focal_length_m", [1e-3, 10.0], |s: &mut Self| {
            Place::Optional(&mut s.focal_length_m, "view", 0.028)
        })
        .about("focal length; `view` derives it from the field of view on 24 mm film"),
        number("scale", "scale", [0.0, 1e3], |s: &mut Self| num(&mut s.scale)).about("factor on circles of confusion"),
        number("squeeze", "squeeze", [0.1, 10.0], |s: &mut Self| num(&mut s.squeeze))
            .about("width of a blurred point divided by its height, as of an anamorphic lens"),
        choice("resolution", "resolution", |s: &mut Self| word(&mut s.resolution)).about("resolution of the gather"),
        number("before", "most_before_px", [0.0, 32.0], |s: &mut Self| num(&mut s.most_before_px))
            .about("maximum radius of foreground circles"),
        number("behind", "most_behind_px", [0.0, 32.0], |s: &mut Self| num(&mut s.most_behind_px))
            .about("maximum radius of background circles"),
        number("rings-before", "rings_before", RINGS, |s: &mut Self| num(&mut s.rings_before))
            .about("rings of foreground taps"),
        number("rings-behind", "rings_behind", RINGS, |s: &mut Self| num(&mut s.rings_behind))
            .about("rings of background taps"),
        number("rings-even", "rings_even", RINGS, |s: &mut Self| num(&mut s.rings_even))
            .about("rings in tiles with a single radius"),
        choice("median", "median", |s: &mut Self| flag(&mut s.median))
            .about("removes noise of the taps with a 3×3 median"),
        choice("blended", "blended_after", |s: &mut Self| Place::Switch(&mut s.blended_after, ["before", "after"]))
            .about("draws blended surfaces before or after the blur; after it, order-independent ones are sharp"),
    ];
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
        // The view angle of 50 mm on 24 mm film.
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

    #[test]
    fn the_table_describes_the_settings() {
        crate::settings::table::test::<DofSettings>();
        let text = "on:focus=2,focal=0.05,blended=after";
        let expected =
            DofSettings { focus_m: 2.0, focal_length_m: Some(0.05), blended_after: true, ..DofSettings::DEFAULT };
        assert_eq!(DofSettings::from_text(text), Ok(Some(expected)));
        let error = DofSettings::from_text("on:focal=0").expect_err("too short").to_string();
        assert_eq!(error, "focal=0: expected `view` or a number from 0.001 to 10");
    }
}
