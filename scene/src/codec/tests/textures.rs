//! Compressed textures under `tests/textures`, compared with their source images and reference decoders.

use std::collections::BTreeMap;

use super::super::*;
use crate::texture::ImageFormat;

const MAX: u32 = 4096;
const NONE: BlockFormats = BlockFormats { bc7: false, etc2: false, astc: false };
const ALL: BlockFormats = BlockFormats { bc7: true, etc2: true, astc: true };

fn read(name: &str) -> Vec<u8> {
    let path = crate::test_files::file(&format!("textures/{name}")).expect("it is committed");
    std::fs::read(path).expect("it can be read")
}

/// Decodes a PNG file to RGBA with another decoder.
fn png(name: &str) -> Vec<u8> {
    image::load_from_memory(&read(name)).expect("a good file").into_rgba8().into_raw()
}

fn decoded(name: &str, formats: BlockFormats) -> TextureLevels {
    let bytes = read(name);
    let texture = decode_texture(&bytes, MAX, formats).unwrap_or_else(|error| panic!("{name}: {error}"));
    let header = texture_header(&bytes, MAX, formats).expect("it was read");
    let size_bytes: usize = texture.levels.iter().map(Vec::len).sum();
    assert_eq!((header.size_texels, header.image_bytes), (texture.size_texels, size_bytes as u64), "{name}");
    texture
}

/// Peak signal-to-noise ratio of 8-bit channels, in dB.
fn psnr_db(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let square: f64 = a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum();
    10.0 * (255.0 * 255.0 * a.len() as f64 / square).log10()
}

/// ETC1S has one 5-bit color per block with four brightness steps, so its error is that of the encoder. Measured: 41.1
/// dB for ETC1S, at least 48.1 dB for UASTC, and 48.9 dB for lossy WebP.
#[test]
fn textures_are_close_to_their_sources() {
    for (name, source, least_db) in [
        ("color_etc1s.ktx2", "color.png", 41.0),
        ("opaque_etc1s.ktx2", "opaque.png", 41.0),
        ("color_uastc.ktx2", "color.png", 48.0),
        ("color_one_level.ktx2", "color.png", 48.0),
        ("odd_uastc.ktx2", "odd.png", 48.0),
        ("normal_uastc.ktx2", "normal.png", 48.0),
        ("color_lossy.webp", "color.png", 48.0),
        ("opaque_lossy.webp", "opaque.png", 48.0),
    ] {
        let found = psnr_db(&decoded(name, NONE).levels[0], &png(source));
        assert!(found >= least_db && found.is_finite(), "{name}: {found:.1} dB");
    }
    let other = psnr_db(&png("color.png"), &png("normal.png"));
    assert!(other < 20.0, "other pictures are far apart: {other:.1} dB");
}

#[test]
fn lossless_textures_equal_their_sources() {
    for (name, source) in [
        ("color_lossless.webp", "color.png"),
        ("color_rgba8.ktx2", "color.png"),
        ("opaque_rgb8.ktx2", "opaque.png"),
        ("normal.png", "normal.png"),
    ] {
        let texture = decoded(name, ALL);
        assert_eq!((texture.size_texels, texture.format, texture.levels.len()), ([64, 64], ImageFormat::Rgba8, 1));
        assert!(texture.levels[0] == png(source), "{name}");
    }
}

/// libwebp and the reference transcoder of Basis Universal decoded the same files.
#[test]
fn textures_equal_the_reference_decoders() {
    for name in
        ["color_etc1s", "opaque_etc1s", "color_uastc", "odd_uastc", "normal_uastc", "color_lossy", "opaque_lossy"]
    {
        let file = format!("{name}.{}", if name.ends_with("lossy") { "webp" } else { "ktx2" });
        assert!(decoded(&file, NONE).levels[0] == png(&format!("{name}.expected.png")), "{name}");
    }
}

/// FNV-1a hash of 64 bits over all levels.
fn hash(levels: &[Vec<u8>]) -> u64 {
    let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    levels.iter().flatten().fold(0xcbf2_9ce4_8422_2325, step)
}

