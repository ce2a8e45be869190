//! The server: accepts viewers, and takes data from the frame without waiting.

use super::error::RemoteError;
use super::mailbox::{MAX_VIEWERS, Mailbox, RemoteCounts};
use super::message::{FrameSample, StepSample};
use super::peer;
use super::textures::Textures;
use crate::execute::executor::Executor;
use crate::frame::Frame;
use crate::frame_loop::FrameLoop;
use crate::resources::imports::Imports;
use framegraph::Plan;
use std::net::{Ipv4Addr, Ipv6Addr, Shutdown, SocketAddr, TcpListener, TcpStream, ToSocketAddrs};
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Address that engines and viewers use without another one. Loopback: other machines cannot connect.
pub const DEFAULT_ADDRESS: &str = "127.0.0.1:9870";
/// Minimum time between two samples of times, and between two plans.
const INTERVAL: Duration = Duration::from_millis(100);

/// Open connections by viewer.
type Streams = Mutex<[Option<TcpStream>; MAX_VIEWERS]>;

/// Server for viewers. Dropping it closes all connections. See the [module documentation](super).
#[derive(Debug)]
pub struct Server {
    address: SocketAddr,
    mailbox: Arc<Mailbox>,
    streams: Arc<Streams>,
    thread: Option<std::thread::JoinHandle<()>>,
    textures: Textures,
    frame: u64,
    /// A viewer was attached in the last frame.
    attached: bool,
    /// Number of times that the last viewer left, as the last frame saw it.
    session: u64,
    /// Compilation of the plan that was offered last.
    offered: u64,
    times_at: Option<Instant>,
    plan_at: Option<Instant>,
    /// This server turned measurements of step times on.
    measures: bool,
}

impl Server {
    /// Starts to listen on an address, such as [`DEFAULT_ADDRESS`], on threads of its own. Port 0 selects a free port.
    /// `engine` is the name that viewers show.
    ///
    /// # Errors
    /// Fails if the address is invalid or in use.
    pub fn start(address: impl ToSocketAddrs + std::fmt::Display, engine: &str) -> Result<Self, RemoteError> {
        let failed =
            |error: std::io::Error| RemoteError::Address { address: address.to_string(), reason: error.to_string() };
        let listener = TcpListener::bind(&address).map_err(failed)?;
        let bound = listener.local_addr().map_err(failed)?;
        let (mailbox, streams) = (Arc::<Mailbox>::default(), Arc::<Streams>::default());
        let (shared, open, engine) = (mailbox.clone(), streams.clone(), engine.to_owned());
        let thread = std::thread::Builder::new().name("remote server".into());
        let thread = thread.spawn(move || accept(&listener, &shared, &open, &engine)).map_err(failed)?;
        Ok(Self {
            address: bound,
            mailbox,
            streams,
            thread: Some(thread),
            textures: Textures::default(),
            frame: 0,
            attached: false,
            session: 0,
            offered: 0,
            times_at: None,
            plan_at: None,
            measures: false,
        })
    }

    /// Returns the address with the selected port.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Returns the counts since the start.
    pub fn counts(&self) -> RemoteCounts {
        self.mailbox.counts()
    }

    /// Offers plan and times of the last frame of a loop to the viewers, and reads requested textures. Never waits.
    ///
    /// While a viewer is attached, step times are measured ([`Executor::set_timing`]). Frames of [`FrameLoop::run_for`]
    /// and frames that failed are not offered.
    pub fn after_frame<W: ?Sized>(&mut self, frames: &mut FrameLoop<W>, world: &W) {
        let has_executed = frames.has_executed();
        let (executor, plan, frame, imports) = frames.parts_mut();
        if self.begin(executor) && has_executed {
            self.offer((executor, plan, frame, world, imports));
        }
    }

    /// Offers an executed frame like [`Server::after_frame`], for engines without a [`FrameLoop`].
    pub fn after<W: ?Sized>(
        &mut self,
        executor: &mut Executor,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
    ) {
        if self.begin(executor) && plan.compilation() > 0 {
            self.offer((executor, plan, frame, world, imports));
        }
    }

