//! Engine that the viewer is attached to: plans, times and textures over TCP (`framegraph_wgpu::remote`).

use crate::graph_source::GraphSource;
use crate::live::preview::{Found, Preview};
use crate::plan_data::{PlanData, read};
use crate::session::Session;
use crate::trace_data::{TraceData, TracedFrame, TracedStep, traced_name};
use crate::what_if::{Planner, WhatIf};
use framegraph::Plan;
use framegraph_wgpu::inspect::{InspectTarget, Request, VersionSelector};
use framegraph_wgpu::remote::{
    Connection, FrameSample, FromEngine, FromViewer, RemotePlan, RemoteTexture, TextureRequest,
};
use std::collections::{HashMap, VecDeque};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, sync_channel};
use std::time::{Duration, Instant};

/// Maximum number of messages that wait for the window. When it is full, the engine replaces what it would send.
const WAITING: usize = 16;
/// Maximum number of samples of times in the views.
const SHOWN: usize = 240;
/// Maximum number of samples times steps, so that large plans do not slow the window.
const MAX_TIMES: usize = 50_000;
/// Minimum time between two updates of the views.
const INTERVAL: Duration = Duration::from_millis(250);

/// News of the thread that reads the connection.
enum News {
    Open(Connection),
    Plan(Box<Running>),
    Times(FrameSample),
    Texture(RemoteTexture),
    Ended(String),
}

/// Running plan of the engine.
struct Running {
    compilation: u64,
    data: Arc<PlanData>,
    /// The plan, compiled again from the declared graph.
    plan: Arc<Plan>,
    planner: Arc<RemotePlanner>,
    base: WhatIf,
}

/// Planner of the graph that an engine declared.
struct RemotePlanner {
    source: GraphSource,
    declared_at: Vec<String>,
}

impl Planner for RemotePlanner {
    fn name(&self) -> &str {
        self.source.name()
    }

    fn features(&self) -> Vec<(String, bool)> {
        Vec::new()
    }

    fn plan(&self, what_if: &WhatIf) -> Result<PlanData, String> {
        let mut data = self.source.plan(what_if)?;
        data.declared_at.clone_from(&self.declared_at);
        Ok(data)
    }
}

/// Engine that the viewer is attached to.
pub struct Attached {
    address: String,
    news: Receiver<News>,
    connection: Option<Connection>,
    running: Option<Running>,
    samples: VecDeque<FrameSample>,
    /// When the views got times.
    shown_at: Option<Instant>,
    /// Texture viewer.
    pub preview: Preview,
    /// The texture viewer requests a file dialog.
    pub asks_file: bool,
    /// Number and target of the last request.
    requested: (u32, Option<InspectTarget>),
    textures: u64,
    ended: bool,
}

impl Attached {
    /// Starts to connect to `HOST:PORT` in the background. Another thread calls `wake` after each message.
    pub fn open(address: &str, wake: impl Fn() + Send + 'static) -> Self {
        let (sender, news) = sync_channel(WAITING);
        let at = address.to_owned();
        std::thread::spawn(move || {
            let ended = follow(&at, &sender, &wake);
            // The owner may be gone.
            let _ = sender.send(News::Ended(ended));
            wake();
        });
        Self {
            address: address.to_owned(),
            news,
            connection: None,
            running: None,
            samples: VecDeque::new(),
            shown_at: None,
            preview: Preview::default(),
            asks_file: false,
            requested: (0, None),
            textures: 0,
            ended: false,
        }
    }

    /// Returns the name and address of the engine, or the progress of the connection.
    pub fn title(&self) -> String {
        match &self.connection {
            _ if self.ended => format!("{} ended", self.address),
            Some(connection) => format!("{} at {}", connection.engine(), self.address),
            None => format!("connecting to {}", self.address),
        }
    }

    /// Returns whether the connection failed or ended.
    pub fn is_ended(&self) -> bool {
        self.ended
    }

    /// Returns whether a plan and times have arrived.
    pub fn is_complete(&self) -> bool {
        self.running.is_some() && self.shown_at.is_some()
    }

    /// Applies the messages that have arrived, without blocking.
    pub fn poll(&mut self, session: &mut Session) {
        let mut sampled = false;
        loop {
            match self.news.try_recv() {
                Ok(News::Open(connection)) => self.connection = Some(connection),
                Ok(News::Plan(running)) => {
                    let (planner, base) = (running.planner.clone(), running.base.clone());
                    if self.running.is_none() {
                        session.begin_document();
                    }
                    session.show_live(planner, base, running.data.clone(), self.running.is_some());
                    self.running = Some(*running);
                    self.samples.clear();
                    self.shown_at = None;
                }
                Ok(News::Times(sample)) => {
                    // Samples of the previous plan may arrive after a change.
                    if self.running.as_ref().is_some_and(|running| running.compilation == sample.compilation) {
                        let max = (MAX_TIMES / sample.steps.len().max(1)).clamp(16, SHOWN);
                        sampled |= sample.cpu_ms.is_some();
                        self.samples.push_back(sample);
                        self.samples.drain(..self.samples.len().saturating_sub(max));
                    }
                }
                Ok(News::Texture(texture)) => self.take_texture(texture),
                Ok(News::Ended(reason)) => {
                    self.end();
                    session.say(format!("{}: {reason}", self.address));
                }
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => {
                    self.ended = true;
                    break;
                }
            }
        }
        if sampled
            && let Some(running) = &self.running
            && self.shown_at.is_none_or(|at| at.elapsed() >= INTERVAL)
        {
            self.shown_at = Some(Instant::now());
            session.take_times(times(&self.samples, &running.data));
        }
    }

