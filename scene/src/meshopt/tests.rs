//! Streams of the meshoptimizer library, compared with its decoder; damaged streams; invalid layouts.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;

use super::{Filter, Layout, MeshoptError, Mode, decode};

struct Stream {
    name: String,
    layout: Layout,
    bytes: Vec<u8>,
    decoded: Vec<u8>,
}

/// Streams of `tests/assets/compressed`.
fn streams() -> Vec<Stream> {
    let text = include_str!("../../../tests/assets/compressed/streams.json");
    let all: Vec<Value> = serde_json::from_str(text).expect("JSON");
    let stream = |json: &Value| {
        let text = |key: &str| json[key].as_str().expect("a text");
        let bytes = |key: &str| STANDARD.decode(text(key)).expect("base64");
        let size = |key: &str| json[key].as_u64().expect("a size") as usize;
        let mode = match text("mode") {
            "ATTRIBUTES" => Mode::Attributes,
            "TRIANGLES" => Mode::Triangles,
            _ => Mode::Indices,
        };
        let filter = match text("filter") {
            "NONE" => Filter::None,
            "OCTAHEDRAL" => Filter::Octahedral,
            "QUATERNION" => Filter::Quaternion,
            "EXPONENTIAL" => Filter::Exponential,
            _ => Filter::Color,
        };
        let layout = Layout { count: size("count"), stride: size("stride"), mode, filter };
        Stream { name: text("name").into(), layout, bytes: bytes("stream"), decoded: bytes("decoded") }
    };
    all.iter().map(stream).collect()
}

/// Returns the components of filtered elements; the extension allows filters to differ by one step.
fn numbers(layout: &Layout, bytes: &[u8]) -> Vec<i32> {
    let unsigned = layout.filter == Filter::Color;
    match layout.stride {
        8 => {
            let halves = bytes.as_chunks::<2>().0.iter();
            halves
                .map(|b| if unsigned { u16::from_le_bytes(*b).into() } else { i16::from_le_bytes(*b).into() })
                .collect()
        }
        _ => bytes.iter().map(|b| if unsigned { i32::from(*b) } else { i32::from(*b as i8) }).collect(),
    }
}