    /// Counts a frame, and returns whether a viewer is attached.
    fn begin(&mut self, executor: &mut Executor) -> bool {
        self.frame += 1;
        let attached = self.mailbox.viewers.load(Ordering::Acquire) > 0;
        if attached != self.measures {
            self.toggle_timing(executor, attached);
        }
        if self.attached && !attached {
            self.textures.reset();
        }
        self.attached = attached;
        if attached {
            // The plan of an earlier session is not kept. Viewers can leave and others attach between two frames. The
            // minimum times still hold, so that a viewer that attaches again and again costs no more.
            let session = self.mailbox.sessions.load(Ordering::Acquire);
            if std::mem::replace(&mut self.session, session) != session {
                self.offered = 0;
            }
        }
        attached
    }

    /// Offers an executed frame to the attached viewers.
    fn offer<W: ?Sized>(
        &mut self,
        (executor, plan, frame, world, imports): (&mut Executor, &Plan, &Frame<W>, &W, &Imports),
    ) {
        let now = Instant::now();
        let due = |last: Option<Instant>| last.is_none_or(|last| now.duration_since(last) >= INTERVAL);
        let changed = self.offered != plan.compilation();
        if changed && due(self.plan_at) && self.mailbox.offer_plan(plan) {
            (self.offered, self.plan_at) = (plan.compilation(), Some(now));
        }
        if due(self.times_at) && self.mailbox.offer_times(sample(executor, plan, self.frame)) {
            self.times_at = Some(now);
        }
        self.textures.advance(&self.mailbox, now, (executor, plan, frame, world, imports));
    }

    /// Measures step times while a viewer is attached, unless the engine measures them itself.
    fn toggle_timing(&mut self, executor: &mut Executor, attached: bool) {
        if attached == executor.timing().is_enabled() {
            // A new viewer of an engine that measures by itself, or the engine stopped measuring.
            self.measures = false;
        } else {
            executor.set_timing(attached);
            self.measures = attached;
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.mailbox.outbox().closed = true;
        self.mailbox.wake();
        // The accepting thread waits for a connection.
        let mut address = self.address;
        if address.ip().is_unspecified() {
            address.set_ip(if address.is_ipv4() { Ipv4Addr::LOCALHOST.into() } else { Ipv6Addr::LOCALHOST.into() });
        }
        if TcpStream::connect_timeout(&address, Duration::from_secs(1)).is_ok() {
            let _ = self.thread.take().map(std::thread::JoinHandle::join);
        }
        for stream in self.streams.lock().unwrap_or_else(PoisonError::into_inner).iter().flatten() {
            let _ = stream.shutdown(Shutdown::Both);
        }
    }
}

/// Returns the most recent times of each step.
fn sample(executor: &Executor, plan: &Plan, frame: u64) -> FrameSample {
    let timing = executor.timing();
    let steps = plan.step_ids().map(|step| {
        let [gpu_ms, cpu_ms] = timing.last_of_step(step);
        StepSample { cpu_ms, gpu_ms }
    });
    let [gpu_ms, cpu_ms] = timing.last_of_frame();
    FrameSample { frame, compilation: plan.compilation(), cpu_ms, gpu_ms, steps: steps.collect() }
}

/// Accepts connections until the server ends.
fn accept(listener: &TcpListener, mailbox: &Arc<Mailbox>, streams: &Arc<Streams>, engine: &str) {
    loop {
        let accepted = listener.accept();
        if mailbox.outbox().closed {
            return;
        }
        let Ok((stream, _)) = accepted else {
            // Out of file handles, for example.
            std::thread::sleep(INTERVAL);
            continue;
        };
        // A slot is free if it has no stream. Without a copy, two connections would get one slot.
        let Ok(copy) = stream.try_clone() else { continue };
        let viewer = {
            let mut open = streams.lock().unwrap_or_else(PoisonError::into_inner);
            let free = open.iter().position(Option::is_none);
            if let Some(free) = free {
                open[free] = Some(copy);
            }
            free
        };
        let Some(viewer) = viewer else {
            // No thread for it, so that a flood of connections costs nothing. The reason fits into the socket's buffer.
            peer::refuse_full(&stream, mailbox);
            continue;
        };
        let (mailbox, open, engine) = (mailbox.clone(), streams.clone(), engine.to_owned());
        let serve = move || {
            peer::serve(&stream, viewer, &engine, &mailbox);
            open.lock().unwrap_or_else(PoisonError::into_inner)[viewer] = None;
        };
        if std::thread::Builder::new().name("remote viewer".into()).spawn(serve).is_err() {
            streams.lock().unwrap_or_else(PoisonError::into_inner)[viewer] = None;
        }
    }
}
