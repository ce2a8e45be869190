//! The server for viewers: its messages, bad peers, and viewers that do not read.

use crate::bench::TestResult;
use framegraph::file::GraphFile;
use framegraph::{Aspect, ClearValue, DeclareError, Extent, Format, Intent, Options, Plan, Scratch, TextureDesc, dump};
use framegraph_wgpu::remote::{Connection, FromEngine, FromViewer, RemoteError, RemoteTexture, Server, TextureRequest};
use framegraph_wgpu::{FrameLoop, Gpu};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// Engine on a device that draws nothing.
struct Engine {
    frames: FrameLoop<()>,
    server: Server,
}

impl Engine {
    fn start() -> Result<Self, Box<dyn std::error::Error>> {
        Ok(Self { frames: FrameLoop::new(&Gpu::noop()?), server: Server::start("127.0.0.1:0", "test engine")? })
    }

    /// Draws a frame and offers it.
    fn frame(&mut self, size: [u32; 2]) -> TestResult {
        self.frames.run(size, &(), |frame, _| {
            let sky = frame.graph_mut().texture("sky", TextureDesc::new(Extent::FRAME, Format::Rgba16Float));
            let clear = Intent::Clear(ClearValue::BLACK);
            let sky = frame.add_fn("clear", |pass| pass.color(sky, clear), |_, _, _| Ok(()))?;
            frame.graph_mut().readback(sky)?;
            Ok::<_, DeclareError>(())
        })?;
        self.server.after_frame(&mut self.frames, &());
        Ok(())
    }

    /// Draws frames until a condition holds, at most a minute.
    fn until(&mut self, size: [u32; 2], mut holds: impl FnMut(&Server) -> bool) -> TestResult {
        let end = Instant::now() + Duration::from_secs(60);
        while !holds(&self.server) {
            if Instant::now() > end {
                return Err(format!("the condition does not hold: {:?}", self.server.counts()).into());
            }
            self.frame(size)?;
            std::thread::sleep(Duration::from_millis(1));
        }
        Ok(())
    }

    fn connect(&self) -> Result<Connection, RemoteError> {
        Connection::open(&self.server.address().to_string())
    }
}

fn texture(number: u32, text: &str) -> FromViewer {
    FromViewer::Texture(TextureRequest { number, text: text.into(), aspect: Aspect::All, sample: None })
}

#[test]
fn a_viewer_receives_plan_times_and_textures() -> TestResult {
    let mut engine = Engine::start()?;
    engine.frame([8, 4])?;
    assert_eq!(engine.server.counts().plans, 0, "without a viewer, nothing is copied");
    let viewer = engine.connect()?;
    assert_eq!(viewer.engine(), "test engine");
    viewer.send(&texture(1, "sky@clear"))?;
    let receive = std::thread::spawn(move || {
        let (mut plan, mut times, mut textures) = (None, None, Vec::new());
        while plan.is_none() || times.is_none() || textures.len() < 2 {
            match viewer.receive()? {
                FromEngine::Plan(message) => plan = Some(message),
                FromEngine::Times(message) => times = Some(message),
                FromEngine::Texture(message) => {
                    if textures.is_empty() {
                        viewer.send(&texture(2, "ground"))?;
                    }
                    textures.push(message);
                }
                FromEngine::Welcome { .. } | FromEngine::Refused { .. } => {}
            }
        }
        Ok::<_, RemoteError>((plan, times, textures))
    });
    engine.until([8, 4], |_| receive.is_finished())?;
    let (plan, times, textures) = receive.join().map_err(|_| "the viewer panicked")??;
    let (plan, times) = plan.zip(times).ok_or("no plan")?;
    let running = engine.frames.plan();
    assert_eq!((plan.compilation, times.compilation), (running.compilation(), running.compilation()));
    assert_eq!(plan.json, dump::json(running, "test engine"));
    assert!(plan.declared_at[0].contains("remote.rs"), "{:?}", plan.declared_at);
    assert_eq!(times.steps.len(), running.steps().len());

    // The viewer can compile the same plan, and others.
    let mut graph = framegraph::Graph::new();
    let file = GraphFile::parse("remote", &plan.graph)?;
    let (options, registry) = (Options { ..plan.options }, framegraph::file::Registry::<framegraph::Graph>::new());
    let mut again = Plan::new();
    file.plan(&[], &registry, &mut graph, (&plan.caps, &options), &mut Scratch::new(), &mut again)?;
    assert_eq!(dump::json(&again, "test engine"), plan.json);

    assert_eq!((textures[0].number, textures[0].size, &textures[0].title), (1, [8, 4], &Ok("sky@clear".into())));
    assert_eq!(textures[0].texels().map(|texels| texels.bits.len()), Some(32));
    assert!(matches!(&textures[1], RemoteTexture { number: 2, title: Err(error), .. } if error.contains("ground")));

    engine.until([8, 4], |server| server.counts().viewers == 0)?;
    let offered = engine.server.counts().times;
    std::thread::sleep(Duration::from_millis(120));
    engine.frame([8, 4])?;
    assert_eq!(engine.server.counts().times, offered, "nothing is offered after the viewer left");
    Ok(())
}

