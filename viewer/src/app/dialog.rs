//! File dialogs of the desktop, on a separate thread so that frames continue.

use super::panes::Pane;
use crate::job::Job;
use crate::session::Role;
use egui::Context;
use rfd::AsyncFileDialog;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Purpose of a file dialog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Opens a file.
    Open(Role),
    /// Saves the settings of the frame.
    SaveSettings,
    /// Exports a view or the plan.
    Export(Pane),
    /// Exports frame times.
    Trace,
    /// Saves the texture of the preview.
    Texture,
}

impl Purpose {
    /// Returns the file filters with their extensions.
    const fn kinds(self) -> &'static [(&'static str, &'static [&'static str])] {
        match self {
            Self::Open(_) => &[
                ("all supported files", &["json", "ron", "gltf", "glb", "hdr", "exr", "ktx", "ktx2"]),
                ("plans, traces, records", &["json"]),
                ("graphs, settings", &["ron"]),
                ("scenes", &["gltf", "glb"]),
                ("environments", &["hdr", "exr", "ktx", "ktx2"]),
            ],
            Self::SaveSettings => &[("settings", &["ron"])],
            Self::Export(_) => &[("a view", &["svg", "png", "txt"]), ("the plan", &["json", "ron", "dot", "mmd"])],
            Self::Trace => &[("frame times for Perfetto", &["json"])],
            Self::Texture => &[("the picture", &["png"]), ("the values", &["exr"])],
        }
    }

    /// Returns the suggested name of a new file; `None` for opening a file.
    fn suggested_name(self) -> Option<String> {
        match self {
            Self::Open(_) => None,
            Self::SaveSettings => Some("settings.ron".into()),
            Self::Export(pane) => Some(format!("{}.svg", pane.word())),
            Self::Trace => Some("trace.json".into()),
            Self::Texture => Some("texture.png".into()),
        }
    }
}

/// Maximum time in which a desktop without a file dialog answers; users take longer.
const NO_DIALOG: Duration = Duration::from_millis(400);

/// Answer of a file dialog.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Answer {
    /// Chosen file.
    File(PathBuf),
    /// The user closed the dialog.
    Cancelled,
    /// The desktop has no file dialog.
    NoDialog,
}

/// State of the file dialog.
#[derive(Debug, Default)]
pub(super) struct Dialog {
    open: Option<(Purpose, Instant, Job<(Option<PathBuf>, Instant)>)>,
}

impl Dialog {
    /// Opens a dialog unless one is open. The answer wakes the window.
    pub fn ask(&mut self, purpose: Purpose, ctx: &Context) {
        if self.open.is_some() {
            return;
        }
        let mut dialog = AsyncFileDialog::new();
        for (name, endings) in purpose.kinds() {
            dialog = dialog.add_filter(*name, endings);
        }
        // Created on this thread, because some systems require the thread of the window.
        let suggested = purpose.suggested_name();
        let answer: Box<dyn Future<Output = Option<rfd::FileHandle>> + Send + Unpin> = match suggested {
            None => Box::new(Box::pin(dialog.pick_file())),
            Some(name) => Box::new(Box::pin(dialog.set_file_name(name).save_file())),
        };
        let ctx = ctx.clone();
        let wait = move |_: &crate::job::Handle| {
            let file = pollster::block_on(answer).map(|file| file.path().to_owned());
            (file, Instant::now())
        };
        let job = Job::start("choosing a file", move || ctx.request_repaint(), wait);
        self.open = Some((purpose, Instant::now(), job));
    }

    /// Returns a new answer with its purpose.
    pub fn answer(&mut self) -> Option<(Purpose, Answer)> {
        let (purpose, asked, job) = self.open.as_ref()?;
        let (purpose, asked, result) = (*purpose, *asked, job.poll()?);
        self.open = None;
        let answer = match result {
            Ok((Some(file), _)) => Answer::File(file),
            // The portal reports a missing dialog like a cancelled one, but at once.
            Ok((None, at)) if at.duration_since(asked) > NO_DIALOG => Answer::Cancelled,
            Ok((None, _)) | Err(()) => Answer::NoDialog,
        };
        Some((purpose, answer))
    }
}
