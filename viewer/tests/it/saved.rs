//! Saved plans and invalid files.

use crate::{case, folder, planned, session};
use framegraph::Caps;
use std::fs::{self, File};
use std::path::PathBuf;
use std::time::{Duration, Instant};
use viewer::app::{Role, Session};
use viewer::job::Handle;
use viewer::open::{Opened, open};
use viewer::plan_data::read;
use viewer::what_if::WhatIf;

/// Returns a saved plan.
fn text() -> String {
    let file = fs::read_to_string(case("filament")).expect("the case is there");
    let file = framegraph::file::GraphFile::parse("filament.ron", &file).expect("the case is sound");
    let graph = file.graph(&[("sao".into(), true)]).expect("the case is sound");
    let mut plan = framegraph::Plan::new();
    let options = framegraph::Options::default();
    framegraph::compile(&graph, &Caps::tiler(), &options, &mut framegraph::Scratch::new(), &mut plan).expect("a plan");
    framegraph::dump::json(&plan, file.name())
}

#[test]
fn a_saved_plan_is_the_live_one() {
    let saved = read(text().as_bytes()).expect("the text is whole");
    assert_eq!((saved.form.name.as_str(), saved.form.caps.as_str()), ("Filament's frame", "tiler"));
    assert!(saved.notes.is_empty(), "{:?}", saved.notes);
    let live = planned("filament", &Caps::tiler(), &["sao"]);
    assert_eq!(saved.form.passes, live.form.passes);
    assert_eq!(saved.form.flows, live.form.flows);
    let level = &live.form.passes[live.pass("structure/2").expect("a pass")];
    let parts: Vec<_> = level.accesses.iter().map(|access| access.part.as_deref()).collect();
    assert_eq!(parts, [Some("mip 1"), Some("mip 2")]);
    // Only source files provide locations of passes.
    let at = &live.declared_at[live.pass("structure/2").expect("a pass")];
    assert!(at.contains("filament.ron:") && saved.declared_at.is_empty(), "{at}");
}

#[test]
fn invalid_plans_are_reported_in_a_sentence() {
    let good = text();
    let cases: [(String, &str); 10] = [
        (good.replace("\"version\": 1,", "\"version\": 7,"), "version 7, expected 1"),
        // Another version with other fields.
        (good.replace("\"version\": 1,", "\"version\": 7,").replace("\"frame\":", "\"size\":"), "version 7"),
        (good.replace("framegraph-plan", "framegraph-diff"), "`framegraph-diff`, expected `framegraph-plan`"),
        (good[..good.len() / 2].to_owned(), "truncated"),
        (String::new(), "truncated"),
        ("{}".into(), "`schema` is missing"),
        ("[1, 2]".into(), "`schema` is missing"),
        (good.replace("\"steps\": [", "\"steps\": [,"), "invalid JSON"),
        (good.replace("\"caps\": \"tiler\"", "\"caps\": 3"), "expected a string"),
        (good.replacen("\"step\": 0", "\"step\": 99", 1), "step 99 does not exist"),
    ];
    for (text, named) in cases {
        let error = read(text.as_bytes()).expect_err(named).to_string();
        assert!(error.contains(named) && !error.contains('\n'), "{named}: {error}");
    }
}

#[test]
fn unknown_fields_are_listed_and_ignored() {
    let text = text().replace("\"kind\": \"raster\",", "\"kind\": \"raster\", \"queue\": 3,");
    let plan = read(text.as_bytes()).expect("more fields do no harm");
    assert_eq!(plan.notes.len(), 1);
    assert!(plan.notes[0].contains("passes.*.queue") && plan.notes[0].contains("steps.*.queue"), "{:?}", plan.notes);
    let noted =
        text.replace("\"notes\": []", "\"notes\": [{\"about\": \"ao\", \"sentence\": \"nothing stands near\"}]");
    let plan = read(noted.as_bytes()).expect("notes are read");
    let words = viewer::view::inspector::text(&viewer::view::inspector::sections(&plan, None));
    assert!(words.contains("effects\n  ao: nothing stands near"), "{words}");
    let older = text.replace("\"flows\"", "\"flow\"");
    let plan = read(older.as_bytes()).expect("an older file is read");
    assert!(plan.notes.iter().any(|note| note.contains("no edges")), "{:?}", plan.notes);
}

