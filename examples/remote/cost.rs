//! Cost of viewers in the frame, and the time until a texture arrives.

use super::frame::{Blur, declare};
use crate::SIZE;
use framegraph::Aspect;
use framegraph_wgpu::remote::{Connection, FromEngine, FromViewer, RemoteError, Server, TextureRequest};
use framegraph_wgpu::{AdapterRequest, FrameLoop, Gpu};
use std::error::Error;
use std::time::{Duration, Instant};

/// Frames of a block, and number of blocks of each kind.
const BLOCK: usize = 100;
const BLOCKS: usize = 20;
/// Viewers, in the order of the blocks.
const KINDS: [&str; 3] = ["no viewer", "a viewer that reads", "a viewer that does not read"];

/// Measures and prints a Markdown table.
///
/// # Errors
/// No device, or no free port.
pub fn measure() -> Result<(), Box<dyn Error>> {
    let gpu = Gpu::open(&AdapterRequest::from_env())?;
    let (mut frames, mut server) = (FrameLoop::new(&gpu), Server::start("127.0.0.1:0", "remote_engine")?);
    let address = server.address().to_string();
    // Step times are measured in all blocks, so that only the viewers differ.
    frames.executor_mut().set_timing(true);
    let mut number = 0u32;
    let mut draw = |frames: &mut FrameLoop<Blur>, server: &mut Server| -> Result<[f64; 2], Box<dyn Error>> {
        number += 1;
        let world = Blur { angle: number as f32 * 0.02 };
        let begun = Instant::now();
        frames.run(SIZE, &world, declare)?;
        let drawn = begun.elapsed();
        server.after_frame(frames, &world);
        let whole = begun.elapsed();
        Ok([whole, whole - drawn].map(|time| time.as_secs_f64() * 1e3))
    };
    for _ in 0..BLOCK {
        draw(&mut frames, &mut server)?;
    }
    let mut times: [Vec<[f64; 2]>; 3] = Default::default();
    for block in 0..BLOCKS * KINDS.len() {
        let kind = block % KINDS.len();
        let viewer = (kind > 0).then(|| Connection::open(&address)).transpose()?;
        let reader = viewer.as_ref().filter(|_| kind == 1).map(Connection::try_clone).transpose()?;
        let reader = reader.map(|viewer| std::thread::spawn(move || while viewer.receive().is_ok() {}));
        while server.counts().viewers != usize::from(kind > 0) {
            std::thread::sleep(Duration::from_millis(1));
        }
        for _ in 0..BLOCK {
            times[kind].push(draw(&mut frames, &mut server)?);
        }
        if let Some(viewer) = viewer {
            viewer.close();
        }
        let _ = reader.map(std::thread::JoinHandle::join);
        while server.counts().viewers > 0 {
            std::thread::sleep(Duration::from_millis(1));
        }
    }
    program::line("| frames with | median frame, ms | mean of the server's part, ms | share |");
    program::line("| --- | ---: | ---: | ---: |");
    for (kind, times) in KINDS.iter().zip(&times) {
        let frame = median(times.iter().map(|[whole, _]| *whole).collect());
        let own = times.iter().map(|[_, own]| own).sum::<f64>() / times.len() as f64;
        program::line(format_args!("| {kind} | {frame:.4} | {own:.5} | {:.2} % |", 100.0 * own / frame));
    }
    let viewer = Connection::open(&address)?;
    let requests = std::thread::spawn(move || latencies(&viewer));
    while !requests.is_finished() {
        draw(&mut frames, &mut server)?;
        std::thread::sleep(Duration::from_millis(1));
    }
    let latencies = requests.join().map_err(|_| "the viewer panicked")??;
    program::line(format_args!(
        "\nfrom a request to its texture: median {:.2} ms of {}",
        median(latencies.clone()),
        latencies.len()
    ));
    program::line(format_args!("on {}", gpu.describe()));
    Ok(())
}

/// Requests textures, and returns the times until they arrive, in milliseconds.
fn latencies(viewer: &Connection) -> Result<Vec<f64>, RemoteError> {
    let mut times = Vec::new();
    for number in 0..20 {
        // The server reads at most ten textures a second.
        std::thread::sleep(framegraph_wgpu::remote::TEXTURE_INTERVAL);
        let begun = Instant::now();
        let request = TextureRequest { number, text: "hdr".into(), aspect: Aspect::All, sample: None };
        viewer.send(&FromViewer::Texture(request))?;
        while !matches!(viewer.receive()?, FromEngine::Texture(_)) {}
        times.push(begun.elapsed().as_secs_f64() * 1e3);
    }
    Ok(times)
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_unstable_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(0.0)
}
