//! From one number to a color that the eye can rank: the Turbo map.

/// The sRGB codes of Turbo at `x`, 0 (blue) to 1 (red); what lies outside is clamped, NaN is taken as 0.
///
/// Anton Mikhailov, "Turbo, An Improved Rainbow Colormap for Visualization", 2019, in the polynomial of fifth degree that
/// Ruofei Du fitted to its table.
pub fn turbo(x: f32) -> [u8; 3] {
    const RED: [f32; 6] = [0.135_721_38, 4.615_392_6, -42.660_322, 132.131_08, -152.942_4, 59.286_38];
    const GREEN: [f32; 6] = [0.091_402_61, 2.194_188_4, 4.842_966_5, -14.185_033, 4.277_298_5, 2.829_566];
    const BLUE: [f32; 6] = [0.106_673_3, 12.641_946, -60.582_05, 110.362_77, -89.903_11, 27.348_25];
    // `max` drops a NaN.
    let x = x.max(0.0).min(1.0);
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
        // Entries of the published table as bytes. The published fit is off by up to 32 codes at the dark end of blue.
        let table =
            [(0, [48, 18, 59]), (64, [40, 187, 236]), (128, [164, 252, 60]), (192, [251, 126, 33]), (255, [122, 4, 3])];
        for (index, expected) in table {
            let found = turbo(index as f32 / 255.0);
            let worst = found.iter().zip(expected).map(|(a, b): (&u8, u8)| a.abs_diff(b)).max();
            assert!(worst <= Some(32), "{index}: {found:?}, the table says {expected:?}");
        }
    }

    #[test]
    fn what_lies_outside_is_clamped() {
        assert_eq!((turbo(-1.0), turbo(f32::NAN)), (turbo(0.0), turbo(0.0)));
        assert_eq!((turbo(2.0), turbo(f32::INFINITY)), (turbo(1.0), turbo(1.0)));
    }
}
