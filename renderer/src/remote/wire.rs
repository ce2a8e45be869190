//! Encoding of messages, with limits on size and time.

use super::error::RemoteError;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// First bytes of each side.
pub const MAGIC: [u8; 8] = *b"FGREMOTE";
/// Version of the protocol, which changes with the form of any message.
pub const VERSION: u32 = 1;
/// Maximum size of a message of a viewer, in bytes.
pub const MAX_REQUEST_BYTES: u32 = 4096;
/// Maximum size of a message of an engine, in bytes.
pub const MAX_ANSWER_BYTES: u32 = 512 << 20;
/// Maximum time for the first bytes of a peer, and from the first byte of a message to its last.
pub const PATIENCE: Duration = Duration::from_secs(5);

/// A stream whose reads fail after a deadline.
pub(super) struct Timed<'s> {
    stream: &'s TcpStream,
    end: Instant,
    patience: Duration,
}

impl<'s> Timed<'s> {
    pub(super) fn new(stream: &'s TcpStream, patience: Duration) -> Self {
        Self { stream, end: Instant::now() + patience, patience }
    }
}

impl Read for Timed<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let silent = || io::Error::new(ErrorKind::TimedOut, RemoteError::Silent { seconds: self.patience.as_secs() });
        let left = self.end.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(silent());
        }
        self.stream.set_read_timeout(Some(left))?;
        let mut stream = self.stream;
        stream.read(buffer).map_err(|error| if is_timeout(&error) { silent() } else { error })
    }
}

/// Returns `true` for a timeout of a socket, which Unix reports as `WouldBlock`.
fn is_timeout(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock)
}

/// Converts an error of the system. [`Timed`] reports its own limit; writes wait for [`PATIENCE`].
pub(super) fn broken(error: &io::Error) -> RemoteError {
    let own = error.get_ref().and_then(|own| own.downcast_ref::<RemoteError>());
    match own {
        Some(own) => own.clone(),
        None if is_timeout(error) => RemoteError::Silent { seconds: PATIENCE.as_secs() },
        None => RemoteError::Closed { reason: error.to_string() },
    }
}

/// Returns the first bytes of a side with a version.
pub(super) fn hello(version: u32) -> [u8; 12] {
    let mut bytes = [0; 12];
    bytes[..8].copy_from_slice(&MAGIC);
    bytes[8..].copy_from_slice(&version.to_le_bytes());
    bytes
}

/// Reads and checks the first bytes of the other side.
///
/// # Errors
/// Foreign peers, other versions, silence, and closed connections.
pub(super) fn expect_hello(from: &mut impl Read) -> Result<(), RemoteError> {
    // The magic number is compared byte by byte, so that a foreign peer is not waited for.
    let mut byte = [0];
    for expected in MAGIC {
        from.read_exact(&mut byte).map_err(|error| broken(&error))?;
        if byte != [expected] {
            return Err(RemoteError::Foreign);
        }
    }
    let mut version = [0; 4];
    from.read_exact(&mut version).map_err(|error| broken(&error))?;
    match u32::from_le_bytes(version) {
        VERSION => Ok(()),
        theirs => Err(RemoteError::Version { theirs, ours: VERSION }),
    }
}

/// Reads a message of at most `max` bytes. Memory grows with the bytes that arrive, not with the announced size.
///
/// # Errors
/// Messages that are too long, incomplete or invalid, silence, and closed connections.
pub(super) fn read<T: DeserializeOwned>(from: &mut impl Read, max: u32) -> Result<T, RemoteError> {
    let mut length = [0; 4];
    from.read_exact(&mut length).map_err(|error| broken(&error))?;
    let length = u32::from_le_bytes(length);
    if length > max {
        return Err(RemoteError::TooLong { bytes: length.into(), max: max.into() });
    }
    let mut bytes = Vec::new();
    let read = from.take(length.into()).read_to_end(&mut bytes).map_err(|error| broken(&error))?;
    if read < length as usize {
        return Err(RemoteError::Closed { reason: "a message is incomplete".into() });
    }
    let malformed = |reason: String| RemoteError::Malformed { reason };
    match postcard::take_from_bytes(&bytes) {
        Ok((message, [])) => Ok(message),
        Ok((_, rest)) => Err(malformed(format!("{} unused bytes", rest.len()))),
        Err(error) => Err(malformed(error.to_string())),
    }
}