/// Every level in every format, compared with hashes of the reference transcoder's output.
#[test]
fn blocks_equal_the_reference_transcoder() {
    let lines = String::from_utf8(read("levels.txt")).expect("text");
    let mut compared = BTreeMap::new();
    for line in lines.lines() {
        let [name, target, levels, expected] = line.split(' ').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let (format, formats) = match target {
            "rgba8" => (ImageFormat::Rgba8, NONE),
            "bc7" => (ImageFormat::Bc7, BlockFormats { bc7: true, ..NONE }),
            "etc2" => (ImageFormat::Etc2Rgba8, BlockFormats { etc2: true, ..NONE }),
            "astc" => (ImageFormat::Astc4x4, BlockFormats { astc: true, ..NONE }),
            _ => panic!("{line}"),
        };
        let texture = decoded(name, formats);
        if texture.format != format {
            // Rejected files have one of several levels, or partial blocks.
            assert!(name.starts_with("odd") || name.starts_with("color_one_level"), "{line}");
            assert_eq!(texture.format, ImageFormat::Rgba8);
            continue;
        }
        assert_eq!(texture.levels.len().to_string(), levels, "{line}");
        assert_eq!(format!("{:016x}", hash(&texture.levels)), expected, "{line}");
        *compared.entry(format).or_insert(0) += 1;
    }
    assert_eq!(compared.into_values().collect::<Vec<_>>(), [7, 5, 5, 4]);
}

/// The format that is closest to the source comes first.
#[test]
fn the_best_format_is_chosen() {
    let without = |format| BlockFormats {
        bc7: format != ImageFormat::Bc7,
        etc2: format != ImageFormat::Etc2Rgba8,
        astc: format != ImageFormat::Astc4x4,
    };
    assert_eq!(decoded("color_etc1s.ktx2", ALL).format, ImageFormat::Etc2Rgba8);
    assert_eq!(decoded("color_etc1s.ktx2", without(ImageFormat::Etc2Rgba8)).format, ImageFormat::Bc7);
    assert_eq!(decoded("color_uastc.ktx2", ALL).format, ImageFormat::Astc4x4);
    assert_eq!(decoded("color_uastc.ktx2", without(ImageFormat::Astc4x4)).format, ImageFormat::Bc7);
}

#[test]
fn supercompression_changes_no_texel() {
    let plain = decoded("color_uastc.ktx2", ALL).levels;
    for name in ["color_uastc_zstd.ktx2", "color_uastc_zlib.ktx2"] {
        assert!(decoded(name, ALL).levels == plain, "{name}");
    }
}

/// Returns a KTX2 file with a number in its header overwritten.
fn with_u32(name: &str, at: usize, value: u32) -> Vec<u8> {
    let mut bytes = read(name);
    bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
    bytes
}

#[test]
fn broken_textures_say_why() {
    let error = |bytes: &[u8]| match decode_texture(bytes, MAX, ALL) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("it is broken"),
    };
    let name = "color_uastc.ktx2";
    for (bytes, expected) in [
        (with_u32(name, 12, 145), "its texels are of Vulkan format 145 and color model 166; write Basis"),
        (with_u32(name, 20, MAX + 4), "width in texels is 4100, over the limit of 4096"),
        (with_u32(name, 24, 0), "its size is 64×0"),
        (with_u32(name, 36, 6), "it has 6 faces, depth 0 and 0 layers; write it as a single 2D image"),
        (with_u32(name, 40, 8), "it has 8 levels, more than a side of 64 texels has"),
        (with_u32(name, 44, 1), "its supercompression scheme is 1; write BasisLZ for ETC1S"),
        (with_u32("color_etc1s.ktx2", 44, 2), "its supercompression scheme is 2"),
        (with_u32(name, 20, 128), "level 0 has 4096 bytes, not 8192"),
        (with_u32("color_uastc_zstd.ktx2", 96, 1), "level 0 has 1 bytes, not 4096"),
        (read(name)[..3000].to_vec(), "it ends within its levels"),
        (read(name)[..100].to_vec(), "it ends within its data format descriptor"),
        (read("color_lossy.webp")[..200].to_vec(), ""),
    ] {
        let found = error(&bytes);
        assert!(found.contains(expected), "{found} / {expected}");
    }
    // A zlib stream whose checksum is wrong.
    let mut broken = read("color_uastc_zlib.ktx2");
    *broken.last_mut().expect("it is long") ^= 1;
    assert_eq!(error(&broken), "level 0 does not decompress to 4096 bytes");
}

