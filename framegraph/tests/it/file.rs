//! Graph files: what they declare, and equality with graphs declared in code.

mod errors;
mod hostile;
mod loops;
mod plugins;
mod reference;
mod roundtrip;

use crate::support::*;
use framegraph::file::*;
use framegraph::*;

fn load(text: &str) -> Graph {
    load_with(text, &[])
}

fn load_with(text: &str, on: &[&str]) -> Graph {
    let switches: Vec<_> = on.iter().map(|f| ((*f).to_owned(), true)).collect();
    match GraphFile::parse("t.ron", text).and_then(|f| f.graph(&switches)) {
        Ok(graph) => graph,
        Err(errors) => panic!("{errors}"),
    }
}

fn refused(text: &str) -> String {
    let outcome = GraphFile::parse("t.ron", text).and_then(|f| f.graph(&[]));
    outcome.expect_err("the file is valid").to_string()
}

/// Returns a file with the given resources, passes and exports.
fn file(resources: &str, passes: &str, exports: &str) -> String {
    format!("(version: 1,\nresources: [{resources}],\npasses: [{passes}],\nexports: [{exports}])")
}

/// Compares every array of two plans, except names and version numbers of the graphs.
fn assert_same_plan(a: &Plan, b: &Plan) {
    assert_eq!(dump::text(a), dump::text(b));
    assert_eq!(a.steps(), b.steps());
    assert_eq!(a.step_passes(), b.step_passes());
    assert_eq!(a.attachments(), b.attachments());
    assert_eq!(a.resources(), b.resources());
    assert_eq!(a.slots(), b.slots());
    assert_eq!(a.decisions(), b.decisions());
    assert_eq!(a.memory(), b.memory());
}

const FRAME_FILE: &str = r#"(
    version: 1,
    resources: [
        Texture(name: "screen", format: Rgba8UnormSrgb, kind: Import(entry: Undefined, exit: Keep)),
        Texture(name: "taa", format: Rgba16Float, kind: History(frames: 1)),
        Texture(name: "hdr", format: Rgba16Float),
        Texture(name: "hdr_ms", format: Rgba16Float, samples: 4),
        Texture(name: "depth", format: Depth32FloatStencil8, samples: 4),
        Texture(name: "pyramid", format: R32Float, size: Scale(num: 1, den: 2, align: 16), mips: 3),
        Buffer(name: "lights", bytes: 4096),
    ],
    passes: [
        Compute(name: "cull", accesses: [StorageWrite(to: "lights", intent: ClearZero)]),
        Raster(name: "scene", flags: [TakesEpilogue], accesses: [
            StorageRead(of: "lights"),
            Color(to: "hdr_ms", intent: ClearColor(0, 0, 0, 1)),
            Depth(to: "depth", intent: ClearDepth(0)),
            Resolve(to: "hdr"),
        ]),
        Raster(name: "down0", accesses: [
            Sampled(of: "hdr"),
            Color(to: "pyramid", mip: 0, intent: Overwrite),
        ]),
        Raster(name: "down1", accesses: [
            Sampled(of: "pyramid", mip: 0),
            Color(to: "pyramid", mip: 1, intent: Overwrite),
        ]),
        Raster(name: "taa", accesses: [
            Sampled(of: "hdr"),
            Sampled(of: "taa@-1"),
            Sampled(of: "pyramid", mip: 0, mips: 2),
            Color(to: "taa", intent: Overwrite),
        ]),
        Raster(name: "grade", flags: [Pointwise], accesses: [
            SamePixel(of: "taa"),
            Color(to: "screen", intent: Overwrite),
        ]),
    ],
    exports: [Readback(of: "lights")],
)"#;

