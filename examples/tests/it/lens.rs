//! Lens dirt and dynamic resolution.

use crate::support::{folder, refused, render};
use framegraph_scene::picture::{encode_png, read_rgba8};
use std::fs::File;
use std::path::Path;

/// Returns the picture that `render` writes in `folder`; `None` without an adapter.
fn picture(folder: &Path, test: &str, args: &[&str]) -> Option<Vec<u8>> {
    let output = render(folder, args);
    let message = String::from_utf8_lossy(&output.stderr);
    if message.contains("no adapter") {
        test_report::skip(test, message.trim());
        return None;
    }
    assert!(output.status.success(), "{args:?}: {message}");
    Some(read_rgba8(&folder.join("render.png")).expect("a picture was written").1)
}

/// Sums the color channels over the left or right half.
fn half(rgba8: &[u8], width: usize, right: bool) -> u64 {
    let texels = rgba8.chunks_exact(4).enumerate().filter(|(at, _)| (at % width >= width / 2) == right);
    texels.flat_map(|(_, texel)| &texel[..3]).map(|code| u64::from(*code)).sum()
}

#[test]
fn bloom_comes_through_what_is_white_of_the_dirt() -> Result<(), Box<dyn std::error::Error>> {
    const TEST: &str = "bloom_comes_through_what_is_white_of_the_dirt";
    const SIZE: [u32; 2] = [64, 48];
    let folder = folder("lens_dirt");
    // Black on the left and white on the right, with one texel per pixel, so that nothing is interpolated.
    let texel = |at: u32| if at % SIZE[0] < SIZE[0] / 2 { [0, 0, 0, 255] } else { [255; 4] };
    let dirt: Vec<u8> = (0..SIZE[0] * SIZE[1]).flat_map(texel).collect();
    encode_png(&mut File::create(folder.join("dirt.png"))?, SIZE, &dirt)?;
    let frame = "spheres --size 64x48 --frames 1 --msaa 1 --no-fxaa --dither 0";
    let of = |more: &str| {
        let line = format!("{frame} {more}");
        picture(&folder, TEST, &line.trim_end().split(' ').collect::<Vec<_>>())
    };
    let Some(plain) = of("") else { return Ok(()) };
    let bloom = "--bloom on:strength=0.5,blend=add,dirt=1,threshold=off";
    let clean = of(bloom).ok_or("an adapter was there")?;
    let through = of(&format!("{bloom} --dirt dirt.png")).ok_or("an adapter was there")?;
    let sums = |right| [&plain, &through, &clean].map(|picture| half(picture, 64, right));
    let ([dark, behind_black, glow], [dim, behind_white, shine]) = (sums(false), sums(true));
    assert!(glow > dark + dark / 50 && shine > dim + dim / 50, "bloom is seen: {dark}, {glow}; {dim}, {shine}");
    assert!(behind_black.abs_diff(dark) <= dark / 500, "nothing comes through black: {dark}, {behind_black}");
    assert!(behind_white.abs_diff(shine) <= shine / 500, "all comes through white: {shine}, {behind_white}");
    let message = refused(&folder, &["--bloom", "on", "--dirt", "nowhere.png"]);
    assert!(message.contains("nowhere.png"), "{message}");
    Ok(())
}

/// An unreachable frame time ends at the minimum scale, a generous one at full size. Pictures always have the requested
/// size.
#[test]
fn frames_are_drawn_as_large_as_their_time_lets_them_be() {
    const TEST: &str = "frames_are_drawn_as_large_as_their_time_lets_them_be";
    let folder = folder("dynamic_resolution");
    for (target, least) in [("0.001:40", "rendered at 40 to 100 %"), ("100000:40", "rendered at 100 to 100 %")] {
        let line = format!("spheres --size 64x48 --turntable 24 . --dynamic-resolution {target}");
        let output = render(&folder, &line.split(' ').collect::<Vec<_>>());
        let (message, out) = (String::from_utf8_lossy(&output.stderr), String::from_utf8_lossy(&output.stdout));
        if message.contains("no adapter") {
            return test_report::skip(TEST, message.trim());
        }
        assert!(output.status.success(), "{message}");
        assert!(out.contains(least) && out.contains(" ms, target "), "{target}: {out}");
        for index in [0, 23] {
            let file = folder.join(format!("turntable_{index:04}.png"));
            assert_eq!(read_rgba8(&file).expect("a picture was written").0, [64, 48]);
        }
    }
}
