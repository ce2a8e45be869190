//! A display without a screen, for programs that open windows.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

/// A server of X11 that shows nothing, gone with this value.
#[derive(Debug)]
pub struct Display {
    server: Child,
    /// What `DISPLAY` names it by.
    pub name: String,
}

impl Display {
    /// One with a screen of 1280 × 800 texels; none where there is no `Xvfb`.
    pub fn open() -> Option<Self> {
        let mut server = Command::new("Xvfb");
        server.args(["-displayfd", "1", "-screen", "0", "1280x800x24", "-nolisten", "tcp"]);
        let server = server.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().ok()?;
        let mut display = Self { server, name: String::new() };
        let mut number = String::new();
        let read = display.server.stdout.take().map(|out| BufReader::new(out).read_line(&mut number));
        display.name = format!(":{}", number.trim());
        (matches!(read, Some(Ok(_))) && !number.trim().is_empty()).then_some(display)
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        // Asked to end, it takes its lock file with it.
        let asked = Command::new("kill").arg(self.server.id().to_string()).status();
        if !asked.is_ok_and(|status| status.success()) {
            let _ = self.server.kill();
        }
        let _ = self.server.wait();
    }
}
