//! Radiance and OpenEXR files: clean, lossy and damaged.

use crate::environment::clean::clean;
use crate::environment::*;
use crate::progress::silent;
use crate::test_files;

#[test]
fn cleaning_counts_each_texel_once() {
    let mut texels = [
        [1.0, 2.0, 3.0, 0.5],
        [-1.0, f32::NAN, 0.0, 1.0],
        [f32::INFINITY, 1.0, f32::NEG_INFINITY, 1.0],
        [-4.0, -0.5, 2.0, 1.0],
        [1e20, 0.0, 0.0, 1.0],
        [-0.0, 0.0, 0.0, f32::NAN],
    ];
    let cleaning = clean(&mut texels);
    assert_eq!(cleaning, Cleaning { non_finite: 2, negative: 1, lowest: -4.0, excessive: 1 });
    assert_eq!(cleaning.clamped(), 4);
    assert_eq!(texels[0], [1.0, 2.0, 3.0, 1.0]);
    assert_eq!(texels[1], [0.0, 0.0, 0.0, 1.0]);
    assert_eq!(texels[2], [65504.0, 1.0, 0.0, 1.0]);
    assert_eq!(texels[3], [0.0, 0.0, 2.0, 1.0]);
    assert_eq!(texels[4], [MAX_RADIANCE, 0.0, 0.0, 1.0]);
}

/// A clean map and its lossy copy, which warns with the number of repaired texels. After the repair both are equal
/// except for the sun, whose red and green are lost in the copy.
#[test]
fn real_maps_load_and_the_negative_one_says_so() {
    let (Some(hdr), Some(exr)) =
        (test_files::file("assets/hdri/park.hdr"), test_files::file("assets/hdri/park_negative.exr"))
    else {
        return;
    };
    let park = Environment::load(&hdr, &mut silent).expect("a good file");
    assert_eq!((park.map.width(), park.map.height()), (512, 256));
    assert!(park.warnings.is_empty(), "{:?}", park.warnings);
    let negative = Environment::load(&exr, &mut silent).expect("a file with negative texels");
    assert_eq!(negative.warnings.len(), 1);
    let warning = &negative.warnings[0];
    assert!(warning.contains("of 131072 texels had negative radiance (lowest -1876"), "{warning}");
    let count: usize =
        warning.split(&[':', ' ']).find_map(|word| word.parse().ok()).expect("the warning begins with a count");
    assert!(count > 0);
    assert!(negative.map.texels().iter().flatten().all(|c| c.is_finite() && *c >= 0.0));
    // Radiance away from the sun is below 50.
    let rest = |map: &Environment| -> f64 {
        let sum: f32 = map.map.texels().iter().map(|texel| texel[1]).filter(|green| *green < 50.0).sum();
        f64::from(sum)
    };
    let ratio = rest(&negative) / rest(&park);
    // The copy lacks the green of 20 sun texels with about 19 each, of a sum of 26700.
    assert!((0.98..1.0).contains(&ratio), "{ratio}");
    let sun = |map: &Environment| {
        let brightest = |a: &&[f32; 4], b: &&[f32; 4]| a[2].total_cmp(&b[2]);
        *map.map.texels().iter().max_by(brightest).expect("a texel")
    };
    let [r, g, b, _] = sun(&park);
    assert!(r > g && g > b && b > 1e4, "the repaired sun is warm: {r} {g} {b}");
    assert!(sun(&negative)[0] < 1.0, "the sun of the twin is blue");
}

#[test]
fn damaged_environment_files_are_one_line_errors() {
    let folder = std::env::temp_dir().join(format!("scene-environment-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let load = |name: &str, bytes: &[u8]| {
        let file = folder.join(name);
        std::fs::write(&file, bytes).expect("a temporary file");
        Environment::load(&file, &mut silent)
    };
    let header = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    let with = |rest: &[u8]| [header.as_slice(), rest].concat();
    for (name, bytes, word) in [
        ("empty.hdr", Vec::new(), "empty"),
        ("text.hdr", b"hello".to_vec(), "neither Radiance"),
        ("header.hdr", header.to_vec(), "environment"),
        ("zero.hdr", with(b"-Y 0 +X 0\n"), "0×0"),
        ("bomb.hdr", with(b"-Y 60000 +X 60000\n"), "over the limit of 16384"),
        ("short.hdr", with(b"-Y 64 +X 128\n\x02\x02\x00\x80"), "environment"),
        ("short.exr", vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0], "environment"),
    ] {
        let error = load(name, &bytes).expect_err(name).to_string();
        assert!(error.contains(name) && error.contains(word), "{error}");
        assert!(!error.contains('\n'), "{error}");
    }
    let missing = Environment::load(&folder.join("missing.hdr"), &mut silent);
    assert!(missing.expect_err("no such file").to_string().contains("missing.hdr"));
    std::fs::remove_dir_all(&folder).expect("the folder is ours");
}

/// A data window of billions of texels around a small image, found by random damage: the decoder tried to allocate 27
/// GB.
#[test]
fn a_data_window_without_bound_is_refused() {
    let image = image::Rgba32FImage::from_pixel(8, 4, image::Rgba([1.0; 4]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::OpenExr).expect("writing to memory");
    let mut bytes = bytes.into_inner();
    let name = b"dataWindow\0box2i\0";
    let at = bytes.windows(name.len()).position(|w| w == name).expect("every OpenEXR file has a data window")
        + name.len()
        + 4;
    let folder = std::env::temp_dir().join(format!("scene-window-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let file = folder.join("window.exr");
    std::fs::write(&file, &bytes).expect("a temporary file");
    assert!(Environment::load(&file, &mut silent).is_ok());
    bytes[at + 8..at + 12].copy_from_slice(&0x1000_0000_u32.to_le_bytes());
    std::fs::write(&file, &bytes).expect("a temporary file");
    let error = Environment::load(&file, &mut silent).expect_err("too wide").to_string();
    assert!(error.contains("window.exr: environment: does not decode: width of the data window"), "{error}");
    std::fs::remove_dir_all(&folder).expect("the folder is ours");
}

/// Truncated and bit-flipped real files load or return an error, without a panic. Loaded maps are finite and not
/// negative.
#[test]
fn damaged_real_maps_never_panic() {
    for name in ["assets/hdri/venice.hdr", "assets/hdri/park_negative.exr"] {
        let Some(path) = test_files::file(name) else {
            continue;
        };
        let good = std::fs::read(&path).expect("the file is there");
        let folder = std::env::temp_dir().join(format!("scene-maps-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a temporary folder");
        let file = folder.join("map");
        let mut state = 1_u64;
        let mut random = |below: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) as usize % below
        };
        let mut refused = 0;
        for round in 0..40 {
            let mut bytes = good.clone();
            if round % 4 == 0 {
                bytes.truncate(random(good.len()));
            } else {
                // Half of the damage affects the headers, which matter most.
                let span = if round % 2 == 0 { 400 } else { good.len() };
                for _ in 0..3 {
                    bytes[random(span)] = random(256) as u8;
                }
            }
            std::fs::write(&file, &bytes).expect("a temporary file");
            match Environment::load(&file, &mut silent) {
                Ok(environment) => {
                    let texels = environment.map.texels();
                    assert!(texels.iter().flatten().all(|c| c.is_finite() && *c >= 0.0));
                }
                Err(error) => {
                    refused += 1;
                    assert!(!error.to_string().contains('\n'));
                }
            }
        }
        assert!(refused > 5, "{name}: {refused} refused");
        std::fs::remove_dir_all(&folder).expect("the folder is ours");
    }
}
