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
}

impl<'s> Timed<'s> {
    pub(super) fn new(stream: &'s TcpStream, patience: Duration) -> Self {
        Self { stream, end: Instant::now() + patience }
    }
}

impl Read for Timed<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = self.end.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        self.stream.set_read_timeout(Some(left))?;
        let mut stream = self.stream;
        stream.read(buffer)
    }
}

/// Converts an error of the system.
pub(super) fn broken(error: &io::Error) -> RemoteError {
    match error.kind() {
        // Unix reports a timeout of a socket as `WouldBlock`.
        ErrorKind::TimedOut | ErrorKind::WouldBlock => RemoteError::Silent { seconds: PATIENCE.as_secs() },
        _ => RemoteError::Closed { reason: error.to_string() },
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
