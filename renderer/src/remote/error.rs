//! Errors of connections.

use std::fmt;

/// Error of a connection between engine and viewer.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum RemoteError {
    /// No connection to the address, or the address cannot be listened on.
    #[error("{address}: {reason}; start the engine with its server first, and check the port")]
    Address {
        /// Host and port.
        address: String,
        /// Error of the system.
        reason: String,
    },
    /// The other side is no engine and no viewer of this library.
    #[error("the other side does not speak this protocol; check the port")]
    Foreign,
    /// The other side has another version of the protocol.
    #[error("protocol version {theirs}, expected {ours}; build the viewer and the engine from one release")]
    Version {
        /// Version of the other side.
        theirs: u32,
        /// Version of this library.
        ours: u32,
    },
    /// A message exceeds the limit.
    #[error("a message of {bytes} bytes exceeds the limit of {max} bytes")]
    TooLong {
        /// Announced size in bytes.
        bytes: u64,
        /// Limit in bytes.
        max: u64,
    },
    /// A message cannot be decoded.
    #[error("invalid message: {reason}")]
    Malformed {
        /// Error of the decoder.
        reason: String,
    },
    /// The other side sent nothing, or half a message, for too long.
    #[error("no complete message within {seconds} s")]
    Silent {
        /// Limit in seconds.
        seconds: u64,
    },
    /// The engine refused the connection.
    #[error("the engine refused the connection: {reason}")]
    Refused {
        /// Reason that the engine gave.
        reason: String,
    },
    /// The connection was closed or broke.
    #[error("the connection is closed: {reason}")]
    Closed {
        /// Error of the system.
        reason: String,
    },
}

impl fmt::Debug for RemoteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
