//! Baking of looks into tables, on the CPU.

use super::by::{TableDesc, TableFormat};
use super::error::GradingError;
use super::look::{Extras, Look};
use framegraph_scene::parallel::in_parallel;
use framegraph_shaders::reference::grading::linear_from_log_c;
use framegraph_shaders::reference::table::table_coordinates;
use glam::DVec3;
use half::f16;
use std::ops::ControlFlow;

/// Look baked into a table: maps LogC of linear Rec.709 to sRGB encoded colors.
#[derive(Clone, Debug, PartialEq)]
pub struct Baked {
    /// Entries along each axis.
    pub entries: usize,
    /// True for three axes; otherwise each channel has a curve along one axis.
    pub cube: bool,
    /// Number format of the entries.
    pub format: TableFormat,
    /// Entries in upload order, red fastest.
    pub bytes: Vec<u8>,
}

impl Baked {
    /// Evaluates the look at each entry, with one thread per core.
    ///
    /// # Errors
    /// Fails as [`Look::function`] does.
    pub fn new(look: &Look, extras: &Extras, desc: TableDesc) -> Result<Self, GradingError> {
        let function = look.function(extras)?;
        let cube = !look.keeps_channels_apart(extras);
        let (entries, format) =
            if cube { (usize::from(desc.entries), desc.format) } else { (TableDesc::CURVE_ENTRIES, TableFormat::Half) };
        let light = |index: usize| linear_from_log_c(DVec3::splat(index as f64 / (entries - 1) as f64)).x.max(0.0);
        let axis: Vec<f64> = (0..entries).map(light).collect();
        let at = |r: usize, g: usize, b: usize| pack(function(DVec3::new(axis[r], axis[g], axis[b])), format);
        let bytes = if cube {
            let mut slices = vec![Vec::new(); entries];
            let slice = |b: &usize, ()| -> Vec<u8> {
                (0..entries * entries).flat_map(|i| at(i % entries, i / entries, *b)).collect()
            };
            let places: Vec<usize> = (0..entries).collect();
            in_parallel(
                &places,
                |_| (),
                slice,
                |b, made| {
                    slices[b] = made;
                    ControlFlow::Continue(())
                },
            );
            slices.concat()
        } else {
            (0..entries).flat_map(|i| at(i, i, i)).collect()
        };
        Ok(Self { entries, cube, format, bytes })
    }

    /// Returns the entry at these indices, as the device reads it.
    pub fn entry(&self, [r, g, b]: [usize; 3]) -> DVec3 {
        let index = r + self.entries * (g + self.entries * b);
        match self.format {
            TableFormat::Rgb10 => {
                let bytes: [u8; 4] = std::array::from_fn(|i| self.bytes[4 * index + i]);
                let bits = u32::from_le_bytes(bytes);
                DVec3::from_array([0, 10, 20].map(|shift| f64::from(bits >> shift & 1023) / 1023.0))
            }
            TableFormat::Half => {
                let channel =
                    |c: usize| f16::from_le_bytes([self.bytes[8 * index + 2 * c], self.bytes[8 * index + 2 * c + 1]]);
                DVec3::new(channel(0).to_f64(), channel(1).to_f64(), channel(2).to_f64())
            }
        }
    }

    /// Returns the sRGB encoded color that the table gives for linear Rec.709. `tetrahedral` interpolates between four
    /// entries; otherwise between eight, as texture filtering does.
    pub fn sample(&self, color: DVec3, tetrahedral: bool) -> DVec3 {
        let last = self.entries - 1;
        let at = table_coordinates(color, self.entries as f64) * self.entries as f64 - 0.5;
        let at = at.clamp(DVec3::ZERO, DVec3::splat(last as f64));
        let below = at.to_array().map(|x| (x as usize).min(last - 1));
        let share: [f64; 3] = std::array::from_fn(|c| at[c] - below[c] as f64);
        if !self.cube {
            let entry = |c: usize, step: usize| self.entry([below[c] + step, 0, 0])[c];
            let channel = |c: usize| entry(c, 0) * (1.0 - share[c]) + entry(c, 1) * share[c];
            return DVec3::new(channel(0), channel(1), channel(2));
        }
        if tetrahedral {
            // Walks from the near corner along the axes, largest fraction first.
            let mut order = [0, 1, 2];
            order.sort_by(|a, b| share[*b].total_cmp(&share[*a]));
            let mut place = below;
            let mut sum = self.entry(place) * (1.0 - share[order[0]]);
            for (step, axis) in order.into_iter().enumerate() {
                place[axis] += 1;
                sum += self.entry(place) * (share[axis] - order.get(step + 1).map_or(0.0, |next| share[*next]));
            }
            return sum;
        }
        let corner = |corner: usize| {
            let step = [corner & 1, corner >> 1 & 1, corner >> 2];
            let weight = |c: usize| if step[c] == 1 { share[c] } else { 1.0 - share[c] };
            self.entry(std::array::from_fn(|c| below[c] + step[c])) * (weight(0) * weight(1) * weight(2))
        };
        (0..8).map(corner).sum()
    }
}