/// Returns the graph of [`FRAME_FILE`], declared in code with resources before passes.
fn frame_in_code() -> Graph {
    let mut g = Graph::new();
    let screen = screen(&mut g);
    let taa = g.history("taa", hdr(), 1);
    let hdr_1 = g.texture("hdr", hdr());
    let hdr_ms = g.texture("hdr_ms", hdr().samples(4));
    let depth = color(Format::Depth32FloatStencil8).samples(4);
    let depth = g.texture("depth", depth);
    let half = Extent::Relative { num: 1, den: 2, align: 16 };
    let pyramid = TextureDesc::new(half, Format::R32Float).mips(3);
    let pyramid = g.texture("pyramid", pyramid);
    let lights = g.buffer("lights", 4096);
    let lights = g
        .add_fn("cull", |p| {
            let zero = Intent::Clear(ClearValue::Zero);
            p.write_buffer(lights, AccessKind::StorageWrite, zero)
        })
        .unwrap();
    let scene = g
        .add_fn("scene", |p| {
            p.takes_epilogue();
            p.read_buffer(lights, AccessKind::StorageRead)?;
            let ms = p.color(hdr_ms, BLACK)?;
            p.depth(depth, FAR)?;
            p.resolve(ms, hdr_1)
        })
        .unwrap();
    let pyramid = g
        .add_fn("down0", |p| {
            p.sampled(scene)?;
            p.color(pyramid.mip(0), Intent::Overwrite)
        })
        .unwrap();
    let pyramid = g
        .add_fn("down1", |p| {
            p.sampled(pyramid.mip(0))?;
            p.color(pyramid.mip(1), Intent::Overwrite)
        })
        .unwrap();
    let before = g.previous(taa, 1).unwrap();
    let taa = g
        .add_fn("taa", |p| {
            p.sampled(scene)?;
            p.sampled(before)?;
            let both = Range { mips: 2, ..Range::ALL };
            p.sampled(pyramid.range(both))?;
            p.color(taa, Intent::Overwrite)
        })
        .unwrap();
    g.add_fn("grade", |p| {
        p.pointwise();
        p.same_pixel(taa)?;
        p.color(screen, Intent::Overwrite)
    })
    .unwrap();
    g.readback_buffer(lights).unwrap();
    g
}

#[test]
fn the_file_and_the_code_declare_one_graph() {
    let (from_file, from_code) = (load(FRAME_FILE), frame_in_code());
    assert!(from_file.same_as(&from_code), "{}\n{}", to_ron(&from_file, "", FRAME), to_ron(&from_code, "", FRAME));
    for caps in [wgpu(), Caps::desktop(), Caps::tiler()] {
        assert_same_plan(&plan(&from_file, &caps), &plan(&from_code, &caps));
    }
}

#[test]
fn a_written_graph_reads_back() {
    let text = to_ron(&frame_in_code(), "frame", FRAME);
    let file = GraphFile::parse("t.ron", &text).unwrap();
    assert_eq!((file.name(), file.frame()), ("frame", Some(FRAME)));
    let again = load(&text);
    assert_eq!(to_ron(&again, "frame", FRAME), text);
    assert_same_plan(&plan(&again, &Caps::tiler()), &plan(&frame_in_code(), &Caps::tiler()));
    // After reading it again, version numbers are equal too, because resources are declared before passes.
    assert!(load(&to_ron(&again, "", FRAME)).same_as(&again));
}

#[test]
fn passes_may_stand_in_any_order() {
    // The passes of FRAME_FILE in reverse order, with explicit versions.
    let start = FRAME_FILE.find("passes: [").unwrap();
    let passes = r#"passes: [
        Raster(name: "grade", flags: [Pointwise], accesses: [
            SamePixel(of: "taa@taa"),
            Color(to: "screen", intent: Overwrite),
        ]),
        Raster(name: "taa", accesses: [
            Sampled(of: "hdr@scene"),
            Sampled(of: "taa@-1"),
            Sampled(of: "pyramid@down1", mip: 0, mips: 2),
            Color(to: "taa", intent: Overwrite),
        ]),
        Raster(name: "down1", accesses: [
            Sampled(of: "pyramid@down0", mip: 0),
            Color(to: "pyramid", mip: 1, intent: Overwrite),
        ]),
        Raster(name: "down0", accesses: [
            Sampled(of: "hdr@scene"),
            Color(to: "pyramid@entry", mip: 0, intent: Overwrite),
        ]),
        Raster(name: "scene", flags: [TakesEpilogue], accesses: [
            StorageRead(of: "lights@cull"),
            Color(to: "hdr_ms", intent: ClearColor(0, 0, 0, 1)),
            Depth(to: "depth", intent: ClearDepth(0)),
            Resolve(to: "hdr"),
        ]),
        Compute(name: "cull", accesses: [StorageWrite(to: "lights", intent: ClearZero)]),
    ], exports: [Readback(of: "lights")])"#;
    let text = format!("{}{passes}", &FRAME_FILE[..start]);
    assert!(load(&text).same_as(&frame_in_code()));
}

#[test]
fn readers_of_an_old_version_run_before_it_is_replaced() {
    // `early` is listed last and reads the output of `first`, before `second` modifies it.
    let text = file(
        r#"Texture(name: "a", format: R8Unorm), Texture(name: "b", format: R8Unorm)"#,
        r#"
        Raster(name: "first", accesses: [Color(to: "a", intent: Overwrite)]),
        Raster(name: "second", accesses: [Color(to: "a", intent: Modify)]),
        Raster(name: "early", accesses: [Sampled(of: "a@first"), Color(to: "b", intent: Overwrite)]),
        "#,
        r#"Keep(of: "a"), Keep(of: "b")"#,
    );
    let g = load(&text);
    let names: Vec<_> = g.pass_ids().map(|p| g.pass_name(p)).collect();
    assert_eq!(names, ["first", "early", "second"]);
}

