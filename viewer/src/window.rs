//! The window.

use crate::args::Args;
use crate::{Failure, first, standard};
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use eframe::{App, Frame, NativeOptions, Renderer};
use egui::{ViewportBuilder, ViewportCommand};
use framegraph_wgpu::Gpu;
use std::path::PathBuf;
use std::sync::Arc;
use viewer::app::{Pane, Role, Session, Viewer};
use viewer::drawing::Theme;
use viewer::live::Live;
use viewer::live::capture::Document;
use viewer::live::screen::Screen;
use viewer::view::View;

/// State of the window.
struct Program {
    viewer: Viewer,
    /// Files to open after the current one.
    waiting: Vec<(PathBuf, Role)>,
    select: Option<String>,
    frames: Option<u64>,
    drawn: u64,
    /// File that keeps the arrangement of panes; `None` if the system has no folder for it.
    kept: Option<PathBuf>,
}

/// Shows the window until it is closed.
///
/// # Errors
/// No window or no device.
pub fn run(args: &Args) -> Result<(), Failure> {
    let document = document(args)?;
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.device_descriptor = Arc::new(Gpu::descriptor);
    let wgpu_options = WgpuConfiguration { wgpu_setup: WgpuSetup::CreateNew(setup), ..WgpuConfiguration::default() };
    let options = NativeOptions {
        wgpu_options,
        viewport: ViewportBuilder::default()
            .with_title("viewer")
            .with_inner_size([1280.0, 720.0])
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
        if let Some(theme) = args.theme {
            cc.egui_ctx.set_theme(if theme == Theme::Dark { egui::Theme::Dark } else { egui::Theme::Light });
        }
        viewer::panel::dress(&cc.egui_ctx);
        cc.egui_ctx.set_zoom_factor(args.scale);
        let kept = kept(args.live);
        if let Some(text) = kept.as_ref().and_then(|path| std::fs::read_to_string(path).ok()) {
            shown.arrange(&text);
        }
        shown.turn_to(if args.live && args.view == View::Graph { Pane::Viewport } else { Pane::View(args.view) });
        let files =
            [(args.against, Role::Against), (args.trace, Role::Shown), (args.file.filter(|_| !args.live), Role::Shown)];
        let waiting = files.into_iter().filter_map(|(path, role)| Some((path?, role))).collect();
        Ok(Box::new(Program { viewer: shown, waiting, select: args.select, frames: args.frames, drawn: 0, kept }))
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

/// Returns the file of the pane arrangement.
///
/// It is `framegraph-viewer/panes.json` in the user's state folder (XDG Base Directory Specification 0.8), or in the
/// settings folder on other systems.
fn kept(live: bool) -> Option<PathBuf> {
    let folder = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let home = || Some(folder("HOME")?.join(".local/state"));
    let base = folder("XDG_STATE_HOME").or_else(|| folder("APPDATA")).or_else(home)?;
    let file = if live { "framegraph-viewer/panes-live.json" } else { "framegraph-viewer/panes.json" };
    Some(base.join(file))
}

impl App for Program {
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn ui(&mut self, ui: &mut egui::Ui, _: &mut Frame) {
        let session = &mut self.viewer.session;
        session.poll();
        if session.doing().is_none() {
            if let Some((path, role)) = self.waiting.pop() {
                session.open(&path, role);
            } else if let Some((name, plan)) = self.select.take().zip(session.plan.as_ref()) {
                use viewer::drawing::Item;
                let item = plan.pass(&name).map(Item::Pass).or(plan.resource(&name).map(Item::Resource));
                self.viewer.select(item);
            }
        }
        self.viewer.show(ui);
        // Count frames only after the scene is loaded.
        let loading = self.viewer.live.as_ref().is_some_and(|live| live.running.is_none() && live.doing().is_some());
        self.drawn += u64::from(!loading);
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
            program::line(format_args!("{} frames", self.drawn));
            if let Some(running) = self.viewer.live.as_ref().and_then(|live| live.running.as_ref()) {
                program::line(format_args!("{} of the scene", running.drawn()));
            }
        }
        let (Some(path), Some(text)) = (&self.kept, self.viewer.arrangement()) else { return };
        // Failing to save the arrangement is not worth a message.
        let _ = path.parent().map(std::fs::create_dir_all);
        let _ = std::fs::write(path, text);
    }
}
