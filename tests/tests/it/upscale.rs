//! Upscaled frames: loads and stores, and filters compared with their mirrors.

use crate::stage::{self, Shot, gpu, picture};
use framegraph::{Caps, Counts, Extent, Options, Target};
use framegraph_passes::effects::upscale::sharpen::Sharpen;
use framegraph_passes::effects::upscale::{Enlarge, UpscaleFilter};
use framegraph_passes::program::Programs;
use framegraph_passes::{Settings, Upscale};
use framegraph_shader_mirrors::sharpen::sharpened;
use framegraph_shader_mirrors::upscale::upscaled;
use framegraph_wgpu::{Frame, Gpu};
use glam::{DVec2, DVec3};
use std::error::Error;
use tests::filtered::filtered;

type TestResult = Result<(), Box<dyn Error>>;

/// Returns a picture with edges in many directions, four bytes per pixel.
fn codes([width, height]: [u32; 2]) -> Vec<u8> {
    let texel = |i: u32| {
        let (x, y) = (i % width, i / width);
        let slanted = if 3 * x + 5 * y < 40 { 30 } else { 210 };
        [slanted, (37 * x + 91 * y * y) as u8, if x == y { 255 } else { 64 }, 255]
    };
    (0..width * height).flat_map(texel).collect()
}

/// Returns a pixel, clamped to the border.
fn texel(codes: &[u8], [width, height]: [u32; 2], x: i64, y: i64) -> DVec3 {
    let (x, y) = (x.clamp(0, i64::from(width) - 1), y.clamp(0, i64::from(height) - 1));
    let at = 4 * (y as usize * width as usize + x as usize);
    DVec3::new(codes[at].into(), codes[at + 1].into(), codes[at + 2].into()) / 255.0
}

fn enlarged(
    gpu: &Gpu,
    codes: &[u8],
    size: [u32; 2],
    to: [u32; 2],
    filter: UpscaleFilter,
) -> Result<Vec<u8>, Box<dyn Error>> {
    let extent = Extent::absolute(to[0], to[1]);
    let enlarge = |frame: &mut Frame<Programs>, picture| {
        Ok(frame.add("upscale", Enlarge { picture, filter, extent, into: Target::New })?.output)
    };
    filtered(gpu, codes, size, enlarge)
}

/// Compares each pixel with `mirror`, which gets its position, to within 1.5 8-bit steps.
fn compare(found: &[u8], to: [u32; 2], mirror: impl Fn(u32, u32) -> DVec3) {
    for (i, texel) in found.chunks_exact(4).enumerate() {
        let (x, y) = (i as u32 % to[0], i as u32 / to[0]);
        let found = DVec3::new(texel[0].into(), texel[1].into(), texel[2].into());
        // Half a step is rounding. The rest occurs where the weights of an edge change within a fraction of a texel.
        let off = (found - 255.0 * mirror(x, y)).abs().max_element();
        assert!(off < 1.5, "{to:?}: ({x}, {y}) is off by {off} codes");
    }
}

#[test]
fn filters_are_their_mirrors() -> TestResult {
    let Some(gpu) = gpu("filters_are_their_mirrors") else { return Ok(()) };
    for (size, to) in [([13, 9], [26, 18]), ([13, 9], [17, 23]), ([8, 8], [8, 8]), ([1, 1], [5, 3]), ([1, 7], [2, 1])] {
        let given = codes(size);
        let place = |x: u32, y: u32| {
            let [width, height] = [0, 1].map(|i| f64::from(size[i]) / f64::from(to[i]));
            DVec2::new((f64::from(x) + 0.5) * width, (f64::from(y) + 0.5) * height)
        };
        let at = |x, y| texel(&given, size, x, y);
        let bilinear = |x, y| {
            let corner = (place(x, y) - 0.5).floor();
            let (share, [i, j]) = (place(x, y) - 0.5 - corner, [corner.x as i64, corner.y as i64]);
            at(i, j).lerp(at(i + 1, j), share.x).lerp(at(i, j + 1).lerp(at(i + 1, j + 1), share.x), share.y)
        };
        compare(&enlarged(&gpu, &given, size, to, UpscaleFilter::Bilinear)?, to, bilinear);
        compare(&enlarged(&gpu, &given, size, to, UpscaleFilter::Fsr)?, to, |x, y| upscaled(at, place(x, y)));
        for (sharpness, strength) in [(1.0, 1.0), (0.5, 0.5), (0.0, 0.25)] {
            let sharpen = |frame: &mut Frame<Programs>, picture| {
                Ok(frame.add("sharpen", Sharpen { picture, into: Target::New, sharpness })?.sharp)
            };
            compare(&filtered(&gpu, &given, size, sharpen)?, size, |x, y| {
                let (x, y) = (i64::from(x), i64::from(y));
                sharpened(at(x, y), [at(x, y - 1), at(x - 1, y), at(x + 1, y), at(x, y + 1)], strength)
            });
        }
    }
    Ok(())
}

/// Uniform areas keep each 8-bit value.
#[test]
fn uniform_areas_keep_their_values() -> TestResult {
    let Some(gpu) = gpu("uniform_areas_keep_their_values") else { return Ok(()) };
    for code in (0..=255).step_by(15) {
        for filter in UpscaleFilter::ALL {
            let found = enlarged(&gpu, &[code; 4 * 12], [4, 3], [7, 8], filter)?;
            assert!(found.chunks_exact(4).all(|texel| texel[..3] == [code; 3]), "{code} by {filter:?}");
        }
    }
    Ok(())
}

/// A frame of half the width and height has the same steps with a quarter of the texels. The passes `upscale` and its
/// sharpening follow, which each store once and load nothing. The picture has the same size and brightness as without
/// upscaling.
#[test]
fn a_smaller_frame_is_shown_as_large() -> TestResult {
    let counts = |settings: Settings| stage::plan(&settings, &Caps::wgpu(), &Options::for_frame(1280, 720)).counts();
    let own = |sharpness| Settings { upscale: Some(Upscale { sharpness, ..Upscale::DEFAULT }), ..Settings::DEFAULT };
    let whole = counts(Settings::DEFAULT);
    for (sharpness, more) in [(0.0, 1), (0.9, 2)] {
        let expected = Counts {
            resolves: whole.resolves + more,
            steps: whole.steps + more,
            render_passes: whole.render_passes + more,
            passes: whole.passes + more,
            ..whole
        };
        assert_eq!(counts(own(sharpness)), expected);
    }
    let Some(gpu) = gpu("a_smaller_frame_is_shown_as_large") else { return Ok(()) };
    let mean = |codes: &[u8]| codes.iter().map(|code| f64::from(*code)).sum::<f64>() / codes.len() as f64;
    let whole = picture(&gpu, "columns", &Shot::small(Settings::DEFAULT))?;
    for filter in UpscaleFilter::ALL {
        let upscale = Some(Upscale { filter, ..Upscale::DEFAULT });
        let found = picture(&gpu, "columns", &Shot::small(Settings { upscale, ..Settings::DEFAULT }))?;
        assert_eq!(found.len(), whole.len());
        assert!((mean(&found) - mean(&whole)).abs() < 1.0, "{filter:?}: {} and {}", mean(&found), mean(&whole));
    }
    Ok(())
}
