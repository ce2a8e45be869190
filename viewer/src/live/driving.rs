//! When and on which thread the live frame is drawn.
//!
//! A frame is drawn by a thread of its own, because creating its pipelines may take seconds. The panels wait for it for
//! some milliseconds. If it takes longer, they show the last picture and the progress.

use super::Live;
use super::bisecting::Bisecting;
use super::capture::Document;
use super::drawing::{Copied, Done};
use super::frame::Running;
use super::preview::read;
use crate::job::{Handle, Job};
use crate::plan_data::PlanData;
use crate::session::Session;
use crate::trace_data::TraceData;
use egui::TextureId;
use framegraph_wgpu::debug::Modes;
use framegraph_wgpu::read_texture;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Interval between two updates of the times, in seconds.
const TIMES_S: f32 = 0.5;
/// Maximum time that panels wait for a frame.
const PATIENCE: Duration = Duration::from_millis(25);
/// Time after which a busy device is asked again.
const BUSY: Duration = Duration::from_millis(15);
/// Size of the frame before the viewport was first shown.
const SIZE_PX: [u32; 2] = [1280, 720];

impl Live {
    /// Waits for every frame, as tests and pictures need.
    pub fn wait_for_frames(&mut self) {
        self.drawing.blocking = true;
    }

    /// Returns whether every frame is waited for.
    pub fn is_blocking(&self) -> bool {
        self.drawing.blocking
    }

    /// Returns whether another thread works on a frame.
    pub fn is_drawing(&self) -> bool {
        self.drawing.is_working()
    }

    /// Draws frames on another thread, as windows need; the default.
    pub fn draw_in_background(&mut self) {
        self.drawing.blocking = false;
    }

    /// Returns whether a frame should be drawn.
    pub fn wants_frame(&self) -> bool {
        let loaded = self.running.is_some() || self.drawing.job.is_some();
        loaded && (self.left > 0 || self.continuous || self.options.playing)
    }

    /// Returns the time after which the next frame may be drawn: a moment if the device or the thread is busy.
    pub fn next_frame(&self) -> Duration {
        let waits = self.drawing.copying.is_some() || self.running.as_ref().is_none_or(Running::is_busy);
        if waits && !self.drawing.blocking { BUSY } else { Duration::ZERO }
    }

    /// Returns egui's id and the size of the last picture; `None` before the first frame.
    pub fn picture(&self) -> Option<(TextureId, [u32; 2])> {
        self.drawing.picture
    }

    /// Returns whether the frame has a device of its own.
    pub fn has_own_device(&self) -> bool {
        self.screen.apart
    }

    /// Returns the copy of the last picture, if the frame has a device of its own.
    pub fn copied_picture(&self) -> Option<&Copied> {
        self.drawing.copy.as_ref()
    }

    /// Draws the frame at the size of the viewport if required, and passes its plan and times to the session.
    pub fn draw(&mut self, size_px: [u32; 2], session: &mut Session) {
        self.drawing.shown = true;
        self.draw_at(size_px, session);
    }

    /// Draws the frame if the viewport was not shown, at its last size. Returns whether more frames are required.
    pub fn draw_hidden(&mut self, session: &mut Session) -> bool {
        if std::mem::replace(&mut self.drawing.shown, false) {
            return false;
        }
        let size_px = if self.size_px.contains(&0) { SIZE_PX } else { self.size_px };
        self.draw_at(size_px, session);
        self.wants_frame()
    }

    fn draw_at(&mut self, size_px: [u32; 2], session: &mut Session) {
        if !self.wants_frame() || size_px.contains(&0) {
            return;
        }
        let Some(running) = &mut self.running else { return };
        if !self.drawing.blocking && (running.is_busy() || self.drawing.copying.is_some()) {
            return;
        }
        if let Some(rig) = &self.rig {
            running.rig.clone_from(rig);
        }
        // Until new light is available, draw with the existing light.
        let lit = running.loaded.light_settings;
        let document = self.document().clone();
        let mut drawn = document.clone();
        drawn.frame.settings.shading.bands = lit.image.bands;
        drawn.frame.settings.shading.table = lit.dfg.visibility;
        self.left = self.left.saturating_sub(1);
        let options = self.options.clone();
        self.work("compiling pipelines", session, move |running, handle| {
            let mut progress = |done, total| handle.step(done, total);
            let result = running.draw(size_px, &drawn, &options, &mut progress);
            Done::Drawn(Box::new((document, options.modes)), result)
        });
    }

    /// Reads the texture of the preview if its selection, or with *live* the frame, changed.
    pub fn inspect(&mut self, session: &mut Session) {
        let Some(running) = &self.running else { return };
        let frame = running.plans() ^ (u64::from(running.drawn()) << 20);
        let Some((target, inspector)) = self.preview.begin(running, frame) else { return };
        let mut inspector = inspector;
        self.work("reading a texture", session, move |running, _| {
            let found = read(running, &mut inspector, target.clone());
            Done::Read(Box::new((inspector, target, found)))
        });
    }

