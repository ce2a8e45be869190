//! The window.

use crate::args::Args;
use crate::{Failure, first, standard};
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use eframe::{App, Frame, NativeOptions, Renderer};
use egui::{ViewportBuilder, ViewportCommand};
use framegraph_wgpu::Gpu;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use viewer::app::{Role, Session, Viewer};
use viewer::drawing::Theme;
use viewer::live::Live;
use viewer::live::capture::Document;
use viewer::live::screen::Screen;
use viewer::remembered::Remembered;

/// State of the window.
struct Program {
    viewer: Viewer,
    /// Files to open after the current one.
    waiting: Vec<(PathBuf, Role)>,
    select: Option<String>,
    frames: Option<u64>,
    drawn: u64,
    /// File that keeps the state of the window; `None` if the system has no folder for it.
    kept: Option<PathBuf>,
    /// Size of the window in points.
    size: Option<[f32; 2]>,
    /// Chosen theme.
    dark: Option<bool>,
}

/// Size of the first window in points.
const SIZE: [f32; 2] = [1280.0, 720.0];

/// Shows the window until it is closed.
///
/// # Errors
/// No window or no device.
pub fn run(args: &Args) -> Result<(), Failure> {
    let document = document(args)?;
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.device_descriptor = Arc::new(Gpu::descriptor);
    let wgpu_options = WgpuConfiguration { wgpu_setup: WgpuSetup::CreateNew(setup), ..WgpuConfiguration::default() };
    let kept = Remembered::file(args.live);
    let remembered = kept.as_deref().map(Remembered::read).unwrap_or_default();
    // The zoom applies to points, so a larger font needs a larger window.
    let size = remembered.size.unwrap_or(SIZE).map(|side| side * args.scale);
    let options = NativeOptions {
        wgpu_options,
        viewport: ViewportBuilder::default()
            .with_title("viewer")
            .with_inner_size(size)
            .with_clamp_size_to_monitor_size(true)
            .with_drag_and_drop(true),
        renderer: Renderer::Wgpu,
        ..NativeOptions::default()
    };
    let ctx = egui::Context::default();
    let wake = ctx.clone();
    let mut session = Session::new(first(args)?, move || wake.request_repaint());
    standard(args, &mut session)?;
    let args = args.clone();
    let create: eframe::AppCreator<'_> = Box::new(move |cc| {
        let mut shown = match (&document, &cc.wgpu_render_state) {
            (Some(document), Some(state)) => {
                let wake = cc.egui_ctx.clone();
                let scene = args.file.as_ref().map_or("spheres".into(), |file| file.to_string_lossy());
                let (screen, environment) = (Screen::of(state), args.environment.as_deref());
                let mut live = Live::new(screen, document.clone(), &scene, environment, move || wake.request_repaint());
                live.continuous = args.frames.is_some();
                Viewer::with(session, live)
            }
            (Some(_), None) => return Err("eframe opened no device".into()),
            (None, _) => Viewer::new(session),
        };
        if let Some(dark) = args.theme.map(|theme| theme == Theme::Dark).or(remembered.dark) {
            cc.egui_ctx.set_theme(if dark { egui::Theme::Dark } else { egui::Theme::Light });
        }
        viewer::panel::dress(&cc.egui_ctx);
        cc.egui_ctx.set_zoom_factor(args.scale);
        if let Some(text) = &remembered.panes {
            shown.arrange(text);
        }
        if let Some(view) = args.view {
            shown.turn_to(view);
        }
        shown.recent = remembered.recent;
        if let Some(address) = &args.attach {
            let wake = cc.egui_ctx.clone();
            shown.attach(address, move || wake.request_repaint());
        }
        let files =
            [(args.against, Role::Against), (args.trace, Role::Shown), (args.file.filter(|_| !args.live), Role::Shown)];
        let waiting = files.into_iter().filter_map(|(path, role)| Some((path?, role))).collect();
        Ok(Box::new(Program {
            viewer: shown,
            waiting,
            select: args.select,
            frames: args.frames,
            drawn: 0,
            kept,
            size: None,
            dark: None,
        }))
    });
    eframe::run_native_ext("viewer", options, Some(ctx), create)
        .map_err(|e| Failure::Device(format!("window: cannot be opened: {e}")))
}

/// Returns the initial settings of the live frame; `None` without one.
fn document(args: &Args) -> Result<Option<Document>, Failure> {
    if !args.live {
        return Ok(None);
    }
    let which = args.settings.as_deref().unwrap_or("high");
    let frame = viewer::standard_frame::settings(which).map_err(|e| Failure::Input(format!("--settings: {e}")))?;
    Ok(Some(Document { frame, ..Document::default() }))
}

impl App for Program {
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn ui(&mut self, ui: &mut egui::Ui, _: &mut Frame) {
        self.viewer.session.poll();
        if self.viewer.session.doing().is_none() {
            if let Some((path, role)) = self.waiting.pop() {
                self.viewer.open(&path, role);
            } else if let Some((name, plan)) = self.select.take().zip(self.viewer.session.plan.as_ref()) {
                use viewer::drawing::Item;
                let item = plan.pass(&name).map(Item::Pass).or(plan.resource(&name).map(Item::Resource));
                self.viewer.select(item);
            }
        }
        self.viewer.show(ui);
        // Count frames only after the scene is loaded.
        let loading = self.viewer.live.as_ref().is_some_and(|live| live.running.is_none() && live.doing().is_some());
        let of_scene = self.viewer.live.as_ref().map(|live| live.running.as_ref().map_or(0, |r| u64::from(r.drawn())));
        match of_scene {
            // Several frames of the window may show one frame of the scene.
            Some(drawn) => self.drawn = self.drawn.max(drawn),
            None => self.drawn += u64::from(!loading),
        }
        let size = ui.input(|i| i.viewport().inner_rect.map(|rect| [rect.width(), rect.height()]));
        self.size = size.or(self.size);
        self.dark = match ui.ctx().options(|options| options.theme_preference) {
            egui::ThemePreference::System => None,
            preference => Some(preference == egui::ThemePreference::Dark),
        };
        if let Some(frames) = self.frames {
            if self.drawn >= frames {
                ui.ctx().send_viewport_cmd(ViewportCommand::Close);
            }
            // Redraw continuously, although nothing changes.
            ui.ctx().request_repaint();
        }
    }

    fn on_exit(&mut self) {
        if self.frames.is_some() {
            if let Some(live) = &mut self.viewer.live {
                live.settle(&mut self.viewer.session, Duration::from_secs(60));
            }
            program::line(format_args!("{} frames", self.drawn));
            if let Some(running) = self.viewer.live.as_ref().and_then(|live| live.running.as_ref()) {
                program::line(format_args!("{} of the scene", running.drawn()));
            }
            // A run of a fixed length is automated, and does not change the window of the user.
            return;
        }
        let Some(path) = &self.kept else { return };
        let (panes, recent) = (self.viewer.arrangement(), self.viewer.recent.clone());
        Remembered { panes, dark: self.dark, size: self.size, recent }.write(path);
    }
}