/// Encodes a message with its size.
///
/// # Errors
/// Messages that exceed `max` bytes.
pub(super) fn encode(message: &impl Serialize, max: u32) -> Result<Vec<u8>, RemoteError> {
    let malformed = |error: postcard::Error| RemoteError::Malformed { reason: error.to_string() };
    let mut bytes = postcard::to_extend(message, vec![0; 4]).map_err(malformed)?;
    let length = (bytes.len() - 4) as u64;
    let fits = u32::try_from(length).ok().filter(|length| *length <= max);
    let length = fits.ok_or(RemoteError::TooLong { bytes: length, max: max.into() })?;
    bytes[..4].copy_from_slice(&length.to_le_bytes());
    Ok(bytes)
}

/// Encodes and writes a message.
///
/// # Errors
/// Messages that exceed `max` bytes, and closed connections.
pub(super) fn write(to: &mut impl Write, message: &impl Serialize, max: u32) -> Result<(), RemoteError> {
    to.write_all(&encode(message, max)?).map_err(|error| broken(&error))
}

#[cfg(test)]
mod tests {
    use super::super::message::{
        FrameSample, FromEngine, FromViewer, RemotePlan, RemoteTexture, StepSample, TextureRequest,
    };
    use super::*;
    use framegraph::{Aspect, Caps, Format, Options};

