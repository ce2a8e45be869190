//! A graph that the device would refuse is an error of the compiler, with pass, resource, value, limit and advice.

use framegraph::file::{GraphFile, Registry};
use framegraph::*;
use framegraph_check::check;

/// Compiles a file for WebGPU's baseline.
fn planned(resources: &str, passes: &str) -> Result<Plan, String> {
    let text = format!(
        "(version: 1, frame: (64, 64), resources: [Texture(name: \"screen\", format: Rgba8Unorm, kind: Import(entry: \
         Undefined, exit: Keep)), {resources}], passes: [{passes}])"
    );
    let (mut graph, mut plan, options) = (Graph::new(), Plan::new(), Options::for_frame(64, 64));
    let file = GraphFile::parse("t.ron", &text).map_err(|e| e.to_string())?;
    let device = (&Caps::wgpu(), &options);
    file.plan(&[], &Registry::new(), &mut graph, device, &mut Scratch::new(), &mut plan).map_err(|e| e.to_string())?;
    Ok(plan)
}

#[test]
fn every_refusal_names_value_limit_and_advice() {
    let show = r#"Raster(name: "use", accesses: [Sampled(of: "t"), Color(to: "screen", intent: Overwrite)])"#;
    let drawn = format!(r#"Raster(name: "c", accesses: [Color(to: "t", intent: ClearColor(0,0,0,1))]), {show}"#);
    let stored = format!(r#"Compute(name: "c", accesses: [StorageWrite(to: "t", intent: Overwrite)]), {show}"#);
    let bytes = |access: &str| {
        format!(
            r#"Compute(name: "c", accesses: [StorageWrite(to: "b", intent: Overwrite)]),
               Compute(name: "use", flags: [SideEffect], accesses: [{access}])"#
        )
    };
    let cases = [
        (
            r#"Texture(name: "t", format: Rgba8Unorm, samples: 4, layers: 2)"#,
            drawn.clone(),
            "4 samples with 2 layers",
            "use a texture for each layer",
        ),
        (
            r#"Texture(name: "t", format: Rgba8Unorm, samples: 2)"#,
            drawn.clone(),
            "2 samples of Rgba8Unorm, the device allows 1 or 4",
            "use 1 or 4",
        ),
        (
            r#"Texture(name: "t", format: Rgba8Unorm, samples: 8)"#,
            drawn.clone(),
            "8 samples of Rgba8Unorm, the device allows 1 or 4",
            "use 1 or 4",
        ),
        (
            r#"Texture(name: "t", format: Rgba8Unorm, mips: 9)"#,
            drawn,
            "9 levels, but 64x64 texels have at most 7",
            "use fewer levels, or `TextureDesc::ALL_MIPS` for all (in a file `mips: \"all\"`)",
        ),
        (
            r#"Texture(name: "t", format: R16Float)"#,
            stored.clone(),
            "does not support R16Float as `storage_write`",
            "use R32Float",
        ),
        (
            r#"Texture(name: "t", format: Bgra8Unorm)"#,
            stored.clone(),
            "does not support Bgra8Unorm as `storage_write`",
            "use Rgba8Unorm",
        ),
        (
            r#"Texture(name: "t", format: Rgba8Unorm, samples: 4)"#,
            stored,
            "4 samples are used as `storage_write`",
            "resolve it first",
        ),
        (
            r#"Buffer(name: "b", bytes: 1048576)"#,
            bytes(r#"Uniform(of: "b")"#),
            "1048576 bytes are bound as `uniform`, the device allows 65536",
            "declare a range",
        ),
        (
            r#"Buffer(name: "b", bytes: 1024)"#,
            bytes(r#"Uniform(of: "b", bytes: (4, 64))"#),
            "bytes from offset 4 are used as `uniform`, the device requires a multiple of 256",
            "start the range at 0 or 256",
        ),
        (
            r#"Buffer(name: "b", bytes: 7)"#,
            bytes(r#"StorageRead(of: "b")"#),
            "7 bytes are used as `storage_write`, the device requires a multiple of 4",
            "use 8 bytes",
        ),
    ];
    for (resources, passes, wrong, advice) in cases {
        let found = planned(resources, &passes).map(|_| ()).expect_err(wrong);
        assert!(found.contains(wrong) && found.contains(advice) && found.contains("resource `"), "{found}");
        // A sample count is no size.
        assert!(!found.contains("make it smaller") && !found.contains("too large"), "{found}");
    }
}

#[test]
fn one_plane_is_not_drawn_while_the_other_is_sampled() {
    let ds = r#"Texture(name: "ds", format: Depth24PlusStencil8)"#;
    let clear = r#"Raster(name: "scene", accesses: [Depth(to: "ds", intent: ClearDepthStencil(0, 0))]),"#;
    let decal = |depth: &str| {
        format!(
            r#"{clear} Raster(name: "decal", accesses: [{depth}, Sampled(of: "ds", aspect: Depth),
               Color(to: "screen", intent: ClearColor(0,0,0,1))])"#
        )
    };
    let written = planned(ds, &decal(r#"Depth(to: "ds", aspect: Stencil, intent: Modify)"#)).map(|_| ());
    let written = written.expect_err("the stencil plane is written");
    assert!(written.contains("pass `decal`: resource `ds`: one plane is used as `sampled`"), "{written}");
    assert!(planned(ds, &decal(r#"DepthReadOnly(of: "ds")"#)).is_ok());
}

#[test]
fn an_attachment_viewed_in_another_format_is_not_memoryless() {
    let passes = r#"Raster(name: "c", accesses: [Color(to: "t", intent: ClearColor(0,0,0,1), view: Rgba8UnormSrgb),
        Color(to: "screen", intent: Overwrite)])"#;
    let plan = planned(r#"Texture(name: "t", format: Rgba8Unorm)"#, passes).unwrap();
    let t = plan.graph().resource_ids().nth(1).unwrap();
    assert_ne!(plan.resources()[t.index()].placement, Placement::Memoryless);
    let needs = plan.reasons(Subject::Resource(t)).any(|r| r == Reason::NeedsMemory(MemoryNeed::View));
    assert!(needs, "{}", dump::text(&plan));
    let tiler = Caps { memoryless_views: true, ..Caps::wgpu() };
    let mut other = Plan::new();
    compile(plan.graph(), &tiler, plan.options(), &mut Scratch::new(), &mut other).unwrap();
    assert_eq!(other.resources()[t.index()].placement, Placement::Memoryless);
}

#[test]
fn a_slice_keeps_the_others() {
    let mut g = Graph::new();
    let desc = TextureDesc::new(Extent::absolute(8, 8), Format::Rgba8Unorm).layers(4);
    let volume = g.texture("volume", TextureDesc { dimension: Dimension::D3, ..desc });
    let first = g.add_fn("first", |p| p.color(volume.layer(0), Intent::Clear(ClearValue::BLACK))).unwrap();
    let last = g.add_fn("last", |p| p.color(first.layer(3), Intent::Overwrite)).unwrap();
    g.export(last).unwrap();
    let mut plan = Plan::new();
    compile(&g, &Caps::wgpu(), &Options::for_frame(8, 8), &mut Scratch::new(), &mut plan).unwrap();
    let found: Vec<_> = plan.attachments().iter().map(|a| (a.layer, a.load, a.store)).collect();
    assert_eq!(found, [(0, LoadOp::Clear, StoreOp::Store), (3, LoadOp::DontCare, StoreOp::Store)]);
    let report = check::examine(&plan);
    assert!(report.is_clean(), "{report}");
}

#[test]
fn bindings_are_counted() {
    let textures: String = (0..33).map(|n| format!("Texture(name: \"t{n}\", format: Rgba8Unorm),")).collect();
    let draws: String = (0..33)
        .map(|n| format!("Raster(name: \"c{n}\", accesses: [Color(to: \"t{n}\", intent: Overwrite)]),"))
        .collect();
    let look = |count: usize| {
        let reads: String = (0..count).map(|n| format!("Sampled(of: \"t{n}\"),")).collect();
        format!("{draws} Raster(name: \"use\", accesses: [{reads} Color(to: \"screen\", intent: Overwrite)])")
    };
    // A raster pass reads in two stages, a compute pass in one.
    assert!(planned(&textures, &look(32)).is_ok());
    let compute = |count: usize| look(count).replace("Raster(name: \"use\"", "Compute(name: \"use\"");
    let compute = |count| compute(count).replace("Color(to: \"screen\"", "StorageWrite(to: \"screen\"");
    for (passes, count, max) in [(look(33), 33, 32), (compute(17), 17, 16)] {
        let found = planned(&textures, &passes).map(|_| ()).expect_err("these are too many");
        let expected = format!("the pass uses {count} sampled textures, the device allows {max} in its shader stages");
        assert!(found.contains(&expected), "{found}");
    }
}

/// An epilogue is part of its producer's shader, so both share the bindings of a stage.
#[test]
fn an_epilogue_counts_among_the_bindings_of_its_producer() {
    let inlined = |count: usize| {
        let mut g = Graph::new();
        let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
        let mut draw = |name: String| {
            let texture = g.texture(&name, desc);
            g.add_fn(&name, |p| p.color(texture, Intent::Overwrite)).unwrap()
        };
        let read: Vec<Texture> = (0..count).map(|n| draw(format!("t{n}"))).collect();
        let look = draw("look".into());
        let (hdr, screen) = (g.texture("hdr", desc), g.texture("screen", desc));
        let hdr = g
            .add_fn("scene", |p| {
                p.takes_epilogue();
                read.iter().try_for_each(|texture| p.sampled(*texture).map(drop))?;
                p.color(hdr, Intent::Overwrite)
            })
            .unwrap();
        let screen = g
            .add_fn("grade", |p| {
                p.pointwise();
                p.same_pixel(hdr)?;
                p.sampled(look)?;
                p.color(screen, Intent::Overwrite)
            })
            .unwrap();
        g.export(screen).unwrap();
        let mut plan = Plan::new();
        compile(&g, &Caps::wgpu(), &Options::for_frame(8, 8), &mut Scratch::new(), &mut plan).unwrap();
        let report = check::examine(&plan);
        assert!(report.is_clean(), "{report}");
        let refused =
            plan.decisions().iter().any(|d| matches!(d.reason, Reason::NotInlined(_, Refusal::TooManyBindings)));
        (plan.counts().inlined, refused)
    };
    assert_eq!((inlined(15), inlined(16)), ((1, false), (0, true)));
}

/// The limit holds for the shader of every producer, and textures between epilogues are no bindings.
#[test]
fn every_producer_of_a_chain_of_epilogues_is_counted() {
    let inlined = |opaque: usize, sky: usize| {
        let mut g = Graph::new();
        let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
        let mut draw = |name: String| {
            let texture = g.texture(&name, desc);
            g.add_fn(&name, |p| p.color(texture, Intent::Overwrite)).unwrap()
        };
        let read: Vec<Texture> = (0..opaque.max(sky)).map(|n| draw(format!("t{n}"))).collect();
        let [mut before, ldr, screen] = ["hdr", "ldr", "screen"].map(|name| g.texture(name, desc));
        for (name, count, intent) in [("opaque", opaque, Intent::Overwrite), ("sky", sky, Intent::Modify)] {
            let draw = |p: &mut PassBuilder<'_>| {
                p.takes_epilogue();
                read[..count].iter().try_for_each(|texture| p.sampled(*texture).map(drop))?;
                p.color(before, intent)
            };
            before = g.add_fn(name, draw).unwrap();
        }
        for (name, target) in [("grade", ldr), ("vignette", screen)] {
            let epilogue = |p: &mut PassBuilder<'_>| {
                p.pointwise();
                p.takes_epilogue();
                p.same_pixel(before)?;
                p.color(target, Intent::Overwrite)
            };
            before = g.add_fn(name, epilogue).unwrap();
        }
        g.export(before).unwrap();
        let mut plan = Plan::new();
        compile(&g, &Caps::wgpu(), &Options::for_frame(8, 8), &mut Scratch::new(), &mut plan).unwrap();
        let report = check::examine(&plan);
        assert!(report.is_clean(), "{report}");
        plan.counts().inlined
    };
    let limit = Caps::wgpu().max_sampled_textures as usize;
    assert_eq!((inlined(limit, 0), inlined(0, limit), inlined(limit, limit)), (2, 2, 2));
}

/// A device without storage in raster passes refuses it for textures as for buffers.
#[test]
fn storage_in_a_raster_pass_needs_the_device() {
    let texture = r#"Texture(name: "s", format: R32Float)"#;
    let buffer = r#"Buffer(name: "s", bytes: 64)"#;
    let pass = r#"Raster(name: "c", accesses: [StorageWrite(to: "s", intent: Overwrite), Color(to: "screen", intent: Overwrite)])"#;
    for resource in [texture, buffer] {
        let plan = planned(resource, pass).unwrap();
        let caps = Caps { raster_storage: false, ..Caps::wgpu() };
        let told = compile(plan.graph(), &caps, plan.options(), &mut Scratch::new(), &mut Plan::new());
        let told = told.expect_err("the device has no storage in raster passes").to_string();
        assert!(told.contains("pass `c`") && told.contains("resource `s`"), "{told}");
    }
}

/// A color attachment in slot 7 needs eight slots, alone as among others.
#[test]
fn unused_slots_count_for_a_single_attachment() {
    let mut g = Graph::new();
    let texture = g.texture("t", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
    let drawn = g.add_fn("draw", |p| p.color_at(7, texture, Intent::Overwrite)).unwrap();
    g.export(drawn).unwrap();
    let options = Options::for_frame(8, 8);
    let told = |max_color_attachments| {
        let caps = Caps { max_color_attachments, ..Caps::wgpu() };
        compile(&g, &caps, &options, &mut Scratch::new(), &mut Plan::new()).map_err(|errors| errors.to_string())
    };
    assert_eq!(told(8), Ok(()));
    assert!(told(4).is_err_and(|told| told.contains("8 color attachments")), "{:?}", told(4));
}
