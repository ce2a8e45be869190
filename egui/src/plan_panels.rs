//! Everything about one plan in one widget.

mod recompiled;
#[cfg(test)]
mod tests;

use crate::drawing::Item;
use crate::editor;
use crate::job::Job;
use crate::panel::{List, Questions, Reaction, Shown, ViewData, Views};
use crate::plan_data::PlanData;
use crate::trace_data::TraceData;
use crate::view::View;
use crate::what_if::{Planner, WhatIf};
use egui::{CentralPanel, Panel, RichText, Ui};
use framegraph::Plan;
use recompiled::Recompiled;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// Minimum width for a column with the inspector beside the views, in points.
const WIDE: f32 = 720.0;

/// Front tab.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Tab {
    View(View),
    Search,
    WhatIf,
}

/// Texture that the inspector shows for a resource of the plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preview {
    /// Texture registered with the application's egui renderer.
    pub texture: egui::TextureId,
    /// Width and height in texels.
    pub size: [f32; 2],
}

/// Tabs of all views, a search, what-if questions and an inspector for one plan.
///
/// Call [`update`](Self::update) with the plan of the frame, then [`show`](Self::show), in every frame of the UI.
///
/// ```
/// # use framegraph::{Caps, Graph, Options, Plan, Scratch, compile};
/// use framegraph_egui::PlanPanels;
///
/// let mut plan = Plan::new();
/// compile(&Graph::new(), &Caps::wgpu(), &Options::default(), &mut Scratch::new(), &mut plan)?;
/// let mut panels = PlanPanels::new();
/// let mut output = egui::Context::default().run_ui(egui::RawInput::default(), |ui| {
///     panels.update(&plan);
///     panels.show(ui);
/// });
/// # output.textures_delta.clear();
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct PlanPanels {
    /// Selected item of the plan.
    pub selected: Option<Item>,
    /// Textures of resources by name, for the inspector.
    pub previews: BTreeMap<String, Preview>,
    /// Folder that source locations are relative to, unless they exist in the current folder.
    pub sources: PathBuf,
    tab: Tab,
    views: Views,
    list: List,
    /// Plan of the frame.
    base: Option<Arc<PlanData>>,
    /// Plan under the what-if conditions.
    asked: Option<Arc<PlanData>>,
    trace: Option<Arc<TraceData>>,
    questions: Option<Questions>,
    job: Option<Job<Result<PlanData, String>>>,
    /// Conditions of the running or the last job.
    last_asked: Option<WhatIf>,
    error: Option<String>,
    compilation: u64,
    generation: u64,
    times: u64,
}

impl Default for PlanPanels {
    fn default() -> Self {
        Self::new()
    }
}

impl PlanPanels {
    /// Creates panels without a plan.
    pub fn new() -> Self {
        Self {
            selected: None,
            previews: BTreeMap::new(),
            sources: PathBuf::new(),
            tab: Tab::View(View::Graph),
            views: Views::default(),
            list: List::default(),
            base: None,
            asked: None,
            trace: None,
            questions: None,
            job: None,
            last_asked: None,
            error: None,
            compilation: 0,
            generation: 0,
            times: 0,
        }
    }

    /// Shows a plan. Costs nothing while the plan is the one of the last call.
    pub fn update(&mut self, plan: &Plan) {
        if self.compilation == plan.compilation() {
            return;
        }
        self.compilation = plan.compilation();
        match PlanData::of(plan, "frame") {
            Ok(data) => self.set_plan(Arc::new(data)),
            Err(error) => self.error = Some(error.to_string()),
        }
    }

    /// Shows a plan that was read from a file, or that another process sent.
    pub fn set_plan(&mut self, plan: Arc<PlanData>) {
        let name_of = |item: Item| {
            let form = &self.base.as_ref()?.form;
            match item {
                Item::Pass(index) => plan.pass(&form.passes.get(index)?.name).map(Item::Pass),
                Item::Resource(index) => plan.resource(&form.resources.get(index)?.name).map(Item::Resource),
                // Steps and flows have no name that both plans share.
                Item::Step(_) | Item::Flow(_) => None,
            }
        };
        self.selected = self.selected.and_then(name_of);
        self.questions = plan.plan.as_deref().map(|plan| {
            let base = WhatIf::of(plan.caps().clone(), plan.options());
            let mut questions = Questions::new(base.clone());
            if let Some(old) = &self.questions {
                questions.asked = old.asked.moved(&old.base, &base);
            }
            questions
        });
        (self.base, self.asked, self.error) = (Some(plan), None, None);
        (self.job, self.last_asked) = (None, None);
        self.generation += 1;
    }

    /// Shows frame times in the timeline, the trace and the queues.
    pub fn set_trace(&mut self, trace: TraceData) {
        self.trace = Some(Arc::new(trace));
        self.times += 1;
    }

