//! What the application looks at: plans, where they come from, what is asked and selected. No windows here.

use crate::accuracy_data::AccuracyData;
use crate::drawing::Item;
use crate::job::Job;
use crate::open::{Opened, open};
use crate::panel::Questions;
use crate::plan_data::PlanData;
use crate::trace_data::TraceData;
use crate::view::{Beside, graph};
use crate::watch::Watch;
use crate::what_if::{Planner, WhatIf};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What a file is opened for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// To be looked at.
    Shown,
    /// To be compared with.
    Against,
}

/// Messages that are kept; older ones make way.
const MESSAGES: usize = 4;

/// A plan, or why there is none.
type Planned = Result<Arc<PlanData>, String>;

/// What a job brings.
enum Brought {
    /// A file.
    File(PathBuf, Role, Result<Opened, String>),
    /// How the frame is, where that was asked, and the plan that was asked for.
    Plans(Option<Planned>, Planned),
    /// The plan to compare with.
    Against(Planned),
}

/// Plans and questions.
pub struct Session {
    /// The plan that is shown.
    pub plan: Option<Arc<PlanData>>,
    /// The trace that is shown.
    pub trace: Option<Arc<TraceData>>,
    /// What techniques err by and take.
    pub accuracy: Option<Arc<AccuracyData>>,
    /// What a frame that is chosen of them may take, in ms.
    pub budget_ms: f64,
    /// What is asked; none where nobody can plan anew, as of a saved plan.
    pub questions: Option<Questions>,
    /// What is selected.
    pub selected: Option<Item>,
    /// Files that were opened, and what they include.
    pub read: Vec<PathBuf>,
    /// What went wrong, the latest last.
    pub messages: Vec<String>,
    base: Option<Arc<PlanData>>,
    against: Option<Arc<PlanData>>,
    /// The frame that is drawn now, before its settings were changed last.
    before: Option<Arc<PlanData>>,
    /// The frame of the planner is drawn now.
    live: bool,
    planner: Option<Arc<dyn Planner>>,
    watch: Option<(PathBuf, Watch)>,
    job: Option<Job<Brought>>,
    /// Something else was asked while a plan was made.
    stale: bool,
    generation: u64,
    times: u64,
    wake: Arc<dyn Fn() + Send + Sync>,
    first: WhatIf,
}

impl Session {
    /// An empty session that plans as `first` says when a graph is opened; `wake` is called from other threads when there is
    /// something new.
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

    /// Lets a chosen frame take so many milliseconds.
    pub fn allow_ms(&mut self, budget_ms: f64) {
        self.generation += u64::from(self.budget_ms != budget_ms);
        self.budget_ms = budget_ms;
    }

