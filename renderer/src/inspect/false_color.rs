//! The Turbo color map.

/// Returns the sRGB color of the Turbo map at `x`, 0 (blue) to 1 (red), as 8-bit values. Values outside are clamped;
/// NaN is 0.
///
/// Source: Anton Mikhailov, "Turbo, An Improved Rainbow Colormap for Visualization", 2019, as the fifth-degree
/// polynomial fitted by Ruofei Du.
pub(super) fn turbo(x: f32) -> [u8; 3] {
    const RED: [f64; 6] = [0.135_721_38, 4.615_392_60, -42.660_322_58, 132.131_082_34, -152.942_393_96, 59.286_379_43];
    const GREEN: [f64; 6] = [0.091_402_61, 2.194_188_39, 4.842_966_58, -14.185_033_33, 4.277_298_57, 2.829_566_04];
    const BLUE: [f64; 6] = [0.106_673_30, 12.641_946_08, -60.582_048_36, 110.362_767_71, -89.903_109_12, 27.348_249_73];
    let x = if x.is_nan() { 0.0 } else { f64::from(x).clamp(0.0, 1.0) };
    [RED, GREEN, BLUE].map(|polynomial| {
        let value = polynomial.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient);
        (value.clamp(0.0, 1.0) * 255.0).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_goes_from_blue_over_green_to_red() {
        // Entries of the published table. The polynomial differs by up to 32 steps at the dark end of blue.
        let table =
            [(0, [48, 18, 59]), (64, [40, 187, 236]), (128, [164, 252, 60]), (192, [251, 126, 33]), (255, [122, 4, 3])];
        for (index, expected) in table {
            let found = turbo(index as f32 / 255.0);
            let worst = found.iter().zip(expected).map(|(a, b): (&u8, u8)| a.abs_diff(b)).max();
            assert!(worst <= Some(32), "{index}: {found:?}, the table says {expected:?}");
        }
    }

    #[test]
    fn values_outside_are_clamped() {
        assert_eq!((turbo(-1.0), turbo(f32::NAN)), (turbo(0.0), turbo(0.0)));
        assert_eq!((turbo(2.0), turbo(f32::INFINITY)), (turbo(1.0), turbo(1.0)));
    }
}