/// Every view draws plans with duplicate names, wrong order or dangling references.
#[test]
fn a_plan_changed_by_hand_is_drawn_without_a_panic() {
    let texts = [
        text().replace("\"structure\"", "\"no such thing\""),
        text().replace("\"name\": \"ao/blur_h\"", "\"name\": \"ao\""),
        text().replace("\"first_step\": 0", "\"first_step\": 7"),
        text().replace("\"culled\": false", "\"culled\": true"),
        text().replace("\"offset\": 0", "\"offset\": 18446744073709551615"),
        text().replace("\"bytes\": ", "\"bytes\": 1844674407370955161"),
        text().replace("\"held_steps\": [\n        0,", "\"held_steps\": [\n        9,"),
    ];
    for text in texts {
        let Ok(plan) = read(text.as_bytes()) else { continue };
        for view in viewer::view::View::ALL {
            let context = viewer::view::ViewContext { against: Some(&plan), ..Default::default() };
            let drawing = viewer::view::drawing(view, &plan, context, 80);
            assert!(drawing.size.iter().all(|side| side.is_finite() && *side > 0.0), "{view:?}: {:?}", drawing.size);
        }
    }
}

fn written(name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder("saved").with_file_name(name);
    fs::write(&path, bytes).expect("a file");
    path
}

#[test]
fn files_of_other_kinds_are_reported_by_name() {
    let none = folder("nothing").join("none.json");
    let cases = [
        (none.clone(), "cannot be read"),
        (none.parent().expect("a folder").to_owned(), "is a folder"),
        (written("empty.json", b" \n"), "empty file"),
        (written("picture.json", b"\x89PNG"), "unknown file type"),
        (written("trace.json", b"{\"traceEvents\": []}"), "no frames of this library"),
        (written("bad.ron", b"(version: 1, passes: [Raster(name: \"a\")], oops"), "bad.ron"),
        (written("binary.ron", b"(version: 1,\n\xff"), "binary.ron:2:1: the line is not UTF-8"),
    ];
    for (path, named) in cases {
        let error = open(&path, &Handle::default()).expect_err(named);
        let name = path.file_name().expect("a name").to_string_lossy();
        assert!(error.contains(named) && error.contains(&*name), "{named}: {error}");
    }
    assert!(matches!(open(&written("plan.json", text().as_bytes()), &Handle::default()), Ok(Opened::Plan(_))));
}

/// A truncated file of a hundred megabytes is read in the background and then reported.
#[test]
fn a_large_file_is_read_elsewhere_and_can_be_given_up() {
    let path = folder("large").join("large.json");
    let mut start = text();
    start.truncate(start.len() - 3);
    fs::write(&path, start).expect("a file");
    File::options().write(true).open(&path).and_then(|file| file.set_len(100 << 20)).expect("a longer file");
    let mut waiting = session(&case("diamond"));
    let before = waiting.plan.clone().expect("a plan");
    let asked = Instant::now();
    waiting.open(&path, Role::Shown);
    waiting.poll();
    // Only the absence of blocking is asserted, not a time.
    let doing = waiting.doing().map(str::to_owned);
    assert!(doing.is_some_and(|doing| doing.contains("large.json")), "it was read while the panel waited");
    assert!(waiting.settle(Duration::from_secs(120)), "{:?}", asked.elapsed());
    assert!(
        waiting.messages[0].contains("large.json") && waiting.messages[0].contains("line"),
        "{:?}",
        waiting.messages
    );
    assert!(std::sync::Arc::ptr_eq(&before, waiting.plan.as_ref().expect("the plan before is kept")));

    let mut cancelled = Session::new(WhatIf::on(Caps::tiler()), || {});
    cancelled.open(&path, Role::Shown);
    cancelled.cancel();
    assert!(cancelled.settle(Duration::from_secs(1)) && cancelled.messages.is_empty());
    fs::remove_file(&path).expect("the file goes");
}

#[test]
fn a_file_that_changes_is_planned_anew_and_a_bad_one_keeps_the_plan() {
    let path = folder("watched").join("frame.ron");
    let good = fs::read_to_string(case("diamond")).expect("the case");
    fs::write(&path, &good).expect("a file");
    let mut session = session(&path);
    let passes = |session: &Session| session.plan.as_ref().map(|plan| plan.form.passes.len());
    let before = passes(&session).expect("a plan");
    let until = |session: &mut Session, done: &dyn Fn(&Session) -> bool| {
        let end = Instant::now() + Duration::from_secs(30);
        while !done(session) && Instant::now() < end {
            session.poll();
            std::thread::sleep(Duration::from_millis(20));
        }
        assert!(done(session), "nothing happened: {:?}", session.messages);
    };
    fs::write(&path, good.replacen("version: 1", "version: 1, oops: 2", 1)).expect("a file");
    until(&mut session, &|session| !session.messages.is_empty());
    assert!(session.messages[0].contains("oops"), "{:?}", session.messages);
    assert_eq!(passes(&session), Some(before), "the plan before is kept");
    let first = session.generation();
    fs::write(&path, format!("{good}\n")).expect("a file");
    until(&mut session, &|session| session.generation() > first && session.doing().is_none());
    assert_eq!(passes(&session), Some(before));
}
