//! Decoders and encoders compared with those of the `image` crate, and rejected sizes.

#[cfg(all(feature = "webp", feature = "basisu", feature = "png"))]
mod textures;

use std::io::Cursor;

use image::{DynamicImage, ImageFormat};

use super::*;

/// Twelve by seven texels in which every channel takes many values, including the extremes.
fn picture() -> DynamicImage {
    let texel = |x: u32, y: u32| {
        let spread = |seed: u32| (x * 5003 + y * 9173 + seed * 21_001) % 65_536;
        image::Rgba([0, 1, 2, 3].map(|seed| if x == 11 { 65_535 * (y % 2) } else { spread(seed) } as u16))
    };
    DynamicImage::ImageRgba16(image::ImageBuffer::from_fn(12, 7, texel))
}

fn encoded(picture: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).expect("writing to memory");
    bytes.into_inner()
}

#[cfg(feature = "png")]
#[test]
fn png_of_every_layout_decodes_as_elsewhere() {
    let full = picture();
    let layouts = [
        full.clone(),
        full.to_rgb16().into(),
        full.to_luma_alpha16().into(),
        full.to_luma16().into(),
        full.to_rgba8().into(),
        full.to_rgb8().into(),
        full.to_luma_alpha8().into(),
        full.to_luma8().into(),
    ];
    for layout in layouts {
        let bytes = encoded(&layout, ImageFormat::Png);
        let ours = decode_8(&bytes, 12).expect("a good file");
        let theirs = image::load_from_memory(&bytes).expect("a good file").into_rgba8();
        assert_eq!(ours.size_texels, [12, 7]);
        assert!(ours.rgba8 == *theirs.as_raw(), "{:?}", layout.color());
    }
}

/// A palette with two-bit indices and transparency.
#[cfg(feature = "png")]
#[test]
fn palettes_become_colors() {
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, 4, 1);
    encoder.set_color(::png::ColorType::Indexed);
    encoder.set_depth(::png::BitDepth::Two);
    encoder.set_palette(vec![1, 2, 3, 4, 5, 6, 7, 8, 9]);
    encoder.set_trns(vec![10, 20]);
    let mut writer = encoder.write_header().expect("writing to memory");
    writer.write_image_data(&[0b00_01_10_00]).expect("writing to memory");
    drop(writer);
    let picture = decode_8(&bytes, 4).expect("a good file");
    assert_eq!(picture.rgba8, [1, 2, 3, 10, 4, 5, 6, 20, 7, 8, 9, 255, 1, 2, 3, 10]);
}

#[cfg(feature = "png")]
#[test]
fn png_is_written_as_elsewhere() {
    let codes = picture().to_rgba8();
    let mut bytes = Vec::new();
    png::encode(&mut bytes, [12, 7], &codes).expect("writing to memory");
    assert_eq!(bytes, encoded(&codes.clone().into(), ImageFormat::Png));
}

#[cfg(feature = "jpeg")]
#[test]
fn jpeg_decodes_as_elsewhere() {
    for layout in [DynamicImage::from(picture().to_rgb8()), picture().to_luma8().into()] {
        let bytes = encoded(&layout, ImageFormat::Jpeg);
        let ours = decode_8(&bytes, 12).expect("a good file");
        assert_eq!(ours.size_texels, [12, 7]);
        assert_eq!(ours.rgba8, image::load_from_memory(&bytes).expect("a good file").into_rgba8().into_raw());
    }
}

/// Radiance over the whole range of exponents, from subnormal numbers to the largest.
#[test]
fn radiance_decodes_as_elsewhere() {
    let texel =
        |x: u32, y: u32| image::Rgb([0.9, 0.5, 0.1].map(|c: f32| c * (x as f32 * 3.7 + y as f32 * 0.9 - 127.0).exp2()));
    let rows = DynamicImage::ImageRgb32F(image::ImageBuffer::from_fn(68, 3, texel));
    let runs = DynamicImage::ImageRgb32F(image::ImageBuffer::from_fn(300, 2, |_, y| image::Rgb([y as f32, 0.25, 7.0])));
    for picture in [rows, runs] {
        compare_radiance(&encoded(&picture, ImageFormat::Hdr));
    }
    let header = b"#?RADIANCE\n# made by hand\nFORMAT=32-bit_rle_rgbe\nEXPOSURE= 2\n\n-Y 2 +X 301\n";
    // Whole texels: 1, then 300 repeats encoded as 44 + 256, then literal texels and a repeat.
    let first = [[9, 8, 7, 130], [1, 1, 1, 44], [1, 1, 1, 1]];
    let second = [[[5, 6, 7, 120]; 2].as_slice(), &[[1, 1, 1, 200], [3, 3, 3, 0], [1, 1, 1, 98]]].concat();
    compare_radiance(&[header, first.as_flattened(), second.as_flattened()].concat());
}