    /// Draws the frame in each debug mode and compares the pictures.
    pub fn bisect(&mut self, mut bisecting: Bisecting, session: &mut Session) {
        self.bisecting = None;
        self.work("comparing debug modes", session, move |running, handle| {
            Done::Bisected(bisecting.run(running, handle).map(|()| Box::new(bisecting)))
        });
    }

    /// Lends the frame to another thread and waits for a moment; with [`Live::wait_for_frames`], works on this thread.
    pub(super) fn work(
        &mut self,
        doing: &str,
        session: &mut Session,
        work: impl FnOnce(&mut Running, &Handle) -> Done + Send + 'static,
    ) {
        let Some(mut running) = self.running.take() else { return };
        if self.drawing.blocking {
            let done = work(&mut running, &Handle::default());
            return self.take_done(running, done, session);
        }
        let wake = self.wake.clone();
        let job = Job::start(
            doing,
            move || wake(),
            move |handle| {
                let done = work(&mut running, handle);
                (running, done)
            },
        );
        self.drawing.job = Some((job, Instant::now()));
        self.collect(session, PATIENCE);
    }

    /// Takes the frame back from the thread that works on it. Waits at most the given time.
    pub(super) fn collect(&mut self, session: &mut Session, at_most: Duration) {
        if let Some((job, copied)) = self.drawing.copying.as_ref().and_then(|job| Some((job, job.poll()?))) {
            let made = self.drawing.copy.as_ref().map_or(0, |copy| copy.made) + 1;
            let copied = copied.unwrap_or_else(|()| {
                session.say(job.failure());
                None
            });
            let copied = copied.map(|(size_px, rgba8)| Copied { size_px, rgba8, made });
            (self.drawing.copying, self.drawing.copy) = (None, copied.or(self.drawing.copy.take()));
        }
        let Some((job, _)) = &self.drawing.job else { return };
        let Some(result) = job.wait(at_most) else { return };
        let failure = job.failure();
        self.drawing.job = None;
        match result {
            Ok((running, done)) => self.take_done(running, done, session),
            Err(()) => {
                // The frame was lost with its thread, and light is of no use without it.
                (self.drawing.stopped, self.relighting) = (false, None);
                self.preview.interrupted();
                session.say(format!("{failure}; load the scene again"));
            }
        }
    }

    /// Copies the picture of a frame with a device of its own, on another thread.
    fn copy(&mut self) {
        let Some(running) = self.running.as_ref().filter(|_| self.screen.apart) else { return };
        let (Some(texture), Some((_, size_px))) = (running.picture_texture().cloned(), running.picture()) else {
            return;
        };
        let (gpu, wake) = (self.screen.gpu.clone(), self.wake.clone());
        self.drawing.copying = Some(Job::start(
            "copying a picture",
            move || wake(),
            move |_| read_texture(&gpu, &texture).ok().map(|pixels| (size_px, pixels.rgba8())),
        ));
    }

    fn take_done(&mut self, running: Running, done: Done, session: &mut Session) {
        self.drawing.picture = running.picture();
        self.running = Some(running);
        match done {
            Done::Drawn(drawn, result) => {
                let undone = self.drawing.take_drawn(&drawn.0, self.history.now()) && self.history.undo();
                if undone {
                    // Stopping again must not undo an earlier change.
                    self.drawing.last = Some(self.document().clone());
                    self.again();
                }
                if let Err(error) = result {
                    if self.refused.as_ref() != Some(&error) {
                        session.say(error.clone());
                    }
                    if !undone {
                        (self.refused, self.left) = (Some(error), 0);
                    }
                    return;
                }
                self.clock.tick(Instant::now());
                self.copy();
                self.report(*drawn, session);
            }
            Done::Read(read) => {
                let (inspector, target, found) = *read;
                self.preview.take(inspector, &target, found);
            }
            Done::Bisected(result) => {
                self.drawing.stopped = false;
                match result {
                    Ok(bisecting) => self.bisecting = Some(*bisecting).filter(Bisecting::is_done),
                    Err(error) => session.say(error),
                }
                self.again();
            }
        }
    }

    /// Passes plan and times of a drawn frame to the session if it shows this frame.
    fn report(&mut self, drawn: (Document, Modes), session: &mut Session) {
        let Some(running) = &self.running else { return };
        let shows = session.is_live() || session.plan.is_none();
        if shows && running.plans() != self.reported_plans {
            let name = format!("live frame, {}", running.loaded.name);
            let changed = self.reported_plans > 0 && drawn != self.drawn_with;
            match PlanData::of(running.plan(), &name) {
                Ok(plan) => {
                    let (planner, base) = running.planner(&drawn.0, &drawn.1);
                    session.show_live(planner, base, Arc::new(plan), changed);
                }
                Err(error) => session.say(error.to_string()),
            }
            self.reported_plans = running.plans();
            self.drawn_with = drawn;
            // Times of the previous plan do not match the new one.
            self.times_at = None;
        }
        if shows && self.times_at.is_none_or(|at| at.elapsed().as_secs_f32() >= TIMES_S) {
            self.times_at = Some(Instant::now());
            if let Some(trace) = running.frames().executor().timing().trace() {
                session.take_times(TraceData::of_trace(trace));
            }
        }
    }
}
