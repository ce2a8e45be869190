//! Threads of a connection: one reads the requests of the viewer, the other sends.

use super::error::RemoteError;
use super::mailbox::{Mailbox, Requested, count};
use super::message::{FromEngine, FromViewer};
use super::wire::{self, MAX_ANSWER_BYTES, MAX_REQUEST_BYTES, PATIENCE, Timed};
use std::io::Write;
use std::net::{Shutdown, TcpStream};
use std::sync::Arc;
use std::time::Duration;

/// Maximum time to read the rest of a refused peer.
const LINGER: Duration = Duration::from_millis(500);

/// Serves a connection of the viewer with an index until either side ends it.
pub(super) fn serve(stream: &TcpStream, viewer: usize, engine: &str, mailbox: &Arc<Mailbox>) {
    let ended = begin(stream, engine).and_then(|()| {
        count(&mailbox.counters.accepted);
        let connection = mailbox.attach(viewer);
        let sender = start_sender(stream, viewer, engine, mailbox);
        let ended = sender.and_then(|sender| {
            let ended = requests(stream, (viewer, connection), mailbox);
            mailbox.detach(viewer);
            if ended.is_ok() {
                // The sender may be blocked while it writes.
                let _ = stream.shutdown(Shutdown::Both);
            }
            let _ = sender.join();
            ended
        });
        mailbox.detach(viewer);
        ended
    });
    if let Err(error) = ended {
        count(&mailbox.counters.refused);
        refuse(stream, &error.to_string());
        // Closing a socket with unread bytes would discard the reason.
        let _ = stream.shutdown(Shutdown::Write);
        let mut rest = std::io::Read::take(Timed::new(stream, LINGER), MAX_REQUEST_BYTES.into());
        let _ = std::io::copy(&mut rest, &mut std::io::sink());
    }
    let _ = stream.shutdown(Shutdown::Both);
}

/// Sends the reason why a connection ends. Errors are ignored: the peer may be gone.
fn refuse(stream: &TcpStream, reason: &str) {
    let mut writer = stream;
    let _ = wire::write(&mut writer, &FromEngine::Refused { reason: reason.to_owned() }, MAX_ANSWER_BYTES);
}

/// Refuses a connection without a thread of its own. The reason fits into the buffer of the socket.
pub(super) fn refuse_full(stream: &TcpStream, mailbox: &Mailbox) {
    count(&mailbox.counters.refused);
    let mut writer = stream;
    let _ = stream.set_nonblocking(true);
    let _ = writer.write_all(&wire::hello(wire::VERSION));
    refuse(stream, "too many viewers are attached; close one");
    let _ = stream.shutdown(Shutdown::Write);
}

/// Exchanges the first bytes.
fn begin(stream: &TcpStream, engine: &str) -> Result<(), RemoteError> {
    let mut writer = stream;
    let set = stream.set_nodelay(true).and_then(|()| stream.set_write_timeout(Some(PATIENCE)));
    set.and_then(|()| writer.write_all(&wire::hello(wire::VERSION))).map_err(|error| wire::broken(&error))?;
    wire::expect_hello(&mut Timed::new(stream, PATIENCE))?;
    wire::write(&mut writer, &FromEngine::Welcome { engine: engine.into() }, MAX_ANSWER_BYTES)
}

/// Reads requests until the connection ends. Returns `Ok` if the viewer closed it between two messages.
fn requests(stream: &TcpStream, (viewer, connection): (usize, u64), mailbox: &Mailbox) -> Result<(), RemoteError> {
    loop {
        // A viewer may be silent between two messages, but not within one.
        stream.set_read_timeout(None).map_err(|error| wire::broken(&error))?;
        if !matches!(stream.peek(&mut [0]), Ok(1)) {
            return Ok(());
        }
        let FromViewer::Texture(request) = wire::read(&mut Timed::new(stream, PATIENCE), MAX_REQUEST_BYTES)?;
        mailbox.request(Requested { viewer, connection, request });
    }
}

/// Starts the thread that sends the newest data to a viewer until the connection ends.
fn start_sender(
    stream: &TcpStream,
    viewer: usize,
    engine: &str,
    mailbox: &Arc<Mailbox>,
) -> Result<std::thread::JoinHandle<()>, RemoteError> {
    let (stream, mailbox) = (stream.try_clone().map_err(|error| wire::broken(&error))?, mailbox.clone());
    let engine = engine.to_owned();
    let send = move || {
        let (mut of_plan, mut of_times) = (0, 0);
        loop {
            let mut outbox = mailbox.outbox();
            if outbox.closed || !outbox.attached[viewer] {
                break;
            }
            let plan = outbox.plan.newer(&mut of_plan);
            let times = outbox.times.newer(&mut of_times);
            let texture = outbox.textures[viewer].take();
            if plan.is_none() && times.is_none() && texture.is_none() {
                mailbox.wait(outbox);
                continue;
            }
            drop(outbox);
            let plan = plan.map(|plan| FromEngine::Plan(Box::new(plan.message(&engine).clone())));
            let times = times.map(|times| FromEngine::Times((*times).clone()));
            let texture = texture.map(FromEngine::Texture);
            for message in [plan, times, texture].into_iter().flatten() {
                // A plan that exceeds the limit of a message is not sent.
                let Ok(bytes) = wire::encode(&message, MAX_ANSWER_BYTES) else { continue };
                if (&stream).write_all(&bytes).is_err() {
                    let _ = stream.shutdown(Shutdown::Both);
                    return;
                }
                count(&mailbox.counters.sent);
            }
        }
    };
    let thread = std::thread::Builder::new().name("remote sender".into());
    thread.spawn(send).map_err(|error| RemoteError::Closed { reason: error.to_string() })
}