#[test]
fn after_moves_a_pass() {
    let text = file(
        "",
        r#"
        Compute(name: "a", flags: [SideEffect], after: ["c"]),
        Compute(name: "b", flags: [SideEffect]),
        Compute(name: "c", flags: [SideEffect]),
        "#,
        "",
    );
    let g = load(&text);
    let names: Vec<_> = g.pass_ids().map(|p| g.pass_name(p)).collect();
    assert_eq!(names, ["b", "c", "a"]);
}

#[test]
fn features_switch_passes_resources_accesses_exports_and_numbers() {
    let text = r#"(version: 1, features: {"msaa": false, "fxaa": true},
        resources: [
            Texture(name: "screen", format: Rgba8Unorm, kind: Import(entry: Undefined, exit: Keep)),
            Texture(name: "depth", format: Depth32Float, samples: {"msaa": 4, "else": 1}),
            Texture(name: "ldr", id: "scene_target", format: Rgba8Unorm, when: "fxaa"),
            Texture(name: "ms", format: Rgba8Unorm, samples: 4, when: "msaa"),
        ],
        passes: [
            Raster(name: "scene", accesses: [
                Depth(to: "depth", intent: ClearDepth(0)),
                Color(to: "ms", intent: ClearZero, when: "msaa"),
                Resolve(to: "scene_target", when: "msaa && fxaa"),
                Resolve(to: "screen", when: "msaa && !fxaa"),
                Color(to: "scene_target", intent: ClearZero, when: "!msaa && fxaa"),
                Color(to: "screen", intent: ClearZero, when: "!msaa && !fxaa"),
            ]),
            Raster(name: "fxaa", when: "fxaa", accesses: [
                Sampled(of: "scene_target"),
                Color(to: "screen", intent: Overwrite),
            ]),
        ],
        exports: [Keep(of: "scene_target", when: "fxaa")],
    )"#;
    let file = GraphFile::parse("t.ron", text).unwrap();
    let mut sizes = Vec::new();
    for (msaa, fxaa) in [(false, true), (true, true), (true, false), (false, false)] {
        let switches = [("msaa".into(), msaa), ("fxaa".into(), fxaa)];
        let g = file.graph(&switches).unwrap();
        plan(&g, &wgpu());
        let samples = g.resources()[1].desc.texture().unwrap().samples;
        sizes.push((g.passes().len(), g.resources().len(), g.accesses().len(), samples));
    }
    assert_eq!(sizes, [(2, 3, 4, 1), (2, 4, 5, 4), (1, 3, 3, 4), (1, 2, 2, 1)]);
}

#[test]
fn an_export_is_of_the_last_version() {
    let passes = r#"
        Raster(name: "one", accesses: [Color(to: "a", intent: Overwrite)]),
        Raster(name: "two", accesses: [Color(to: "a", intent: Modify)])"#;
    let texture = r#"Texture(name: "a", format: R8Unorm)"#;
    let text = |of: &str| file(texture, passes, &format!("Keep(of: \"{of}\")"));
    load(&text("a@two"));
    load(&text("a"));
    assert!(refused(&text("a@one")).contains("pass `two` writes it later"));
    assert!(refused(&text("a@-1")).contains("cannot be exported"));
}

#[test]
fn expectations_are_read_by_whoever_knows_them() {
    #[derive(serde::Deserialize, Debug, PartialEq)]
    #[serde(deny_unknown_fields)]
    struct Expect {
        steps: u32,
    }
    let text = "(version: 1, expect: (\n  steps: 3))";
    let file = GraphFile::parse("t.ron", text).unwrap();
    assert_eq!(file.expect::<Expect>().unwrap(), Some(Expect { steps: 3 }));
    let text = "(version: 1, expect: (\n  step: 3))";
    let file = GraphFile::parse("t.ron", text).unwrap();
    assert_eq!(
        file.expect::<Expect>().unwrap_err().to_string(),
        "t.ron:2:3: `Expect` has no field `step`; did you mean `steps`?"
    );
    let none = GraphFile::parse("t.ron", "(version: 1)").unwrap();
    assert_eq!(none.expect::<Expect>().unwrap(), None);
}

#[test]
fn a_mark_in_front_of_utf_8_is_no_part_of_the_text() {
    let text = "\u{feff}(version: 1, name: \"marked\")";
    assert_eq!(GraphFile::parse("m.ron", text).map(|f| f.name().to_owned()), Ok("marked".into()));
    assert_eq!(caps("m.ron", "\u{feff}(version: 1, like: \"tiler\")"), Ok(Caps::tiler()));
    let message = GraphFile::parse("m.ron", "\u{feff}(version: 1, nam: 3)").expect_err("a slip").to_string();
    assert!(message.starts_with("m.ron:1:14: "), "columns as in an editor: {message}");
}