    /// SplitMix64 (Steele, Lea, Flood 2014).
    fn random(state: &mut u64) -> u64 {
        *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = *state;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    fn request() -> FromViewer {
        FromViewer::Texture(TextureRequest {
            number: 7,
            text: "hdr@color:1".into(),
            aspect: Aspect::All,
            sample: Some(2),
        })
    }

    fn plan() -> FromEngine {
        let text = |text: &str| text.to_owned();
        FromEngine::Plan(Box::new(RemotePlan {
            compilation: 3,
            json: text("{}"),
            graph: text("()"),
            caps: Caps::wgpu(),
            options: Options::default(),
            declared_at: vec![text("src/main.rs:1:2")],
        }))
    }

    #[test]
    fn messages_are_decoded_as_encoded() {
        let mut forms = Vec::new();
        for message in answers() {
            let bytes = encode(&message, MAX_ANSWER_BYTES).expect("it is short");
            assert_eq!(read::<FromEngine>(&mut bytes.as_slice(), MAX_ANSWER_BYTES), Ok(message));
            // Values of a plan are defaults, which change without the form.
            let is_plan = bytes[4] == 2;
            forms.push((bytes.len(), if is_plan { 0 } else { hash(&bytes) }));
        }
        let bytes = encode(&request(), MAX_REQUEST_BYTES).expect("it is short");
        assert_eq!(read::<FromViewer>(&mut bytes.as_slice(), MAX_REQUEST_BYTES), Ok(request()));
        forms.push((bytes.len(), hash(&bytes)));
        // Messages describe no fields. A change of these numbers requires another `VERSION`.
        assert_eq!((VERSION, forms.as_slice()), (1, FORMS.as_slice()), "a message changed: raise `VERSION`");
    }

    /// Returns one message of each kind, with a different value in each field.
    fn answers() -> [FromEngine; 6] {
        let texture = |number, title| RemoteTexture {
            number,
            title,
            format: Format::Rgba16Float,
            aspect: Aspect::Depth,
            size: [300, 2],
            bits: vec![1, 2, 3],
        };
        let step = |cpu_ms, gpu_ms| StepSample { cpu_ms, gpu_ms };
        [
            FromEngine::Welcome { engine: "engine".into() },
            FromEngine::Refused { reason: "reason".into() },
            plan(),
            FromEngine::Times(FrameSample {
                frame: 400,
                compilation: 3,
                cpu_ms: Some(0.25),
                gpu_ms: None,
                steps: vec![step(Some(0.5), None), step(None, Some(0.75))],
            }),
            FromEngine::Texture(texture(500, Ok("title".into()))),
            FromEngine::Texture(texture(501, Err("error".into()))),
        ]
    }

    /// FNV-1a of 64 bits (Fowler, Noll, Vo).
    fn hash(bytes: &[u8]) -> u64 {
        bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
    }

    /// Size and hash of [`answers`] and [`request`]; no hash of the plan.
    const FORMS: [(usize, u64); 7] = [
        (12, 0x1e4c_e21e_2fc4_ed6d),
        (12, 0x3ee2_3044_e725_dbf2),
        (3392, 0),
        (39, 0xe405_6b13_7c81_7a55),
        (23, 0x0f7f_094e_42cf_83ab),
        (23, 0x8086_a1e9_c1e9_783b),
        (21, 0x3bc8_c5a0_70af_1335),
    ];

    #[test]
    fn silence_is_reported_with_its_limit() {
        let listener = std::net::TcpListener::bind("127.0.0.1:0").expect("a free port");
        let stream = TcpStream::connect(listener.local_addr().expect("it is bound")).expect("it listens");
        let error = Timed::new(&stream, Duration::ZERO).read(&mut [0]).map_err(|error| broken(&error));
        assert_eq!(error, Err(RemoteError::Silent { seconds: 0 }));
        let patience = Duration::from_millis(1030);
        let error = read::<FromEngine>(&mut Timed::new(&stream, patience), MAX_ANSWER_BYTES);
        assert_eq!(error, Err(RemoteError::Silent { seconds: 1 }));
    }

    #[test]
    fn sizes_and_beginnings_are_checked() {
        let too_long = RemoteError::TooLong { bytes: u32::MAX.into(), max: 4096 };
        assert_eq!(read::<FromViewer>(&mut [0xff; 9].as_slice(), MAX_REQUEST_BYTES), Err(too_long));
        let mut more = encode(&request(), MAX_REQUEST_BYTES).expect("it is short");
        more[0] += 1;
        more.push(0);
        let unused = RemoteError::Malformed { reason: "1 unused bytes".into() };
        assert_eq!(read::<FromViewer>(&mut more.as_slice(), MAX_REQUEST_BYTES), Err(unused));
        let long = "x".repeat(MAX_REQUEST_BYTES as usize);
        assert!(matches!(encode(&long, MAX_REQUEST_BYTES), Err(RemoteError::TooLong { .. })));
        assert_eq!(expect_hello(&mut hello(VERSION).as_slice()), Ok(()));
        assert_eq!(expect_hello(&mut hello(9).as_slice()), Err(RemoteError::Version { theirs: 9, ours: VERSION }));
        assert_eq!(expect_hello(&mut b"GET / HTTP/1.1\r\n".as_slice()), Err(RemoteError::Foreign));
        assert!(matches!(expect_hello(&mut MAGIC.as_slice()), Err(RemoteError::Closed { .. })));
    }

    #[test]
    fn random_and_damaged_messages_give_errors() {
        let mut state = 40;
        let valid =
            [encode(&request(), MAX_REQUEST_BYTES), encode(&plan(), MAX_ANSWER_BYTES)].map(|b| b.expect("short"));
        let (mut decoded, mut refused) = (0, 0);
        for case in 0..4000 {
            let mut bytes = valid[case % 2].clone();
            match case % 3 {
                0 => {
                    let body = (random(&mut state) % 64) as usize;
                    bytes = (body as u32).to_le_bytes().to_vec();
                    bytes.extend((0..body).map(|_| random(&mut state) as u8));
                }
                1 => bytes.truncate((random(&mut state) % bytes.len() as u64) as usize),
                _ => {
                    let at = (random(&mut state) % bytes.len() as u64) as usize;
                    bytes[at] ^= 1 << (random(&mut state) % 8);
                }
            }
            let results = [
                read::<FromViewer>(&mut bytes.as_slice(), MAX_REQUEST_BYTES).map(drop),
                read::<FromEngine>(&mut bytes.as_slice(), MAX_ANSWER_BYTES).map(drop),
            ];
            for result in results {
                match result {
                    Ok(()) => decoded += 1,
                    Err(error) => {
                        refused += 1;
                        assert!(!error.to_string().is_empty() && !error.to_string().contains('\n'));
                    }
                }
            }
        }
        assert!(refused > 4000 && decoded > 0, "{refused} refused, {decoded} decoded");
    }
}