/// Frames of another world type replace the plan of the loop, but not its recorders.
#[test]
fn frames_of_other_worlds_are_not_offered() -> TestResult {
    let mut engine = Engine::start()?;
    let viewer = engine.connect()?;
    engine.until([4, 4], |server| server.counts().plans == 1)?;
    let offered = engine.server.counts();
    std::thread::sleep(Duration::from_millis(120));
    engine.frames.run_for([4, 4], &7u32, |frame, _| {
        let sky = frame.graph_mut().texture("other", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
        let clear = Intent::Clear(ClearValue::BLACK);
        let sky = frame.add_fn("other", |pass| pass.color(sky, clear), |_, _, _| Ok(()))?;
        frame.graph_mut().readback(sky)
    })?;
    engine.server.after_frame(&mut engine.frames, &());
    let counts = engine.server.counts();
    assert_eq!((counts.plans, counts.times, counts.viewers), (offered.plans, offered.times, 1));
    engine.until([4, 4], |server| server.counts().plans == 2)?;
    drop(viewer);
    Ok(())
}

/// Returns everything that the server answers to a peer before it closes the connection.
fn answer(engine: &Engine, bytes: &[u8], ends: bool) -> Result<String, std::io::Error> {
    let mut peer = TcpStream::connect(engine.server.address())?;
    peer.set_read_timeout(Some(Duration::from_secs(30)))?;
    // The server may close the connection before everything is written.
    let _ = peer.write_all(bytes);
    if ends {
        let _ = peer.shutdown(std::net::Shutdown::Write);
    }
    let mut answer = Vec::new();
    let _ = peer.read_to_end(&mut answer);
    Ok(String::from_utf8_lossy(&answer).into_owned())
}

#[test]
fn bad_peers_get_an_error_and_cost_nothing() -> TestResult {
    let mut engine = Engine::start()?;
    engine.frame([4, 4])?;
    let hello = |version: u32| [b"FGREMOTE".as_slice(), &version.to_le_bytes()].concat();
    let long = [hello(1), vec![0xff; 8]].concat();
    let garbage = [hello(1), 5u32.to_le_bytes().to_vec(), vec![0xee; 5]].concat();
    let half = [hello(1), 9u32.to_le_bytes().to_vec(), vec![0; 3]].concat();
    let cases: [(&[u8], bool, &str); 7] = [
        (b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n", false, "does not speak this protocol"),
        (&hello(2), false, "protocol version 2, expected 1"),
        (&long, false, "exceeds the limit of 4096 bytes"),
        (&garbage, false, "invalid message"),
        (&half, true, "a message is incomplete"),
        // These wait for `PATIENCE`.
        (&half, false, "no complete message within 5 s"),
        (b"FGREM", false, "no complete message within 5 s"),
    ];
    for (bytes, ends, expected) in cases {
        let answer = answer(&engine, bytes, ends)?;
        assert!(answer.starts_with("FGREMOTE") && answer.contains(expected), "{expected}: {answer}");
        engine.frame([4, 4])?;
    }
    engine.until([4, 4], |server| server.counts().viewers == 0)?;
    let counts = engine.server.counts();
    assert_eq!((counts.refused, counts.textures), (7, 0));

    // Random bytes after a valid beginning or without one.
    for case in 0..60u64 {
        let mut bytes = if case % 2 == 0 { hello(1) } else { Vec::new() };
        let mix = |index: u64| (index * index + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15 ^ case) >> 40;
        bytes.extend((0..case * 7).map(|index| mix(index) as u8));
        answer(&engine, &bytes, true)?;
        engine.frame([4, 4])?;
    }
    engine.until([4, 4], |server| server.counts().viewers == 0)?;
    assert_eq!(engine.server.counts().textures, 0);
    let viewer = engine.connect()?;
    engine.until([4, 4], |server| server.counts().viewers == 1)?;
    drop(viewer);
    Ok(())
}

#[test]
fn more_viewers_than_slots_are_refused() -> TestResult {
    let mut engine = Engine::start()?;
    let viewers = (0..4).map(|_| engine.connect()).collect::<Result<Vec<_>, _>>()?;
    engine.until([4, 4], |server| server.counts().viewers == 4)?;
    let refused = RemoteError::Refused { reason: "too many viewers are attached; close one".into() };
    assert_eq!(engine.connect().err(), Some(refused));
    drop(viewers);
    engine.until([4, 4], |server| server.counts().viewers == 0)?;
    engine.connect()?;
    Ok(())
}

#[test]
fn a_viewer_that_does_not_read_never_delays_a_frame() -> TestResult {
    let mut engine = Engine::start()?;
    let size = [1024, 1024];
    engine.frame(size)?;
    let stopped = engine.connect()?;
    stopped.send(&texture(1, "sky"))?;
    // 16 MiB do not fit into the buffers of the sockets, so that the sender blocks.
    engine.until(size, |server| server.counts().textures == 1)?;
    let (mut sent, mut since) = (engine.server.counts().sent, Instant::now());
    engine.until(size, |server| {
        let now = server.counts().sent;
        if std::mem::replace(&mut sent, now) != now {
            since = Instant::now();
        }
        since.elapsed() >= Duration::from_millis(200)
    })?;
    let begun = engine.server.counts();
    engine.until(size, |server| server.counts().times >= begun.times + 10)?;
    let counts = engine.server.counts();
    let replaced = counts.replaced - begun.replaced;
    assert!(counts.sent <= begun.sent + 2, "the sender is blocked: {counts:?}");
    assert!(replaced >= 7, "old samples are replaced, and never queued: {counts:?}");
    // Another viewer is served while the first one does not read.
    let reading = engine.connect()?;
    let received = std::thread::spawn(move || reading.receive());
    engine.until(size, |_| received.is_finished())?;
    assert!(matches!(received.join().map_err(|_| "the viewer panicked")?, Ok(FromEngine::Plan(_))));
    // The server ends although the sender is blocked.
    drop(engine);
    drop(stopped);
    Ok(())
}
