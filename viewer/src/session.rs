//! Displayed data: plans with their sources, what-if questions and the selection. Independent of windows.

mod live;

use crate::accuracy_data::AccuracyData;
use crate::drawing::Item;
use crate::job::Job;
use crate::open::{Opened, open};
use crate::panel::{Questions, ViewData};
use crate::plan_data::PlanData;
use crate::trace_data::TraceData;
use crate::watch::Watch;
use crate::what_if::{Planner, WhatIf};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Purpose of opening a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Show it.
    Shown,
    /// Compare with it.
    Against,
}

/// Maximum number of messages.
const MESSAGES: usize = 4;

/// Plan or error message.
type Planned = Result<Arc<PlanData>, String>;

/// Result of a job.
enum JobResult {
    /// Opened file.
    File(PathBuf, Role, Result<Opened, String>),
    /// Plan without what-if changes, if requested, and the what-if plan.
    Plans(Option<Planned>, Planned),
    /// Plan to compare with.
    Against(Planned),
}

/// Plans and what-if questions.
pub struct Session {
    /// Displayed plan.
    pub plan: Option<Arc<PlanData>>,
    /// Displayed trace.
    pub trace: Option<Arc<TraceData>>,
    /// Errors and costs of settings.
    pub accuracy: Option<Arc<AccuracyData>>,
    /// Time budget of the chosen frame in the accuracy view, in milliseconds.
    pub budget_ms: f64,
    /// What-if questions; `None` if the plan has no source, such as a saved plan.
    pub questions: Option<Questions>,
    /// Selected item.
    pub selected: Option<Item>,
    /// Opened files and their includes.
    pub read: Vec<PathBuf>,
    /// Error messages, oldest first.
    pub messages: Vec<String>,
    /// Confirmation of the last saved file.
    pub notice: Option<String>,
    /// Displayed file; empty for a plan without one.
    shown: Option<PathBuf>,
    /// Counts displayed files and scenes.
    documents: u64,
    base: Option<Arc<PlanData>>,
    against: Option<Arc<PlanData>>,
    /// Plan of the live frame before the last change of its settings.
    before: Option<Arc<PlanData>>,
    /// The planner's frame is live.
    live: bool,
    planner: Option<Arc<dyn Planner>>,
    watch: Option<(PathBuf, Watch)>,
    job: Option<Job<JobResult>>,
    /// The what-if changed while a plan was compiled.
    stale: bool,
    generation: u64,
    times: u64,
    wake: Arc<dyn Fn() + Send + Sync>,
    first: WhatIf,
}

impl Session {
    /// Creates an empty session. `first` is the initial what-if; other threads call `wake` when a result is available.
    pub fn new(first: WhatIf, wake: impl Fn() + Send + Sync + 'static) -> Self {
        Self {
            plan: None,
            trace: None,
            accuracy: None,
            budget_ms: 0.0,
            questions: None,
            selected: None,
            read: Vec::new(),
            messages: Vec::new(),
            notice: None,
            shown: None,
            documents: 0,
            base: None,
            against: None,
            before: None,
            live: false,
            planner: None,
            watch: None,
            job: None,
            stale: false,
            generation: 0,
            times: 0,
            wake: Arc::new(wake),
            first,
        }
    }

    /// Sets the time budget of the chosen frame in milliseconds.
    pub fn allow_ms(&mut self, budget_ms: f64) {
        self.generation += u64::from(self.budget_ms != budget_ms);
        self.budget_ms = budget_ms;
    }