    /// Returns the shown plan: the one of the frame, or the one under the what-if conditions.
    pub fn plan(&self) -> Option<&Arc<PlanData>> {
        self.asked.as_ref().or(self.base.as_ref())
    }

    /// Brings a view to the front.
    pub fn turn_to(&mut self, view: View) {
        self.tab = Tab::View(view);
    }

    /// Shows all panels in the available space.
    pub fn show(&mut self, ui: &mut Ui) {
        self.answer(ui);
        let wide = ui.available_width() >= WIDE;
        ui.horizontal_wrapped(|ui| {
            let views = View::ALL.into_iter().filter(|view| !(wide && *view == View::Inspector));
            let tabs = views.map(|view| (Tab::View(view), view.word()));
            for (tab, name) in tabs.chain([(Tab::Search, "search"), (Tab::WhatIf, "what-if")]) {
                ui.selectable_value(&mut self.tab, tab, name);
            }
        });
        if let Some(error) = &self.error {
            ui.label(RichText::new(error).color(ui.visuals().error_fg_color));
        }
        if wide {
            Panel::right(ui.scope_id().with("inspector"))
                .default_size(280.0)
                .show(ui, |ui| self.view(ui, View::Inspector));
        }
        CentralPanel::default().show(ui, |ui| match self.tab {
            Tab::View(View::Inspector) if wide => self.view(ui, View::Graph),
            Tab::View(view) => self.view(ui, view),
            Tab::Search => {
                if let Some(plan) = self.plan().cloned() {
                    self.selected = self.list.show(ui, &plan, self.selected).or(self.selected);
                }
            }
            Tab::WhatIf => self.ask(ui),
        });
    }

    fn view(&mut self, ui: &mut Ui, view: View) {
        if self.base.is_none() && view.is_of_a_plan() {
            ui.label("No plan was compiled yet");
            return;
        }
        if view == View::Inspector {
            self.preview(ui);
        }
        let data = ViewData {
            plan: self.asked.as_ref().or(self.base.as_ref()),
            against: self.base.as_ref().filter(|_| self.asked.is_some()),
            trace: self.trace.as_ref(),
            selected: self.selected,
            generation: self.generation,
            times: self.times,
        };
        match self.views.show(ui, view, data) {
            Some(Reaction::Select(item)) => self.selected = item,
            Some(Reaction::Source(place)) => self.error = editor::open(&place, &self.sources).err(),
            None => {}
        }
    }

    /// Shows the texture of the selected resource.
    fn preview(&self, ui: &mut Ui) {
        let Some((Item::Resource(index), plan)) = self.selected.zip(self.plan()) else { return };
        let name = plan.form.resources.get(index).map(|resource| resource.name.as_str()).unwrap_or_default();
        if let Some(preview) = self.previews.get(name) {
            let image = egui::Image::new((preview.texture, preview.size.into()));
            ui.add(image.max_size(egui::vec2(ui.available_width(), 0.4 * ui.available_height())));
        }
    }

    /// Shows the what-if questions, and compiles the plan again on another thread if they changed.
    fn ask(&mut self, ui: &mut Ui) {
        let (base, asked, planning) = (self.base.clone(), self.plan().cloned(), self.job.is_some());
        let Some(questions) = &mut self.questions else {
            ui.label("A saved plan contains no graph, so it cannot be compiled under other conditions");
            return;
        };
        let shown = Shown { base: base.as_deref(), now: asked.as_deref(), planning, read_device: None };
        questions.show(ui, shown);
    }

    /// Takes the answer of a what-if question, or starts the next.
    fn answer(&mut self, ui: &Ui) {
        if let Some((job, done)) = self.job.as_ref().and_then(|job| Some((job, job.poll()?))) {
            match done {
                Ok(Ok(plan)) => (self.asked, self.error) = (Some(Arc::new(plan)), None),
                Ok(Err(error)) => self.error = Some(error),
                Err(()) => self.error = Some(job.failure()),
            }
            self.job = None;
            self.generation += 1;
        }
        let (Some(questions), Some(base)) = (&self.questions, &self.base) else { return };
        let Some(plan) = base.plan.clone() else { return };
        if questions.asked == questions.base {
            self.generation += u64::from(self.asked.is_some());
            if self.last_asked.is_some() {
                // The error of a question that was taken back.
                self.error = None;
            }
            (self.asked, self.job, self.last_asked) = (None, None, None);
        } else if self.last_asked.as_ref() != Some(&questions.asked) {
            let (what_if, ctx) = (questions.asked.clone(), ui.ctx().clone());
            self.last_asked = Some(what_if.clone());
            let work = move |_: &_| Recompiled(plan).plan(&what_if);
            self.job = Some(Job::start("compiling", move || ctx.request_repaint(), work));
        }
    }
}
