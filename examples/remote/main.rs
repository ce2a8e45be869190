//! Engine that a viewer attaches to: `viewer --attach 127.0.0.1:9870`. See `README.md` in this folder.

mod cost;
mod frame;

use frame::Blur;
use framegraph_wgpu::remote::{DEFAULT_ADDRESS, Server};
use framegraph_wgpu::{AdapterRequest, FrameLoop, Gpu};
use std::error::Error;
use std::process::ExitCode;
use std::time::{Duration, Instant};

const HELP: &str = "\
Draws a small frame without a window, and serves it to viewers: viewer --attach HOST:PORT

usage: remote_engine [--listen HOST:PORT] [--frames N]
       remote_engine --measure

  --listen HOST:PORT   address of the server (127.0.0.1:9870); port 0 selects a free port
  --frames N           end after N frames; default: run until stopped
  --measure            print what viewers cost the frame, and how long they wait for a texture

WGPU_BACKEND and WGPU_ADAPTER_NAME select another adapter.
Exit codes: 0 success, 1 device failure, 2 invalid option or address.";

/// Frame size in texels.
const SIZE: [u32; 2] = [640, 360];
/// Interval of the frames.
const INTERVAL: Duration = Duration::from_millis(16);

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args_os().skip(1).map(|arg| arg.to_string_lossy().into_owned()).collect();
    let (mut address, mut frames) = (DEFAULT_ADDRESS.to_owned(), u64::MAX);
    let mut rest = args.iter().map(String::as_str);
    while let Some(arg) = rest.next() {
        match (arg, rest.next()) {
            ("--help" | "-h", None) => {
                program::line(HELP);
                return program::exit(0);
            }
            ("--measure", None) if args.len() == 1 => return finish(cost::measure()),
            ("--listen", Some(given)) => given.clone_into(&mut address),
            ("--frames", Some(given)) if given.parse::<u64>().is_ok() => frames = given.parse().unwrap_or(frames),
            _ => {
                program::error(format_args!("{arg}: invalid option; `remote_engine --help` lists the options"));
                return program::exit(2);
            }
        }
    }
    match Server::start(address, "remote_engine") {
        Ok(server) => finish(draw(server, frames)),
        Err(error) => {
            program::error(format_args!("--listen {error}"));
            program::exit(2)
        }
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
