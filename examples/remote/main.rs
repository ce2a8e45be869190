//! Engine that a viewer attaches to: `viewer --attach 127.0.0.1:9870`. See `README.md` in this folder.

mod cost;
mod frame;

use frame::Blur;
use framegraph_wgpu::remote::{DEFAULT_ADDRESS, Server};
use framegraph_wgpu::{AdapterRequest, FrameLoop, Gpu};
use program::cli::{self, Given, Parsed};
use std::error::Error;
use std::process::ExitCode;
use std::time::{Duration, Instant};

const ABOUT: &str = "Draws a small frame without a window, and serves it to viewers: viewer --attach HOST:PORT";
const AFTER: &str = "\
WGPU_BACKEND and WGPU_ADAPTER_NAME select another adapter.
Exit codes: 0 success, 1 device failure, 2 invalid option or address.";

/// Frame size in texels.
const SIZE: [u32; 2] = [640, 360];
/// Interval of the frames.
const INTERVAL: Duration = Duration::from_millis(16);

/// Command line.
struct Options {
    address: String,
    frames: u64,
    measure: bool,
}

/// Reads the options.
///
/// # Errors
/// One line that names an invalid option.
fn options(given: Given) -> Result<Options, String> {
    let mut options = Options { address: DEFAULT_ADDRESS.to_owned(), frames: u64::MAX, measure: given.has("measure") };
    for item in given {
        match item.name() {
            "listen" => options.address = item.text()?,
            "frames" => options.frames = item.parse("a number of frames", |text| text.parse().ok())?,
            _ => {}
        }
    }
    Ok(options)
}

fn main() -> ExitCode {
    let refuse = |error: String| {
        program::error(error);
        program::exit(2)
    };
    let listen = format!("address of the server (default {DEFAULT_ADDRESS}); port 0 selects a free port");
    let command = cli::command("remote_engine", ABOUT, AFTER).args([
        cli::option("listen", "HOST:PORT", listen),
        cli::option("frames", "N", "end after N frames; default: run until stopped"),
        cli::flag("measure", "print what viewers cost the frame, and how long they wait for a texture")
            .conflicts_with_all(["listen", "frames"]),
    ]);
    let given = match cli::parse(command, std::env::args_os().skip(1)) {
        Ok(Parsed::Help(text)) => {
            program::print(text);
            return program::exit(0);
        }
        Ok(Parsed::Given(given)) => given,
        Err(error) => return refuse(error),
    };
    let Options { address, frames, measure } = match options(given) {
        Ok(options) => options,
        Err(error) => return refuse(error),
    };
    if measure {
        return finish(cost::measure());
    }
    match Server::start(address, "remote_engine") {
        Ok(server) => finish(draw(server, frames)),
        Err(error) => refuse(format!("--listen {error}")),
    }
}

fn finish(done: Result<(), Box<dyn Error>>) -> ExitCode {
    match done {
        Ok(()) => program::exit(0),
        Err(error) => {
            program::error(error);
            program::exit(1)
        }
    }
}

/// Draws frames and serves them.
fn draw(mut server: Server, count: u64) -> Result<(), Box<dyn Error>> {
    let gpu = Gpu::open(&AdapterRequest::from_env())?;
    let mut frames = FrameLoop::new(&gpu);
    program::line(format_args!("viewer --attach {}", server.address()));
    for number in 0..count {
        let begun = Instant::now();
        let world = Blur { angle: number as f32 * 0.02 };
        frames.run(SIZE, &world, frame::declare)?;
        // The only line that attaching needs.
        server.after_frame(&mut frames, &world);
        std::thread::sleep(INTERVAL.saturating_sub(begun.elapsed()));
    }
    Ok(())
}
