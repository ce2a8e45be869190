//! Connection of a viewer to an engine.

use super::error::RemoteError;
use super::message::{FromEngine, FromViewer};
use super::wire::{self, MAX_ANSWER_BYTES, MAX_REQUEST_BYTES, PATIENCE, Timed};
use std::io::Write;
use std::net::{Shutdown, TcpStream, ToSocketAddrs};
use std::time::Duration;

/// Maximum time from the first byte of an engine's message to its last.
const LONG_PATIENCE: Duration = Duration::from_secs(60);

/// Connection to the [`Server`](super::Server) of an engine.
#[derive(Debug)]
pub struct Connection {
    stream: TcpStream,
    engine: String,
}

impl Connection {
    /// Connects to `HOST:PORT` and waits for the welcome, at most [`PATIENCE`] for each step.
    ///
    /// # Errors
    /// No engine at the address, another program, another version of the protocol, or a refusal.
    pub fn open(address: &str) -> Result<Self, RemoteError> {
        let failed = |reason: String| RemoteError::Address { address: address.to_owned(), reason };
        let mut last = failed("the address is unknown".into());
        for candidate in address.to_socket_addrs().map_err(|error| failed(error.to_string()))? {
            match TcpStream::connect_timeout(&candidate, PATIENCE) {
                Ok(stream) => return Self::begin(stream),
                Err(error) => last = failed(error.to_string()),
            }
        }
        Err(last)
    }

    /// Exchanges the first bytes.
    fn begin(mut stream: TcpStream) -> Result<Self, RemoteError> {
        let set = stream.set_nodelay(true).and_then(|()| stream.set_write_timeout(Some(PATIENCE)));
        set.and_then(|()| stream.write_all(&wire::hello(wire::VERSION))).map_err(|error| wire::broken(&error))?;
        let mut timed = Timed::new(&stream, PATIENCE);
        wire::expect_hello(&mut timed)?;
        match wire::read(&mut timed, MAX_ANSWER_BYTES)? {
            FromEngine::Welcome { engine } => Ok(Self { stream, engine }),
            FromEngine::Refused { reason } => Err(RemoteError::Refused { reason }),
            _ => Err(RemoteError::Malformed { reason: "expected a welcome".into() }),
        }
    }

    /// Returns the name of the engine.
    pub fn engine(&self) -> &str {
        &self.engine
    }

    /// Returns another handle of the connection, for another thread.
    ///
    /// # Errors
    /// The system has no more handles.
    pub fn try_clone(&self) -> Result<Self, RemoteError> {
        let stream = self.stream.try_clone().map_err(|error| wire::broken(&error))?;
        Ok(Self { stream, engine: self.engine.clone() })
    }

    /// Waits for the next message. The engine may be silent between messages, but not within one.
    ///
    /// # Errors
    /// An invalid message, or a closed connection. The connection cannot be used afterwards.
    pub fn receive(&self) -> Result<FromEngine, RemoteError> {
        self.stream.set_read_timeout(None).map_err(|error| wire::broken(&error))?;
        match self.stream.peek(&mut [0]) {
            Ok(1) => {}
            Ok(_) => return Err(RemoteError::Closed { reason: "the engine ended it".into() }),
            Err(error) => return Err(wire::broken(&error)),
        }
        match wire::read(&mut Timed::new(&self.stream, LONG_PATIENCE), MAX_ANSWER_BYTES)? {
            FromEngine::Refused { reason } => Err(RemoteError::Refused { reason }),
            message => Ok(message),
        }
    }

    /// Sends a message.
    ///
    /// # Errors
    /// A closed connection, or a message that exceeds [`MAX_REQUEST_BYTES`].
    pub fn send(&self, message: &FromViewer) -> Result<(), RemoteError> {
        wire::write(&mut &self.stream, message, MAX_REQUEST_BYTES)
    }

    /// Ends the connection, also for other handles. A waiting [`receive`](Self::receive) returns.
    pub fn close(&self) {
        let _ = self.stream.shutdown(Shutdown::Both);
    }
}