/// The header claims sixteen gigabytes; both reading it and decoding fail.
#[test]
fn large_sizes_are_refused_before_they_are_allocated() {
    let mut ktx = with_u32("color_etc1s.ktx2", 20, 1 << 17);
    ktx[24..28].copy_from_slice(&(1_u32 << 15).to_le_bytes());
    let mut webp = read("opaque_lossy.webp");
    webp[26..30].copy_from_slice(&[0xff, 0x3f, 0xff, 0x3f]);
    for bytes in [ktx, webp] {
        let header = texture_header(&bytes, MAX, ALL).map(|_| ()).expect_err("it is too large");
        let decoded = decode_texture(&bytes, MAX, ALL).map(|_| ()).expect_err("it is too large");
        assert!(matches!(header, CodecError::TooLarge { .. }), "{header}");
        assert_eq!(header.to_string(), decoded.to_string());
    }
    // The frame of a WebP image may claim another size than the image: 16 texels, but 16,383 in the frame.
    let mut extended = read("color_lossy.webp");
    assert_eq!(&extended[12..16], b"VP8X");
    let at = extended.windows(4).position(|name| name == b"VP8 ").expect("it is lossy");
    extended[at + 14..at + 18].copy_from_slice(&[0xff, 0x3f, 0xff, 0x3f]);
    let error = decode_texture(&extended, MAX, ALL).map(|_| ()).expect_err("sizes differ").to_string();
    assert_eq!(error, "its size is 64×64, but that of its frame is 16383×16383");
}

/// Deterministic pseudo-random numbers (SplitMix64).
fn random(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Damaged files decode to levels of the right size, or fail with a one-line error.
#[test]
fn damaged_textures_never_panic() {
    let mut state = 1;
    let (mut good, mut bad) = (0, 0);
    for name in [
        "odd_uastc.ktx2",
        "color_etc1s.ktx2",
        "opaque_etc1s.ktx2",
        "color_uastc_zstd.ktx2",
        "color_uastc_zlib.ktx2",
        "color_lossy.webp",
        "color_lossless.webp",
    ] {
        let whole = read(name);
        for round in 0..60 {
            let mut bytes = whole.clone();
            if round % 4 == 0 {
                bytes.truncate(random(&mut state) as usize % whole.len());
            }
            for _ in 0..round % 4 * 2 {
                // Half of the damage affects the header and the index.
                let reach = if random(&mut state).is_multiple_of(2) { 300.min(bytes.len()) } else { bytes.len() };
                let at = random(&mut state) as usize % reach;
                bytes[at] ^= 1 << (random(&mut state) % 8);
            }
            let formats = if round % 3 == 0 { NONE } else { BlockFormats { bc7: round % 3 == 1, ..ALL } };
            match decode_texture(&bytes, 256, formats) {
                Ok(TextureLevels { size_texels, format, levels }) => {
                    let sizes = (0..).map(|level| crate::texture::level_size(size_texels, level));
                    assert!(
                        levels.iter().zip(sizes).all(|(level, size)| level.len() as u64 == format.level_bytes(size))
                    );
                    good += 1;
                }
                Err(error) => {
                    assert!(!error.to_string().contains('\n'), "{name}: {error}");
                    bad += 1;
                }
            }
        }
    }
    assert!(good > 30 && bad > 100, "{good} decoded, {bad} failed");
}
