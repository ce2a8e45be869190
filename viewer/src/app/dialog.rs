//! The desktop's own dialogs for files: asked on a thread of their own, so that frames go on.

use crate::job::Job;
use crate::session::Role;
use crate::view::View;
use egui::Context;
use rfd::AsyncFileDialog;
use std::path::PathBuf;

/// What a file is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// To be opened.
    Open(Role),
    /// To write the settings of the frame to.
    SaveSettings,
    /// To write a view, or the plan, to.
    Export(View),
    /// To write the times of frames to.
    Trace,
}

impl Purpose {
    /// Kinds of files with their endings.
    const fn kinds(self) -> &'static [(&'static str, &'static [&'static str])] {
        match self {
            Self::Open(_) => &[
                ("all that is opened", &["json", "ron", "gltf", "glb", "hdr", "exr", "ktx", "ktx2"]),
                ("plans, traces, records", &["json"]),
                ("graphs, settings", &["ron"]),
                ("scenes", &["gltf", "glb"]),
                ("light from all around", &["hdr", "exr", "ktx", "ktx2"]),
            ],
            Self::SaveSettings => &[("settings", &["ron"])],
            Self::Export(_) => &[("a view", &["svg", "png", "txt"]), ("the plan", &["json", "ron", "dot", "mmd"])],
            Self::Trace => &[("frames, for Perfetto", &["json"])],
        }
    }

    /// The name that a new file begins with; none of one that is opened.
    fn begun(self) -> Option<String> {
        match self {
            Self::Open(_) => None,
            Self::SaveSettings => Some("settings.ron".into()),
            Self::Export(view) => Some(format!("{}.svg", view.word())),
            Self::Trace => Some("trace.json".into()),
        }
    }
}

/// A dialog that is open, if one is.
#[derive(Debug, Default)]
pub(super) struct Dialog {
    open: Option<(Purpose, Job<Option<PathBuf>>)>,
}

impl Dialog {
    /// Opens one, unless another is open: what it is answered wakes the window.
    pub fn ask(&mut self, purpose: Purpose, ctx: &Context) {
        if self.open.is_some() {
            return;
        }
        let mut dialog = AsyncFileDialog::new();
        for (name, endings) in purpose.kinds() {
            dialog = dialog.add_filter(*name, endings);
        }
        // Begun here: some systems want the thread that has the window.
        let begun = purpose.begun();
        let answer: Box<dyn Future<Output = Option<rfd::FileHandle>> + Send + Unpin> = match begun {
            None => Box::new(Box::pin(dialog.pick_file())),
            Some(name) => Box::new(Box::pin(dialog.set_file_name(name).save_file())),
        };
        let ctx = ctx.clone();
        let wait = move |_: &crate::job::Handle| pollster::block_on(answer).map(|file| file.path().to_owned());
        self.open = Some((purpose, Job::start("choosing a file", move || ctx.request_repaint(), wait)));
    }

    /// The file that was chosen since it was last asked.
    pub fn answer(&mut self) -> Option<(Purpose, PathBuf)> {
        let (purpose, job) = self.open.as_ref()?;
        let (purpose, answer) = (*purpose, job.poll()?);
        self.open = None;
        Some((purpose, answer.ok()??))
    }
}
