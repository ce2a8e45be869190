//! Shows a frame's passes, decisions and costs.

mod args;
mod headless;
mod window;

use framegraph::Caps;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;
use viewer::app::{Role, Session};
use viewer::attached::Attached;
use viewer::drawing::Item;
use viewer::standard_frame::StandardFrame;
use viewer::what_if::WhatIf;

/// Reason that nothing is shown.
#[derive(Debug)]
pub enum Failure {
    /// Invalid input or output, one line per error.
    Input(String),
    /// No device or no window.
    Device(String),
}

fn main() -> ExitCode {
    let args = match args::parse(std::env::args_os().skip(1)) {
        Ok(args::Command::Show(args)) => args,
        Ok(args::Command::Help(text)) => {
            program::print(text);
            return program::exit(0);
        }
        Err(message) => {
            program::error(message);
            return program::exit(2);
        }
    };
    program::interrupt::exit_when_asked();
    let done = match &args.out {
        _ if args.measure => {
            let scene = args.file.as_ref().map_or("spheres".into(), |file| file.to_string_lossy());
            viewer::measuring::table(&scene).map(program::print).map_err(Failure::Device)
        }
        Some(out) => headless::run(&args, out),
        None => window::run(&args),
    };
    match done {
        Ok(()) => program::exit(0),
        Err(Failure::Input(lines)) => {
            lines.lines().for_each(program::error);
            program::exit(2)
        }
        Err(Failure::Device(line)) => {
            program::error(line);
            program::exit(3)
        }
    }
}

/// Maximum time to wait for plan and times of an engine, in runs without a window.
const ATTACH_PATIENCE: Duration = Duration::from_secs(30);

/// Returns the initial what-if for graphs.
fn first(args: &args::Args) -> Result<WhatIf, Failure> {
    let caps = match Caps::preset(&args.caps) {
        Some(caps) => caps,
        None if args.caps.ends_with(".ron") => {
            let path = &args.caps;
            let text = program::input::text(Path::new(path), program::input::MAX_TEXT_BYTES).map_err(Failure::Input)?;
            framegraph::file::caps(path, &text).map_err(|e| Failure::Input(e.to_string()))?
        }
        None => {
            let presets = Caps::PRESETS.join(", ");
            return Err(Failure::Input(format!(
                "--caps: invalid value `{}`; expected {presets} or a FILE.ron",
                args.caps
            )));
        }
    };
    Ok(WhatIf { frame: args.size, order: args.order, features: args.features.clone(), ..WhatIf::on(caps) })
}

/// Shows the standard frame if requested.
fn standard(args: &args::Args, session: &mut Session) -> Result<(), Failure> {
    if let Some(which) = &args.standard {
        let frame = StandardFrame::open(which).map_err(|e| Failure::Input(format!("--standard: {e}")))?;
        session.show(Arc::new(frame));
    }
    Ok(())
}

/// Waits for the running work.
fn settled(session: &mut Session) -> Result<(), Failure> {
    // Large files take long; the user can end the program.
    while !session.settle(Duration::from_secs(3600)) {}
    if session.messages.is_empty() { Ok(()) } else { Err(Failure::Input(session.messages.join("\n"))) }
}

/// Opens all files in sequence and waits for each, in runs without a window.
fn opened(args: &args::Args, session: &mut Session) -> Result<(), Failure> {
    standard(args, session)?;
    settled(session)?;
    if let Some(address) = &args.attach {
        let mut attached = Attached::open(address, || {});
        let complete = attached.settle(session, ATTACH_PATIENCE);
        if !complete {
            session.say(format!("{address}: the engine draws no frame; run it while the viewer is attached"));
        }
        settled(session)?;
    }
    let files = [(&args.file, Role::Shown), (&args.trace, Role::Shown), (&args.against, Role::Against)];
    for (path, role) in files {
        let Some(path) = path else { continue };
        session.open(path, role);
        settled(session)?;
    }
    Ok(())
}

/// Returns the pass or resource with a name.
fn selected(name: &str, session: &Session) -> Result<Item, Failure> {
    let plan = session.plan.as_ref();
    let item = plan.and_then(|plan| plan.pass(name).map(Item::Pass).or(plan.resource(name).map(Item::Resource)));
    item.ok_or_else(|| Failure::Input(format!("--select: unknown pass or resource `{name}`")))
}

/// Compares the extension of a path.
fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension))
}