    /// Waits until a plan and times have arrived or the connection ended; returns false after `at_most`.
    pub fn settle(&mut self, session: &mut Session, at_most: Duration) -> bool {
        let end = Instant::now() + at_most;
        while Instant::now() < end {
            self.poll(session);
            if self.ended || self.is_complete() {
                return true;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        false
    }

    /// Requests the selected texture if the selection or the plan changed, or continuously with *live*.
    pub fn request_texture(&mut self) {
        let (Some(running), Some(connection)) = (&self.running, &self.connection) else { return };
        let Some(target) = self.preview.begin_of(&running.plan, running.compilation, self.textures) else { return };
        let request = Request {
            version: VersionSelector::Number(target.number),
            mip: target.mip,
            layer: target.layer,
            ..Request::newest(&target.name)
        };
        let number = self.requested.0.wrapping_add(1);
        let (text, aspect, sample) = (request.to_string(), target.aspect, target.sample);
        let sent = connection.send(&FromViewer::Texture(TextureRequest { number, text, aspect, sample }));
        if let Err(error) = sent {
            self.preview.take_found(&target, Err(error.to_string()));
        }
        self.requested = (number, Some(target));
    }

    fn take_texture(&mut self, texture: RemoteTexture) {
        // An answer to an earlier request.
        let Some(target) = self.requested.1.as_ref().filter(|_| texture.number == self.requested.0) else { return };
        self.textures += 1;
        let found = texture.title.clone().and_then(|title| {
            let texels = texture.texels().ok_or("the engine sent another number of texels than the size requires")?;
            Ok(Found::new(title, texels, 0.0))
        });
        self.preview.take_found(target, found);
    }

    fn end(&mut self) {
        self.ended = true;
        self.preview.interrupted();
        if let Some(connection) = &self.connection {
            connection.close();
        }
    }
}

impl Drop for Attached {
    fn drop(&mut self) {
        self.end();
    }
}

/// Reads the messages of an engine until the connection ends, and returns the reason.
fn follow(address: &str, news: &SyncSender<News>, wake: &dyn Fn()) -> String {
    let opened = Connection::open(address).and_then(|connection| Ok((connection.try_clone()?, connection)));
    let (own, theirs) = match opened {
        Ok(opened) => opened,
        Err(error) => return error.to_string(),
    };
    let engine = own.engine().to_owned();
    let mut next = News::Open(theirs);
    loop {
        // Sending fails if the owner is gone, which ends the connection.
        if news.send(next).is_err() {
            own.close();
            return String::new();
        }
        wake();
        next = loop {
            match own.receive() {
                Ok(FromEngine::Plan(plan)) => match running(&engine, *plan) {
                    Ok(running) => break News::Plan(Box::new(running)),
                    Err(error) => {
                        own.close();
                        return format!("the plan of the engine is invalid: {error}");
                    }
                },
                Ok(FromEngine::Times(times)) => break News::Times(times),
                Ok(FromEngine::Texture(texture)) => break News::Texture(texture),
                Ok(FromEngine::Welcome { .. } | FromEngine::Refused { .. }) => {}
                Err(error) => return error.to_string(),
            }
        };
    }
}

/// Compiles the plan of an engine from its declared graph. The plan of the engine is shown if they differ, as with
/// measured sizes of placed textures.
fn running(engine: &str, message: RemotePlan) -> Result<Running, String> {
    let RemotePlan { compilation, json, graph, caps, options, declared_at } = message;
    let base = WhatIf::of(caps, &options);
    let planner = RemotePlanner { source: GraphSource::of_text(engine.to_owned(), graph), declared_at };
    let compiled = planner.plan(&base)?;
    let plan = compiled.plan.clone().ok_or("no plan")?;
    let mut data = read(json.as_bytes()).map_err(|error| error.to_string())?;
    data.declared_at.clone_from(&compiled.declared_at);
    if data.form == compiled.form {
        data = compiled;
    }
    Ok(Running { compilation, data: Arc::new(data), plan, planner: Arc::new(planner), base })
}

/// Collects samples of times by step.
fn times(samples: &VecDeque<FrameSample>, plan: &PlanData) -> TraceData {
    let mut trace = TraceData::default();
    let mut counts: HashMap<String, usize> = HashMap::new();
    for (index, step) in plan.form.steps.iter().enumerate() {
        let name = traced_name(plan, step);
        let count = counts.entry(name.clone()).or_default();
        let earlier = std::mem::replace(count, *count + 1);
        let of_step = || samples.iter().filter_map(|sample| sample.steps.get(index));
        let sorted = |mut ms: Vec<f64>| {
            ms.sort_unstable_by(f64::total_cmp);
            ms
        };
        let cpu_ms = sorted(of_step().filter_map(|step| step.cpu_ms).collect());
        let gpu_ms = sorted(of_step().filter_map(|step| step.gpu_ms).collect());
        trace.steps.push(TracedStep { name, earlier, cpu_ms, gpu_ms });
    }
    // The first frames of a plan compile shaders, and are not measured.
    trace.frames.extend(samples.iter().filter_map(|sample| {
        let (number, cpu_ms, gpu_ms) = (sample.frame, sample.cpu_ms?, sample.gpu_ms);
        Some(TracedFrame { number, warm_up: false, cpu_ms, gpu_ms })
    }));
    trace
}