    /// What views look at beside the plan.
    pub fn beside(&self) -> Beside<'_> {
        let (accuracy, trace) = (self.accuracy.as_deref(), self.trace.as_deref());
        Beside { against: self.against(), trace, accuracy, budget_ms: self.budget_ms, selected: self.selected }
    }

    /// Counts the changes of what is shown.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// The plan to compare with: the one that was opened for it; else how the frame is where something else is asked; else, of a
    /// frame that is drawn now, how it was before its settings were changed last.
    pub fn against(&self) -> Option<&PlanData> {
        let asked = self.questions.as_ref().is_some_and(|q| q.asked != q.base);
        let own = if asked { self.base.as_deref() } else { self.before.as_deref() };
        self.against.as_deref().or(own)
    }

    /// What is selected and what belongs to it, itself first.
    pub fn lit(&self) -> Vec<Item> {
        let lit = self.selected.zip(self.plan.as_ref()).map(|(item, plan)| graph::lit(plan, item));
        lit.unwrap_or_default()
    }

    /// How the frame is, without any what-if.
    pub fn base(&self) -> Option<Arc<PlanData>> {
        self.base.clone()
    }

    /// Whether a plan was opened to compare with.
    pub fn has_against(&self) -> bool {
        self.against.is_some()
    }

    /// No longer compares.
    pub fn forget_against(&mut self) {
        self.against = None;
        self.generation += 1;
    }

    /// What is done now, if anything is.
    pub fn doing(&self) -> Option<&str> {
        self.job.as_ref().map(|job| job.doing.as_str())
    }

    /// How far it is, from 0 to 1.
    pub fn progress(&self) -> Option<f32> {
        self.job.as_ref().and_then(Job::progress)
    }

    /// Ends what is done now; what is shown stays.
    pub fn cancel(&mut self) {
        self.job = None;
        self.stale = false;
    }

    /// Opens a file on a thread of its own. What is shown stays until it is there, or if it is none.
    pub fn open(&mut self, path: &Path, role: Role) {
        let at = path.to_owned();
        self.read.push(path.to_owned());
        self.start(format!("reading {}", path.display()), move |handle| {
            Brought::File(at.clone(), role, open(&at, handle))
        });
    }

    /// Shows the frame of a planner.
    pub fn show(&mut self, planner: Arc<dyn Planner>) {
        (self.before, self.live) = (None, false);
        let base = WhatIf { features: self.features(&*planner, &self.first), ..self.first.clone() };
        // A file that is read again keeps what was asked, as far as it still knows it.
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

    /// Shows the plan of a frame that is drawn now, and who plans it anew. What is asked beside it stays asked. The plan before is
    /// kept to compare with where `changed` says that the user changed the frame.
    pub fn show_live(&mut self, planner: Arc<dyn Planner>, base: WhatIf, plan: Arc<PlanData>, changed: bool) {
        self.watch = None;
        let old = if std::mem::replace(&mut self.live, true) { self.base.take() } else { None };
        if changed {
            self.before = old;
        }
        let asked = match &self.questions {
            Some(Questions { base: was, asked, .. }) if asked != was => {
                let features = self.features(&*planner, asked);
                WhatIf { features, ..asked.moved(was, &base) }
            }
            _ => base.clone(),
        };
        let same = asked == base;
        let mut questions = Questions::new(base);
        questions.asked = asked;
        (self.questions, self.planner, self.base) = (Some(questions), Some(planner), Some(plan.clone()));
        if same {
            self.put(plan);
        } else {
            self.generation += 1;
            self.ask();
        }
    }

    /// Shows no plan any more, so that the frame that is drawn now shows its own.
    pub fn forget_plan(&mut self) {
        (self.plan, self.planner, self.questions, self.base, self.watch) = (None, None, None, None, None);
        self.generation += 1;
    }

    /// Whether the frame that is planned is drawn now.
    pub fn is_live(&self) -> bool {
        self.live
    }

    /// Takes times of the frame; views that show them are drawn anew.
    pub fn take_times(&mut self, trace: TraceData) {
        self.trace = Some(Arc::new(trace));
        self.times += 1;
    }

    /// Counts the changes of times alone.
    pub fn times(&self) -> u64 {
        self.times
    }

    /// Shows a plan that nobody can plan anew.
    pub fn show_plan(&mut self, plan: PlanData) {
        self.opened(Path::new(""), Role::Shown, Opened::Plan(Arc::new(plan)));
    }

    /// The features of a frame, set as a question has them.
    fn features(&self, planner: &dyn Planner, question: &WhatIf) -> Vec<(String, bool)> {
        let asked = |name: &str| question.features.iter().find(|(known, _)| known == name).map(|(_, on)| *on);
        planner.features().into_iter().map(|(name, on)| (name.clone(), asked(&name).unwrap_or(on))).collect()
    }

    /// Plans what is asked; to be called when [`Session::questions`] have changed.
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
            Brought::Plans(based, plan)
        });
    }

    /// Starts a job in the place of the one before it.
    fn start(&mut self, doing: String, work: impl FnOnce(&crate::job::Handle) -> Brought + Send + 'static) {
        let wake = self.wake.clone();
        self.job = Some(Job::start(doing, move || wake(), work));
    }

    /// Takes what other threads have brought, without waiting for them.
    pub fn poll(&mut self) {
        if let Some((path, watch)) = &self.watch
            && self.job.is_none()
            && watch.changed()
        {
            let path = path.clone();
            self.open(&path, Role::Shown);
        }
        while let Some(result) = self.job.as_ref().and_then(Job::poll) {
            self.job = None;
            match result {
                Ok(brought) => self.take(brought),
                Err(()) => self.say("the work ended without a result: this is a fault of the viewer".into()),
            }
            if std::mem::take(&mut self.stale) {
                self.ask();
            }
        }
    }

    /// Waits until nothing is done any more; false when that takes longer than `at_most`.
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

    fn take(&mut self, brought: Brought) {
        match brought {
            Brought::File(path, role, Ok(opened)) => self.opened(&path, role, opened),
            Brought::Plans(based, plan) => {
                if let Some(Ok(base)) = based {
                    self.base = Some(base);
                }
                match plan {
                    Ok(plan) => self.put(plan),
                    Err(error) => self.say(format!("the plan before is kept: {error}")),
                }
            }
            Brought::Against(Ok(plan)) => {
                self.against = Some(plan);
                self.generation += 1;
            }
            Brought::File(_, _, Err(error)) | Brought::Against(Err(error)) => self.say(error),
        }
    }

    fn opened(&mut self, path: &Path, role: Role, opened: Opened) {
        match (opened, role) {
            (Opened::Trace(trace), _) => {
                self.trace = Some(trace);
                self.generation += 1;
            }
            (Opened::Accuracy(accuracy), _) => {
                // From the finest frame down.
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
                    Brought::Against(graph.plan(&question).map(Arc::new))
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

    /// Shows a plan; what was selected stays so by its name.
    fn put(&mut self, plan: Arc<PlanData>) {
        let old = self.plan.take();
        self.selected = self.selected.take().and_then(|item| {
            let form = &old.as_ref()?.form;
            match item {
                Item::Pass(index) => plan.pass(&form.passes.get(index)?.name).map(Item::Pass),
                Item::Resource(index) => plan.resource(&form.resources.get(index)?.name).map(Item::Resource),
                // Numbers of another plan.
                Item::Step(_) | Item::Flow(_) => None,
            }
        });
        self.plan = Some(plan);
        self.messages.retain(|message| !message.starts_with("the plan before is kept"));
        self.generation += 1;
    }

    /// Tells the user something that went wrong.
    pub fn say(&mut self, message: String) {
        if self.messages.last() != Some(&message) {
            self.messages.push(message);
        }
        let more = self.messages.len().saturating_sub(MESSAGES);
        self.messages.drain(..more);
    }
}
