//! Tests of a live frame that another thread works on.

use super::*;
use crate::what_if::WhatIf;
use framegraph::Caps;
use framegraph_passes::{FrameSettings, Preset};
use framegraph_wgpu::{AdapterRequest, Gpu};

/// Timeout of work on another thread.
const PATIENCE: Duration = Duration::from_secs(300);

/// Returns a loaded scene with its session; `None` without a device.
fn loaded(test: &str, wake: impl Fn() + Send + Sync + 'static) -> Option<(Live, Session)> {
    let gpu = match Gpu::open(&AdapterRequest::from_env()) {
        Ok(gpu) => gpu,
        Err(error) => {
            test_report::skip(test, &error.to_string());
            return None;
        }
    };
    let mut session = Session::new(WhatIf::on(Caps::wgpu()), || {});
    let frame = FrameSettings { lod_error_px: 0.0, ..Preset::Low.frame() };
    let document = Document { frame, ..Document::default() };
    let mut live = Live::new(Screen::new(&gpu, None), document, "columns", None, wake);
    assert!(live.settle(&mut session, PATIENCE) && live.running.is_some(), "{:?}", session.messages);
    Some((live, session))
}

#[test]
fn a_panic_while_drawing_is_reported_and_the_scene_can_be_loaded_again() {
    let name = "a_panic_while_drawing_is_reported_and_the_scene_can_be_loaded_again";
    let Some((mut live, mut session)) = loaded(name, || {}) else { return };
    live.work("drawing", &mut session, |_, _| panic!("expected by the test"));
    assert!(live.settle(&mut session, PATIENCE), "the work ends");
    let expected = "internal error: drawing ended without a result; load the scene again";
    assert_eq!(session.messages, [expected]);
    assert!(live.running.is_none() && !live.wants_frame());
    live.load("columns");
    assert!(live.settle(&mut session, PATIENCE) && live.wants_frame());
}
