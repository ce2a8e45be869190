//! Upscaled frames: sizes in plan and files, and similarity to the full-size frame.

use crate::support::{folder, refused, render};
use framegraph_scene::picture::read_rgba8;
use std::fs;
use std::path::Path;

const SHOWN: [u32; 2] = [64, 48];

/// Runs `render` with options in a folder; `None` without an adapter.
fn rendered(folder: &Path, test: &str, options: &str) -> Option<()> {
    let frame = "columns --size 64x48 --frames 1 --dither 0";
    let output = render(folder, &format!("{frame} {options}").split_whitespace().collect::<Vec<_>>());
    let message = String::from_utf8_lossy(&output.stderr);
    if message.contains("no adapter") {
        test_report::skip(test, message.trim());
        return None;
    }
    assert!(output.status.success(), "{options}: {message}");
    Some(())
}

fn codes(file: &Path) -> Vec<u8> {
    let (size, codes) = read_rgba8(file).expect("a picture was written");
    assert_eq!(size, SHOWN, "{}", file.display());
    codes
}

/// Returns the peak signal-to-noise ratio of two 8-bit pictures, in dB.
fn psnr_db(a: &[u8], b: &[u8]) -> f64 {
    let squares: f64 = a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum();
    10.0 * (255.0 * 255.0 * a.len() as f64 / squares).log10()
}

/// Returns the size of the texture `name` in a plan as text.
fn size_of(plan: &str, name: &str) -> [u32; 2] {
    let resource = plan.lines().find_map(|line| line.strip_prefix(&format!("  {name}: ")));
    let size = resource.and_then(|about| about.split_whitespace().next()).and_then(|size| size.split_once('x'));
    let sides = size.and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    sides.unwrap_or_else(|| panic!("{name} is not in:\n{plan}"))
}

/// Returns the stored bytes of a plan as text.
fn stored_bytes(plan: &str) -> u64 {
    let traffic = plan.lines().find_map(|line| line.strip_prefix("traffic: ")?.strip_suffix(" B stored"));
    traffic.and_then(|words| words.rsplit(' ').next()?.parse().ok()).expect("a plan has its traffic")
}

/// Plan and linear radiance have the rendered size. The picture has the output size and resembles the full-size frame.
#[test]
fn a_scaled_frame_is_drawn_smaller_and_shown_as_large() {
    const TEST: &str = "a_scaled_frame_is_drawn_smaller_and_shown_as_large";
    let folder = folder("scale");
    let files = |name: &str| format!("--out {name}.png --linear-out {name}.exr --plan {name}.txt");
    if rendered(&folder, TEST, &files("whole")).is_none() {
        return;
    }
    let read = |name: &str| fs::read_to_string(folder.join(name)).expect("a plan was written");
    let whole = codes(&folder.join("whole.png"));
    assert_eq!(size_of(&read("whole.txt"), "hdr"), SHOWN);
    // An upscaled picture is similar to the full-size one, but not equal.
    for (name, scale, drawn) in [("half", "0.5", [32, 24]), ("quarter", "0.25", [16, 12])] {
        for upscale in ["fsr", "bilinear"] {
            rendered(&folder, TEST, &format!("--scale {scale} --upscale {upscale} {}", files(name)));
            let plan = read(&format!("{name}.txt"));
            for texture in ["hdr", "depth", "encoded"] {
                assert_eq!(size_of(&plan, texture), drawn, "{texture} of {name}");
            }
            assert_eq!(size_of(&plan, "output"), SHOWN);
            let light = image::open(folder.join(format!("{name}.exr"))).expect("radiance was written");
            assert_eq!([light.width(), light.height()], drawn);
            let likeness = psnr_db(&codes(&folder.join(format!("{name}.png"))), &whole);
            assert!((18.0..40.0).contains(&likeness), "{name} by {upscale}: {likeness:.1} dB");
        }
    }
    // Radiance of 8 bytes per texel and encoded values of 4 have a quarter of the texels. The upscaled values are new.
    let bytes = |name: &str, scale: &str| {
        rendered(&folder, TEST, &format!("--no-shadows --inline off {scale} {}", files(name)));
        stored_bytes(&read(&format!("{name}.txt")))
    };
    let texels = u64::from(SHOWN[0] * SHOWN[1]);
    assert_eq!(bytes("all", ""), 12 * texels);
    assert_eq!(bytes("less", "--scale 0.5 --sharpness 0"), 12 * texels / 4 + 4 * texels);
    // Scale 1 equals the full-size frame, also in its bytes.
    rendered(&folder, TEST, &format!("--scale 1 {}", files("one")));
    assert_eq!(codes(&folder.join("one.png")), whole);
    assert_eq!(read("one.txt"), read("whole.txt"));
    let message = refused(&folder, &["--scale", "0.2"]);
    assert!(message.contains("--scale 0.2"), "{message}");
}

/// Each picture of a sequence equals the single picture, if nothing moves and nothing is accumulated.
#[test]
fn a_scaled_sequence_is_drawn_like_a_scaled_picture() {
    const TEST: &str = "a_scaled_sequence_is_drawn_like_a_scaled_picture";
    let folder = folder("scaled_sequence");
    if rendered(&folder, TEST, "--scale 0.5 --out one.png").is_none() {
        return;
    }
    let line = "columns --size 64x48 --dither 0 --scale 0.5 --sequence 2 .";
    let output = render(&folder, &line.split(' ').collect::<Vec<_>>());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let one = codes(&folder.join("one.png"));
    assert_eq!(codes(&folder.join("frame_0001.png")), one);
}