fn compare_radiance(bytes: &[u8]) {
    let ours = decode_f32(bytes, [512, 512]).expect("a good file");
    let theirs = image::load_from_memory_with_format(bytes, ImageFormat::Hdr).expect("a good file").into_rgba32f();
    assert_eq!(ours.size_texels, [theirs.width(), theirs.height()]);
    assert_eq!(ours.rgba.as_flattened(), theirs.as_raw());
}

#[test]
fn broken_radiance_says_why() {
    let with = |rest: &[u8]| [b"#?RADIANCE\n\n".as_slice(), rest].concat();
    for (bytes, expected) in [
        (b"#?RGBE\n\n-Y 1 +X 1\n5555".to_vec(), HdrError::Signature),
        (b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n".to_vec(), HdrError::Format),
        (b"#?RADIANCE\n".to_vec(), HdrError::CutShort),
        (with(b"+Y 1 +X 1\n"), HdrError::Size),
        (with(b"-Y 1 +X 1 1\n"), HdrError::Size),
        (with(b"-Y 1 +X 1\n\x05\x05\x05"), HdrError::CutShort),
        (with(b"-Y 1 +X 2\n\x01\x01\x01\x01"), HdrError::Run { row: 0 }),
        (with(b"-Y 2 +X 1\n\x05\x05\x05\x05\x02\x02\x00\x01\x82\x07"), HdrError::Run { row: 1 }),
        (with(b"-Y 1 +X 2\n\x05\x05\x05\x05\x01\x01\x01\x02"), HdrError::Run { row: 0 }),
    ] {
        match decode_f32(&bytes, [8, 8]).map(|_| ()) {
            Err(CodecError::Hdr(error)) => assert_eq!(error, expected),
            other => panic!("{expected:?}: {other:?}"),
        }
    }
}

#[cfg(feature = "exr")]
#[test]
fn openexr_decodes_and_is_written_as_elsewhere() {
    let light = picture().to_rgba32f();
    let theirs = encoded(&light.clone().into(), ImageFormat::OpenExr);
    let mut ours = Cursor::new(Vec::new());
    let texels: Vec<[f32; 4]> = light.pixels().map(|p| p.0).collect();
    exr::encode(&mut ours, [12, 7], &texels).expect("writing to memory");
    assert_eq!(*ours.get_ref(), theirs);
    let rgb = encoded(&picture().to_rgb32f().into(), ImageFormat::OpenExr);
    for bytes in [theirs, rgb] {
        // Tiles are 64 texels wide, regardless of the image size.
        let decoded = decode_f32(&bytes, [64, 64]).expect("a good file");
        let expected = image::load_from_memory(&bytes).expect("a good file").into_rgba32f();
        assert_eq!(decoded.size_texels, [12, 7]);
        assert_eq!(decoded.rgba.as_flattened(), expected.as_raw());
    }
}

#[test]
fn sizes_over_the_limit_are_refused_before_anything_is_decoded() {
    let full = picture();
    let files = [
        #[cfg(feature = "png")]
        encoded(&full, ImageFormat::Png),
        #[cfg(feature = "jpeg")]
        encoded(&full.to_rgb8().into(), ImageFormat::Jpeg),
        encoded(&full.to_rgb32f().into(), ImageFormat::Hdr),
        #[cfg(feature = "exr")]
        encoded(&full.to_rgb32f().into(), ImageFormat::OpenExr),
    ];
    for bytes in files {
        let refused = match FileKind::of(&bytes) {
            Some(FileKind::Png | FileKind::Jpeg) => decode_8(&bytes, 11).map(|_| ()),
            _ => decode_f32(&bytes, [11, 7]).map(|_| ()),
        };
        let error = refused.expect_err("twelve texels are too wide").to_string();
        assert!(error.contains("width") && error.ends_with("is 12, over the limit of 11"), "{error}");
    }
}

#[test]
fn other_kinds_are_told_apart_and_named() {
    let error = decode_8(b"GIF89a", 8).map(|_| ()).expect_err("it is not read").to_string();
    assert_eq!(error, "GIF images are not supported here");
    assert!(matches!(decode_8(b"", 8), Err(CodecError::NoBytes)));
    assert!(matches!(decode_f32(b"hello", [8, 8]), Err(CodecError::Unknown)));
}