/// Packs a color into the bytes of an entry.
fn pack(codes: DVec3, format: TableFormat) -> Vec<u8> {
    match format {
        TableFormat::Rgb10 => {
            let [r, g, b] = codes.to_array().map(|x| (x * 1023.0).round() as u32);
            (r | g << 10 | b << 20 | 3 << 30).to_le_bytes().to_vec()
        }
        TableFormat::Half => {
            let [r, g, b] = codes.to_array().map(f16::from_f64);
            [r, g, b, f16::ONE].into_iter().flat_map(f16::to_le_bytes).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grading::OwnCurve;
    use framegraph_shaders::layout::{Grading, ToneMap};

    const DESC: TableDesc = TableDesc { entries: 16, format: TableFormat::Half };

    #[test]
    fn channels_that_do_not_mix_take_one_axis() -> Result<(), GradingError> {
        let none = Extras::default();
        let cube =
            |look: Look| Baked::new(&look, &none, DESC).map(|baked| (baked.cube, baked.entries, baked.bytes.len()));
        let filmic = Look { tone_map: ToneMap::Filmic, ..Look::default() };
        let contrast = Grading { contrast: 1.3, ..Grading::NEUTRAL };
        assert_eq!(cube(filmic)?, (false, 1024, 8192));
        assert_eq!(cube(Look { grading: contrast, ..filmic })?, (false, 1024, 8192));
        for mixed in [
            Look { grading: Grading { saturation: 1.3, ..Grading::NEUTRAL }, ..filmic },
            Look { grading: contrast, tone_map: ToneMap::Linear, ..filmic },
            Look { luminance_scaling: true, ..filmic },
            Look { tone_map: ToneMap::Hill, ..filmic },
        ] {
            assert_eq!(cube(mixed)?, (true, 16, 8 * 16 * 16 * 16), "{mixed:?}");
        }
        Ok(())
    }

    #[test]
    fn entries_are_the_look_itself() -> Result<(), GradingError> {
        let none = Extras::default();
        let grading = Grading { temperature: 0.4, saturation: 1.2, ..Grading::NEUTRAL };
        let look = Look { grading, tone_map: ToneMap::Aces, ..Look::default() };
        for format in TableFormat::ALL {
            let baked = Baked::new(&look, &none, TableDesc { format, ..DESC })?;
            // Entry 0 lies below black, which no light reaches.
            for place in [[1, 1, 1], [15, 15, 15], [3, 9, 12], [15, 1, 7]] {
                let light = place.map(|i| linear_from_log_c(DVec3::splat(i as f64 / 15.0)).x.max(0.0));
                let expected = look.function(&none)?(DVec3::from_array(light));
                assert!((baked.entry(place) - expected).abs().max_element() < 6e-4, "{format:?} {place:?}");
                for tetrahedral in [false, true] {
                    let found = baked.sample(DVec3::from_array(light), tetrahedral);
                    assert!((found - baked.entry(place)).abs().max_element() < 1e-9, "{place:?} {found}");
                }
            }
        }
        Ok(())
    }

    /// The curve halves codes, and the table behind it swaps red and blue.
    #[test]
    fn a_file_with_a_curve_and_a_table_is_baked_with_both() -> Result<(), Box<dyn std::error::Error>> {
        let file = "LUT_1D_SIZE 2\nLUT_3D_SIZE 2\n0 0 0\n0.5 0.5 0.5\n\
            0 0 0\n0 0 1\n0 1 0\n0 1 1\n1 0 0\n1 0 1\n1 1 0\n1 1 1\n";
        let colors = framegraph_scene::ColorTable::load_bytes("a.cube".as_ref(), file.as_bytes())?;
        let extras = Extras { colors: Some(std::sync::Arc::new(colors)), ..Extras::default() };
        let look = Look { tone_map: ToneMap::Linear, ..Look::default() };
        let shown = look.function(&extras)?(DVec3::new(1.0, 0.0, 0.0));
        assert!((shown - DVec3::new(0.0, 0.0, 0.5)).length() < 1e-9, "{shown}");
        let baked = Baked::new(&look, &extras, DESC)?;
        // The last entry is white and brighter: code 1 of each channel.
        assert!(baked.cube && (baked.entry([15, 15, 15]) - 0.5).length() < 1e-9);
        assert!((baked.entry([15, 0, 0]) - DVec3::new(0.0, 0.0, 0.5)).length() < 1e-9);
        Ok(())
    }

    #[test]
    fn a_curve_of_ones_own_is_baked_and_asked_for() -> Result<(), GradingError> {
        let look = Look { tone_map: ToneMap::Own, ..Look::default() };
        assert_eq!(Baked::new(&look, &Extras::default(), DESC), Err(GradingError::NoOwnCurve));
        let own = |curve| Extras { own: Some(curve), ..Extras::default() };
        let halved = own(OwnCurve::new(|c| c * 0.5));
        let shown = look.function(&halved)?(DVec3::splat(0.5));
        let linear = Look { tone_map: ToneMap::Linear, ..look };
        assert!((shown - linear.function(&Extras::default())?(DVec3::splat(0.25))).length() < 1e-6, "{shown}");
        let broken = own(OwnCurve::new(|c| c / 0.0 - c / 0.0));
        assert!(look.function(&broken)?(DVec3::ONE).is_finite());
        assert!(look.is_direct(&halved).is_err() && linear.is_direct(&halved).is_ok());
        Ok(())
    }
}