#[test]
fn streams_decode_as_in_the_reference() {
    let streams = streams();
    assert_eq!(streams.len(), 35);
    for Stream { name, layout, bytes, decoded } in &streams {
        let ours = decode(layout, bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
        if matches!(layout.filter, Filter::None | Filter::Exponential) {
            assert!(ours == *decoded, "{name}: bytes differ");
            continue;
        }
        let (ours, theirs) = (numbers(layout, &ours), numbers(layout, decoded));
        let off = ours.iter().zip(&theirs).map(|(a, b)| (a - b).abs()).max();
        assert!(ours.len() == theirs.len() && off <= Some(1), "{name}: {off:?} steps apart");
    }
}

/// Version 1 has three channel modes and four byte modes; the streams use all of them.
#[test]
fn streams_cover_the_modes_of_version_1() {
    let (mut channels, mut controls) = ([false; 3], [false; 4]);
    for Stream { layout, bytes, .. } in streams().iter().filter(|s| s.bytes[0] == 0xa1) {
        let channel_count = layout.stride / 4;
        bytes[bytes.len() - channel_count..].iter().for_each(|mode| channels[usize::from(mode & 15)] = true);
        let packed = bytes[1..=channel_count].iter();
        packed.for_each(|byte| (0..4).for_each(|i| controls[usize::from(byte >> (2 * i) & 3)] = true));
    }
    assert_eq!((channels, controls), ([true; 3], [true; 4]));
}

#[test]
fn a_stream_cut_anywhere_is_an_error() {
    for Stream { name, layout, bytes, .. } in &streams() {
        for length in 0..bytes.len() {
            assert!(decode(layout, &bytes[..length]).is_err(), "{name}: {length} of {} bytes", bytes.len());
        }
        let longer: Vec<u8> = bytes[..1].iter().chain([&0]).chain(&bytes[1..]).copied().collect();
        assert!(decode(layout, &longer).is_err(), "{name}: a byte more");
    }
}

#[test]
fn flipped_bits_never_panic() {
    let (mut sound, mut broken) = (0, 0);
    for Stream { layout, bytes, .. } in &streams() {
        // Every byte of short streams, and as many of long ones.
        for place in (0..bytes.len()).step_by(bytes.len() / 200 + 1) {
            let mut damaged = bytes.clone();
            damaged[place] ^= 1 << (place % 8);
            match decode(layout, &damaged) {
                Ok(decoded) => {
                    assert_eq!(decoded.len(), layout.count * layout.stride);
                    sound += 1;
                }
                Err(_) => broken += 1,
            }
        }
    }
    // Changed values may go unnoticed, changed lengths do not.
    assert!(sound > 300 && broken > 300, "{sound} sound, {broken} broken");
}

#[test]
fn layouts_keep_the_rules_of_the_extension() {
    let check = |mode, filter, count, stride| Layout { count, stride, mode, filter }.check(usize::MAX);
    let stride = |mode, filter, stride| check(mode, filter, 3, stride);
    for valid in [4, 8, 12, 252, 256] {
        assert_eq!(stride(Mode::Attributes, Filter::None, valid), Ok(()));
        assert_eq!(stride(Mode::Attributes, Filter::Exponential, valid), Ok(()));
    }
    for invalid in [0, 2, 6, 260, usize::MAX] {
        assert!(matches!(stride(Mode::Attributes, Filter::None, invalid), Err(MeshoptError::Stride { .. })));
        assert!(stride(Mode::Attributes, Filter::Exponential, invalid).is_err());
    }
    for mode in [Mode::Triangles, Mode::Indices] {
        assert_eq!((stride(mode, Filter::None, 2), stride(mode, Filter::None, 4)), (Ok(()), Ok(())));
        assert!(matches!(stride(mode, Filter::None, 3), Err(MeshoptError::Stride { .. })));
        assert_eq!(stride(mode, Filter::Exponential, 4), Err(MeshoptError::FilterOfIndices));
    }
    for filter in [Filter::Octahedral, Filter::Color] {
        assert_eq!((stride(Mode::Attributes, filter, 4), stride(Mode::Attributes, filter, 8)), (Ok(()), Ok(())));
        assert!(stride(Mode::Attributes, filter, 12).is_err());
    }
    assert_eq!(stride(Mode::Attributes, Filter::Quaternion, 8), Ok(()));
    assert!(stride(Mode::Attributes, Filter::Quaternion, 4).is_err());
    assert!(matches!(check(Mode::Triangles, Filter::None, 4, 2), Err(MeshoptError::Count { .. })));
    assert!(matches!(check(Mode::Indices, Filter::None, 0, 2), Err(MeshoptError::Count { .. })));
    // A count that no stream can contain fails before anything is allocated.
    for (mode, count) in
        [(Mode::Attributes, usize::MAX), (Mode::Triangles, usize::MAX / 3 * 3), (Mode::Indices, usize::MAX)]
    {
        let layout = Layout { count, stride: 4, mode, filter: Filter::None };
        assert!(matches!(decode(&layout, &[0xe1; 100]), Err(MeshoptError::TooShort { .. })), "{mode:?}");
    }
}

/// Streams written by hand according to appendix A.
#[test]
fn streams_that_break_a_rule_name_it() {
    let triangles = |codes: &[u8], data: &[u8], table: [u8; 16]| {
        let layout = Layout { count: 3 * codes.len(), stride: 2, mode: Mode::Triangles, filter: Filter::None };
        decode(&layout, &[&[0xe1], codes, data, &table].concat())
    };
    assert_eq!(triangles(&[0xf0], &[], [0; 16]), Ok(vec![0, 0, 1, 0, 2, 0]));
    // The second triangle shares the last pushed edge, from 0 to 2, and uses the next vertex.
    assert_eq!(triangles(&[0xf0, 0x00], &[], [0; 16]).map(|bytes| bytes[6..].to_vec()), Ok(vec![0, 0, 2, 0, 3, 0]));
    // The byte 0 restarts at vertex 0.
    assert_eq!(triangles(&[0xf0, 0xfe], &[0], [0; 16]).map(|bytes| bytes[6..].to_vec()), Ok(vec![0, 0, 1, 0, 2, 0]));
    assert_eq!(triangles(&[0x00], &[], [0; 16]), Err(MeshoptError::BeforeFirst { triangle: 0 }));
    assert_eq!(triangles(&[0xf0, 0x05], &[], [0; 16]), Err(MeshoptError::BeforeFirst { triangle: 1 }));
    assert_eq!(triangles(&[0xfe], &[0x21], [0; 16]), Err(MeshoptError::BeforeFirst { triangle: 0 }));
    assert_eq!(triangles(&[0xf0], &[9], [0; 16]), Err(MeshoptError::Trailing { bytes: 1 }));
    assert_eq!(triangles(&[0xff], &[], [0; 16]), Err(MeshoptError::Truncated { element: 0 }));
    for (place, byte) in [(3, 0xf0), (3, 0x0f), (14, 1)] {
        let mut table = [0; 16];
        table[place] = byte;
        assert_eq!(triangles(&[0xf0], &[], table), Err(MeshoptError::Table { place, byte }));
    }
    let indices = |data: &[u8]| {
        let layout = Layout { count: 1, stride: 4, mode: Mode::Indices, filter: Filter::None };
        decode(&layout, &[&[0xd1], data, &[0; 4]].concat())
    };
    assert_eq!(indices(&[12]), Ok(vec![3, 0, 0, 0]));
    // A difference of −1 from 0 wraps.
    assert_eq!(indices(&[2]), Ok(vec![0xff; 4]));
    assert_eq!(indices(&[0xff; 6]), Err(MeshoptError::LongNumber { element: 0 }));
    let attributes = |header, mode| {
        let layout = Layout { count: 1, stride: 4, mode: Mode::Attributes, filter: Filter::None };
        decode(&layout, &[&[header, 0xaa], &[0; 19][..], &[1, 2, 3, 4, mode]].concat())
    };
    assert_eq!(attributes(0xa1, 0), Ok(vec![1, 2, 3, 4]));
    assert_eq!(attributes(0xa1, 0x52), Ok(vec![1, 2, 3, 4]));
    for mode in [3, 0x10, 0x11, 0xff] {
        assert_eq!(attributes(0xa1, mode), Err(MeshoptError::ChannelMode { channel: 0, mode }));
    }
    assert!(matches!(attributes(0xa2, 0), Err(MeshoptError::Header { found: 0xa2, .. })));
    assert!(matches!(attributes(0xa0, 0), Err(MeshoptError::TooShort { .. })));
}
