//! A real window on a virtual display.

use crate::{case, folder};
use std::io::Read;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};
use test_report::display::Display;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{AtomEnum, ClientMessageEvent, ConfigureWindowAux, ConnectionExt, EventMask, Window};
use x11rb::rust_connection::RustConnection;

/// Returns the program with its display and state folder.
fn program(display: &Display, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_viewer"));
    command.args(args).env("DISPLAY", &display.name).env_remove("WAYLAND_DISPLAY");
    command.env("XDG_STATE_HOME", folder(&format!("state{}", args.len())));
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Returns whether a program with that many arguments kept the state of its window.
fn has_state(args: usize) -> bool {
    let state = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("viewer/state{args}"));
    assert!(state.is_dir(), "{}", state.display());
    state.join("framegraph-viewer/window.json").exists()
}

/// Reports a skip without a display or a device.
fn skipped(name: &str, message: &str) -> bool {
    let none = message.contains("window: cannot be opened") || message.contains("No suitable graphics adapter");
    if none {
        test_report::skip(name, message.trim());
    }
    none
}

#[test]
fn a_window_draws_sixty_frames() {
    let name = "a_window_draws_sixty_frames";
    let Some(display) = Display::open() else { return test_report::skip(name, "there is no Xvfb to open a window on") };
    let frame = case("filament");
    let output = program(&display, &[frame.to_str().expect("a name"), "--frames", "60"]).output();
    let Output { status, stdout, stderr } = output.expect("the program starts");
    let (out, message) = (String::from_utf8_lossy(&stdout), String::from_utf8_lossy(&stderr));
    if !skipped(name, &message) {
        let frames = out.split_once(" frames").and_then(|(count, _)| count.parse::<u32>().ok());
        assert!(status.code() == Some(0) && frames >= Some(60), "{status}: {out}{message}");
        assert!(!has_state(3), "a run of a fixed length keeps no state");
    }
}

/// Waits for the window of the program.
fn window(x: &RustConnection, root: Window) -> Option<Window> {
    let end = Instant::now() + Duration::from_secs(60);
    while Instant::now() < end {
        let children = x.query_tree(root).ok()?.reply().ok()?.children;
        for child in children {
            let name = x.get_property(false, child, AtomEnum::WM_NAME, AtomEnum::ANY, 0, 64).ok()?.reply();
            if name.is_ok_and(|name| name.value == b"viewer") {
                return Some(child);
            }
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    None
}

#[test]
fn a_window_is_resized_hidden_and_closed() {
    let name = "a_window_is_resized_hidden_and_closed";
    let Some(display) = Display::open() else { return test_report::skip(name, "there is no Xvfb to open a window on") };
    let frame = case("filament");
    let mut program = program(&display, &[frame.to_str().expect("a name")]).spawn().expect("the program starts");
    let (x, screen) = RustConnection::connect(Some(&display.name)).expect("a display");
    let root = x.setup().roots[screen].root;
    let Some(window) = window(&x, root) else {
        let _ = program.kill();
        let mut message = String::new();
        program.stderr.take().map(|mut err| err.read_to_string(&mut message));
        let _ = program.wait();
        assert!(skipped(name, &message), "no window: {message}");
        return;
    };
    let pause = || std::thread::sleep(Duration::from_millis(400));
    pause();
    for (width, height) in [(640, 360), (200, 120), (1200, 780)] {
        x.configure_window(window, &ConfigureWindowAux::new().width(width).height(height)).expect("a request");
        x.flush().expect("a request");
        pause();
    }
    // A window manager hides and shows the window.
    x.unmap_window(window).expect("a request");
    x.flush().expect("a request");
    pause();
    x.map_window(window).expect("a request");
    x.flush().expect("a request");
    pause();
    let atom = |name: &[u8]| x.intern_atom(false, name).expect("a request").reply().expect("an atom").atom;
    let (protocols, delete) = (atom(b"WM_PROTOCOLS"), atom(b"WM_DELETE_WINDOW"));
    let close = ClientMessageEvent::new(32, window, protocols, [delete, 0, 0, 0, 0]);
    x.send_event(false, window, EventMask::NO_EVENT, close).expect("a request");
    x.flush().expect("a request");
    let end = Instant::now() + Duration::from_secs(60);
    let status = loop {
        match program.try_wait().expect("a program") {
            Some(status) => break Some(status),
            None if Instant::now() > end => break None,
            None => std::thread::sleep(Duration::from_millis(50)),
        }
    };
    if status.is_none() {
        let _ = program.kill();
    }
    let mut message = String::new();
    program.stderr.take().map(|mut err| err.read_to_string(&mut message));
    assert_eq!(status.and_then(|status| status.code()), Some(0), "{message}");
    assert!(has_state(1));
    assert!(!message.contains("panicked"), "{message}");
}

#[test]
fn a_live_frame_is_drawn_in_a_window() {
    let name = "a_live_frame_is_drawn_in_a_window";
    let Some(display) = Display::open() else { return test_report::skip(name, "there is no Xvfb to open a window on") };
    let args = ["--live", "spheres", "--settings", "low", "--frames", "24"];
    let program = program(&display, &args).spawn().expect("the program starts");
    let (x, screen) = RustConnection::connect(Some(&display.name)).expect("a display");
    let root = x.setup().roots[screen].root;
    // Resized while drawing.
    if let Some(window) = window(&x, root) {
        std::thread::sleep(Duration::from_millis(400));
        let _ = x.configure_window(window, &ConfigureWindowAux::new().width(700).height(420));
        let _ = x.flush();
    }
    let Output { status, stdout, stderr } = program.wait_with_output().expect("a program");
    let (out, message) = (String::from_utf8_lossy(&stdout), String::from_utf8_lossy(&stderr));
    if !skipped(name, &message) {
        let frames = out.split_once(" frames").and_then(|(count, _)| count.parse::<u32>().ok());
        assert!(status.code() == Some(0) && frames >= Some(24), "{status}: {out}{message}");
        let mut words = out.split_whitespace().rev().skip_while(|word| *word != "of").skip(1);
        let drawn = words.next().and_then(|word| word.parse::<u32>().ok());
        assert!(drawn >= Some(20), "the scene is drawn in each of them: {out}{message}");
        assert!(!message.contains("device: ") && !message.contains("panicked"), "{message}");
    }
}
