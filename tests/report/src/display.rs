//! Virtual X11 display for programs that open windows.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

/// An Xvfb server, stopped when this value is dropped.
#[derive(Debug)]
pub struct Display {
    server: Child,
    /// Value of `DISPLAY` for client programs.
    pub name: String,
}

impl Display {
    /// Starts a server with a screen of 1280 × 800 pixels; `None` if `Xvfb` is not installed.
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
        // After SIGTERM, the server removes its lock file.
        let asked = Command::new("kill").arg(self.server.id().to_string()).status();
        if !asked.is_ok_and(|status| status.success()) {
            let _ = self.server.kill();
        }
        let _ = self.server.wait();
    }
}