    /// Returns the data that views show.
    pub fn data(&self) -> ViewData<'_> {
        ViewData {
            plan: self.plan.as_ref(),
            against: self.compared(),
            trace: self.trace.as_ref(),
            selected: self.selected,
            generation: self.generation,
            times: self.times(),
        }
    }

    /// Counts changes of the displayed data.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// Returns the plan to compare with: the opened plan, the plan without what-if changes, or the previous live plan.
    pub fn against(&self) -> Option<&PlanData> {
        self.compared().map(|plan| &**plan)
    }

    /// Returns the plan to compare with, to share it with another thread.
    pub fn compared(&self) -> Option<&Arc<PlanData>> {
        let asked = self.questions.as_ref().is_some_and(|q| q.asked != q.base);
        let own = if asked { &self.base } else { &self.before };
        self.against.as_ref().or(own.as_ref())
    }

    /// Counts displayed files and scenes. Views reset their zoom and the search when it changes.
    pub fn documents(&self) -> u64 {
        self.documents
    }

    /// Begins another file, scene or engine: closes messages of the previous one, and its plan for comparison.
    pub fn begin_document(&mut self) {
        self.documents += 1;
        self.generation += u64::from(self.before.take().is_some());
        (self.notice, self.selected) = (None, None);
        self.messages.clear();
    }

    /// Returns the plan without what-if changes.
    pub fn base(&self) -> Option<Arc<PlanData>> {
        self.base.clone()
    }

    /// Returns whether a plan is open for comparison.
    pub fn has_against(&self) -> bool {
        self.against.is_some()
    }

    /// Closes the plan for comparison.
    pub fn forget_against(&mut self) {
        self.against = None;
        self.generation += 1;
    }

    /// Returns the description of the running job.
    pub fn doing(&self) -> Option<&str> {
        self.job.as_ref().map(|job| job.doing.as_str())
    }

    /// Returns the completed fraction of the running job, 0 to 1.
    pub fn progress(&self) -> Option<f32> {
        self.job.as_ref().and_then(Job::progress)
    }

    /// Cancels the running job and keeps the displayed data.
    pub fn cancel(&mut self) {
        self.job = None;
        self.stale = false;
    }

    /// Opens a file on a new thread. The displayed data stays until the file is read successfully.
    pub fn open(&mut self, path: &Path, role: Role) {
        let at = path.to_owned();
        self.read.push(path.to_owned());
        self.start(format!("reading {}", path.display()), move |handle| {
            JobResult::File(at.clone(), role, open(&at, handle))
        });
    }

    /// Shows the frame of a planner.
    pub fn show(&mut self, planner: Arc<dyn Planner>) {
        (self.before, self.live) = (None, false);
        let base = WhatIf { features: self.features(&*planner, &self.first), ..self.first.clone() };
        // A reloaded file keeps the what-if as far as possible.
        let asked = match (&self.questions, &self.planner) {
            (Some(questions), Some(old)) if old.name() == planner.name() => {
                WhatIf { features: self.features(&*planner, &questions.asked), ..questions.asked.clone() }
            }
            _ => base.clone(),
        };
        let mut questions = Questions::new(base);
        questions.asked = asked;
        self.questions = Some(questions);
        self.planner = Some(planner);
        self.base = None;
        self.ask();
    }

    /// Shows a plan without a source.
    pub fn show_plan(&mut self, plan: PlanData) {
        self.opened(Path::new(""), Role::Shown, Opened::Plan(Arc::new(plan)));
    }

    /// Returns the features of a planner, set as in a what-if.
    fn features(&self, planner: &dyn Planner, question: &WhatIf) -> Vec<(String, bool)> {
        let asked = |name: &str| question.features.iter().find(|(known, _)| known == name).map(|(_, on)| *on);
        planner.features().into_iter().map(|(name, on)| (name.clone(), asked(&name).unwrap_or(on))).collect()
    }

    /// Compiles the current what-if. Call it after changes of [`Session::questions`].
    pub fn ask(&mut self) {
        if self.job.is_some() {
            self.stale = true;
            return;
        }
        let (Some(planner), Some(questions)) = (self.planner.clone(), &self.questions) else { return };
        let base = self.base.is_none().then(|| questions.base.clone());
        let asked = questions.asked.clone();
        self.start(format!("planning {}", planner.name()), move |_| {
            let plan_of = |question: &WhatIf| planner.plan(question).map(Arc::new);
            let based = base.as_ref().map(plan_of);
            let same = base.as_ref() == Some(&asked);
            let plan = match &based {
                Some(plan) if same => plan.clone(),
                _ => plan_of(&asked),
            };
            JobResult::Plans(based, plan)
        });
    }

    /// Starts a job and cancels the previous one.
    fn start(&mut self, doing: String, work: impl FnOnce(&crate::job::Handle) -> JobResult + Send + 'static) {
        let wake = self.wake.clone();
        self.job = Some(Job::start(doing, move || wake(), work));
    }

    /// Applies finished results of other threads without blocking.
    pub fn poll(&mut self) {
        if let Some((path, watch)) = &self.watch
            && self.job.is_none()
            && watch.changed()
        {
            let path = path.clone();
            self.open(&path, Role::Shown);
        }
        while let Some((job, result)) = self.job.as_ref().and_then(|job| Some((job, job.poll()?))) {
            let result = result.map_err(|()| job.failure());
            self.job = None;
            match result {
                Ok(brought) => self.take(brought),
                Err(failure) => self.say(failure),
            }
            if std::mem::take(&mut self.stale) {
                self.ask();
            }
        }
    }

    /// Waits until no job runs; returns false after `at_most`.
    pub fn settle(&mut self, at_most: Duration) -> bool {
        let end = Instant::now() + at_most;
        while Instant::now() < end {
            self.poll();
            if self.job.is_none() {
                return true;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        false
    }

    fn take(&mut self, brought: JobResult) {
        match brought {
            JobResult::File(path, role, Ok(opened)) => self.opened(&path, role, opened),
            JobResult::Plans(based, plan) => {
                if let Some(Ok(base)) = based {
                    self.base = Some(base);
                }
                match plan {
                    Ok(plan) => self.put(plan),
                    Err(error) => self.say(format!("previous plan kept: {error}")),
                }
            }
            JobResult::Against(Ok(plan)) => {
                self.against = Some(plan);
                self.generation += 1;
            }
            JobResult::File(_, _, Err(error)) | JobResult::Against(Err(error)) => self.say(error),
        }
    }

    fn opened(&mut self, path: &Path, role: Role, opened: Opened) {
        let is_plan = matches!(opened, Opened::Plan(_) | Opened::Graph(_)) && role == Role::Shown;
        // A file that changed on disk keeps zoom and selection.
        if is_plan && self.shown.as_deref() != Some(path) {
            self.begin_document();
            self.shown = Some(path.to_owned());
        }
        match (opened, role) {
            (Opened::Trace(trace), _) => {
                self.trace = Some(trace);
                self.generation += 1;
            }
            (Opened::Accuracy(accuracy), _) => {
                // Start with the reference frame.
                self.budget_ms = accuracy.span_ms().map_or(0.0, |[_, finest]| finest);
                self.accuracy = Some(accuracy);
                self.generation += 1;
            }
            (Opened::Plan(plan), Role::Against) => {
                self.against = Some(plan);
                self.generation += 1;
            }
            (Opened::Graph(graph), Role::Against) => {
                self.read.extend(graph.files());
                let question = self.questions.as_ref().map_or_else(|| self.first.clone(), |q| q.asked.clone());
                let question = WhatIf { features: self.features(&*graph, &question), ..question };
                self.start(format!("planning {}", graph.name()), move |_| {
                    JobResult::Against(graph.plan(&question).map(Arc::new))
                });
            }
            (Opened::Plan(plan), Role::Shown) => {
                (self.planner, self.questions, self.base, self.watch) = (None, None, None, None);
                (self.before, self.live) = (None, false);
                self.put(plan);
            }
            (Opened::Graph(graph), Role::Shown) => {
                self.read.extend(graph.files());
                let wake = self.wake.clone();
                self.watch = Some((path.to_owned(), Watch::start(graph.files(), move || wake())));
                self.show(graph);
            }
        }
    }

    /// Shows a plan, and keeps the selection by name.
    fn put(&mut self, plan: Arc<PlanData>) {
        let old = self.plan.take();
        self.selected = self.selected.take().and_then(|item| {
            let form = &old.as_ref()?.form;
            match item {
                Item::Pass(index) => plan.pass(&form.passes.get(index)?.name).map(Item::Pass),
                Item::Resource(index) => plan.resource(&form.resources.get(index)?.name).map(Item::Resource),
                // Indices of another plan.
                Item::Step(_) | Item::Flow(_) => None,
            }
        });
        self.plan = Some(plan);
        self.messages.retain(|message| !message.starts_with("previous plan kept"));
        self.generation += 1;
    }

    /// Confirms a finished action, such as saving a file.
    pub fn confirm(&mut self, notice: String) {
        self.notice = Some(notice);
    }

    /// Shows an error message to the user.
    pub fn say(&mut self, message: String) {
        if self.messages.last() != Some(&message) {
            self.messages.push(message);
        }
        let more = self.messages.len().saturating_sub(MESSAGES);
        self.messages.drain(..more);
    }
}
