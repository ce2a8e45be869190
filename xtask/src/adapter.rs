//! Detection of a graphics adapter, and installation of a software driver if none is found.
//!
//! `facts` reads the machine, `verdict` judges the facts, `packages` says what to install and how;
//! the last two are pure. [`ready`] puts them together.
//!
//! The probe looks at files, since opening a device needs the very libraries that may be missing.
//! It can therefore be wrong in one direction: a driver that is installed and has its hardware may
//! still fail to start. The programs that open the device say which one they got.

mod facts;
mod manifest;
mod packages;
mod verdict;

use std::ffi::OsString;
use std::path::Path;
use std::process::Stdio;

use crate::Failure;
use crate::options::Options;
use crate::stage;
use facts::Machine;
use packages::{Install, Want};
use verdict::Verdict;

/// Makes sure that a usable adapter exists; installs Mesa's software Vulkan driver where none does. Returns a
/// description of the adapter.
///
/// # Errors
/// With `--no-install`: the command to run. Otherwise: the reason nothing could be installed, the command that failed,
/// or what is still missing afterwards.
pub fn ready(options: &Options) -> Result<String, Failure> {
    let missing = match probe() {
        Verdict::Usable(found) => {
            program::line(format_args!("xtask: adapter: {found}"));
            return Ok(found);
        }
        Verdict::Overridden { variable, reason } => {
            return Err(Failure::Failed(format!(
                "no usable adapter: the environment variable {variable} hides all other drivers, \
                 and {reason}; unset it or name a driver's manifest"
            )));
        }
        Verdict::Missing(reason) => reason,
    };
    let install = packages::plan(&facts::packages(&machine(&variable)), Want::Driver)
        .map_err(|reason| Failure::Failed(format!("no usable adapter: {missing}; {reason}")))?;
    if options.no_install {
        return Err(Failure::Failed(format!(
            "no usable adapter: {missing}; Mesa's software Vulkan driver is installed by: {install}"
        )));
    }
    program::line(format_args!("xtask: no usable adapter: {missing}"));
    program::line(format_args!("xtask: installing Mesa's software Vulkan driver: {install}"));
    carry_out(&install)?;
    match probe() {
        Verdict::Usable(found) => {
            program::line(format_args!("xtask: adapter: {found}"));
            Ok(found)
        }
        Verdict::Missing(reason) | Verdict::Overridden { reason, .. } => {
            Err(Failure::Failed(format!("still no usable adapter after `{install}`: {reason}")))
        }
    }
}

/// Installs Vulkan's validation layers and Xvfb, which tests of Vulkan streams and of windows use. If that fails, a
/// message says so, and those tests are skipped.
pub fn checks(options: &Options) {
    let missing = facts::missing_checks(&machine(&variable));
    if missing.is_empty() || !cfg!(target_os = "linux") {
        return;
    }
    let missing = missing.join(" and ");
    let told = match packages::plan(&facts::packages(&machine(&variable)), Want::Checks) {
        Err(reason) => reason,
        Ok(install) if options.no_install => format!("install them with: {install}"),
        Ok(install) => {
            program::line(format_args!("xtask: installing {missing}: {install}"));
            match carry_out(&install) {
                Ok(()) => return,
                Err(failure) => failure.to_string(),
            }
        }
    };
    program::line(format_args!("xtask: tests that need {missing} are skipped: {told}"));
}

/// Judges the machine this runs on.
fn probe() -> Verdict {
    if let Some(api) = native_api() {
        return Verdict::Usable(format!("{api}, part of the operating system"));
    }
    verdict::judge(&facts::graphics(&machine(&variable)))
}

/// Graphics interface of the operating system, if it has one. These systems need no driver package: they always have
/// hardware, or include a software adapter.
const fn native_api() -> Option<&'static str> {
    if cfg!(target_vendor = "apple") {
        Some("Metal")
    } else if cfg!(windows) {
        Some("Direct3D 12")
    } else {
        None
    }
}

fn variable(name: &str) -> Option<OsString> {
    std::env::var_os(name).filter(|value| !value.is_empty())
}

fn machine(variable: &dyn Fn(&str) -> Option<OsString>) -> Machine<'_> {
    Machine { root: Path::new("/"), variable }
}

/// Runs the attempts of `install` until one succeeds as a whole.
fn carry_out(install: &Install) -> Result<(), Failure> {
    let mut reason = String::new();
    for attempt in &install.attempts {
        let failed = attempt.iter().find_map(|line| {
            let mut command = line.command();
            // An installer must not wait for input; a password is asked for at the terminal itself.
            let outcome = stage::run("install", command.stdin(Stdio::null()));
            outcome.result.err().map(|reason| format!("`{line}`: {reason}"))
        });
        match failed {
            None => return Ok(()),
            Some(failed) => reason = failed,
        }
    }
    Err(Failure::Failed(format!("installation failed: {reason}")))
}
