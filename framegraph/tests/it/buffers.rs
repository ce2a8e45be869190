//! Buffers: a method for each access, separately tracked byte ranges, and sizes relative to the frame.

use crate::support::*;
use framegraph::*;
use framegraph_check::check;

const ZERO: Intent = Intent::Clear(ClearValue::Zero);

fn checked(graph: &Graph, caps: &Caps) -> Plan {
    let plan = plan(graph, caps);
    assert_eq!(check(&plan), Ok(()));
    plan
}

#[test]
fn every_access_of_a_buffer_has_its_method() {
    let mut g = Graph::new();
    let b = g.buffer("b", 1024);
    let b = g.add_fn("copy in", |p| p.copy_target_buffer(b, ZERO)).unwrap();
    let b = g.add_fn("write", |p| p.storage_write_buffer(b, Intent::Modify)).unwrap();
    g.add_fn("use", |p| {
        p.side_effect();
        p.uniform(b)?;
        p.vertex(b)?;
        p.index(b)?;
        p.indirect(b)?;
        p.storage_read_buffer(b)
    })
    .unwrap();
    g.add_fn("copy out", |p| {
        p.side_effect();
        p.copy_source_buffer(b)
    })
    .unwrap();
    use AccessKind::*;
    let kinds: Vec<_> = g.accesses().iter().map(|a| a.kind).collect();
    assert_eq!(kinds, [CopyTarget, StorageWrite, Uniform, Vertex, Index, Indirect, StorageRead, CopySource]);
    checked(&g, &wgpu());
}

/// Arguments and a counter in one buffer: two passes write one each, a third reads the arguments.
fn arguments(counter: Option<(u64, u64)>) -> Graph {
    let mut g = Graph::new();
    let b = g.buffer("args", 512);
    let b = g.add_fn("args", |p| p.storage_write_buffer(b.bytes(0, 20), Intent::Overwrite)).unwrap();
    let (offset, bytes) = counter.unwrap_or((256, 4));
    let b = g.add_fn("count", |p| p.storage_write_buffer(b.bytes(offset, bytes), ZERO)).unwrap();
    g.add_fn("draw", |p| {
        p.side_effect();
        p.indirect(b.bytes(0, 20))
    })
    .unwrap();
    g
}

#[test]
fn writing_some_bytes_leaves_the_others() {
    // The counter is a separate range: it is not used, and the arguments are still valid.
    let g = arguments(None);
    let plan = checked(&g, &wgpu());
    let kept: Vec<_> = g.pass_ids().map(|p| !plan.is_culled(p)).collect();
    assert_eq!(kept, [true, false, true]);
    // With overlapping ranges, both passes contribute to the arguments.
    let g = arguments(Some((16, 4)));
    assert_eq!(checked(&g, &wgpu()).counts().culled, 0);
    // A range that covers the arguments replaces them.
    let g = arguments(Some((0, 256)));
    let plan = checked(&g, &Caps::desktop());
    let kept: Vec<_> = g.pass_ids().map(|p| !plan.is_culled(p)).collect();
    assert_eq!(kept, [false, true, true]);
    assert!(dump::text(&plan).contains("read indirect args bytes 0..20"));
}

#[test]
fn bytes_that_nobody_wrote_are_not_there() {
    let mut g = Graph::new();
    let b = g.buffer("b", 64);
    let b = g.add_fn("half", |p| p.storage_write_buffer(b.bytes(0, 32), ZERO)).unwrap();
    let read = |p: &mut PassBuilder<'_>, part: BufferPart| {
        p.side_effect();
        p.uniform(part).map(drop)
    };
    g.add_fn("within", |p| read(p, b.bytes(4, 28))).unwrap();
    assert_eq!(check(&plan(&g, &wgpu())), Ok(()));
    g.add_fn("all", |p| read(p, b.into())).unwrap();
    g.add_fn("beyond", |p| read(p, b.bytes(28, 8))).unwrap();
    let found: Vec<_> = errors(&g).into_iter().map(|e| e.pass.map(|p| p.name).unwrap_or_default()).collect();
    assert_eq!(found, ["all", "beyond"]);
}

#[test]
fn bytes_are_checked_where_they_are_named() {
    let mut g = Graph::new();
    let b = g.buffer("b", 64);
    let mut asked = |part: BufferPart| g.add_fn("p", |p| p.storage_write_buffer(part, ZERO)).map(drop);
    for (offset, bytes) in [(0, 65), (64, 1), (60, 8), (u64::MAX, 2), (1, u64::MAX), (0, 0)] {
        let refused = asked(b.bytes(offset, bytes)).unwrap_err();
        assert_eq!(refused.reason, DeclareReason::NoSuchBytes { offset, bytes, size: Some(64) });
    }
    assert!(g.byte_ranges().is_empty(), "a rejected access left its byte range behind");
    // The whole buffer is not stored as a range.
    g.add_fn("p", |p| p.storage_write_buffer(b.bytes(0, 64), ZERO)).unwrap();
    assert!(g.byte_ranges().is_empty() && g.accesses()[0].range == Range::ALL);
}

#[test]
fn a_refused_pass_takes_its_bytes_back() {
    let mut g = Graph::new();
    let b = g.buffer("b", 64);
    let other = g.add_fn("good", |p| p.storage_write_buffer(b.bytes(0, 8), ZERO)).unwrap();
    let refused = g.add_fn("bad", |p| {
        let b = p.storage_write_buffer(other.bytes(8, 8), ZERO)?;
        p.storage_write_buffer(b.bytes(12, 8), ZERO)
    });
    let reason = refused.unwrap_err().reason;
    let kind = AccessKind::StorageWrite;
    assert_eq!(reason, DeclareReason::Conflict { earlier: kind, later: kind, buffer: true });
    assert_eq!(g.byte_ranges().len(), 1);
}

#[test]
fn a_pass_has_all_of_a_buffer_in_one_use() {
    let mut g = Graph::new();
    let b = g.buffer("b", 1024);
    let b = g.add_fn("fill", |p| p.storage_write_buffer(b, ZERO)).unwrap();
    // Two separate writes are valid; WebGPU rejects a read in addition to a write.
    let two = g.add_fn("two", |p| {
        let b = p.storage_write_buffer(b.bytes(0, 256), ZERO)?;
        p.storage_write_buffer(b.bytes(512, 256), Intent::Modify)
    });
    let b = two.unwrap();
    let mixed = g.add_fn("mixed", |p| {
        p.indirect(b.bytes(0, 16))?;
        p.storage_write_buffer(b.bytes(512, 256), ZERO)
    });
    let error = mixed.unwrap_err();
    assert!(matches!(error.reason, DeclareReason::Conflict { buffer: true, .. }), "{error}");
    assert!(error.to_string().contains("split the pass"), "{error}");
}

/// Raster passes that use one buffer in two ways do not share a step, whatever their byte ranges.
#[test]
fn a_step_has_all_of_a_buffer_in_one_use() {
    for caps in [wgpu(), Caps::tiler(), Caps::desktop()] {
        let mut g = Graph::new();
        let (a, b) = (g.texture("a", hdr()), g.buffer("b", 1024));
        let b = g.add_fn("fill", |p| p.storage_write_buffer(b, ZERO)).unwrap();
        let a = g.add_fn("first", |p| {
            p.indirect(b.bytes(0, 16))?;
            p.color(a, BLACK)
        });
        let a = a.unwrap();
        let (a, b) = g
            .add_fn("second", |p| {
                let b = p.storage_write_buffer(b.bytes(512, 256), Intent::Modify)?;
                Ok((p.color(a, Intent::Modify)?, b))
            })
            .unwrap();
        g.export(a).unwrap();
        g.export_buffer(b).unwrap();
        assert_eq!(checked(&g, &caps).counts().render_passes, 2, "{}", caps.name);
    }
}

#[test]
fn sizes_follow_the_frame() {
    let mut g = Graph::new();
    let tiles = g.buffer("tiles", BufferSize::per_texel(8, Extent::fraction(16)));
    let tiles = g.add_fn("fill", |p| p.storage_write_buffer(tiles.bytes(0, 64), ZERO)).unwrap();
    g.add_fn("read", |p| {
        p.side_effect();
        p.storage_read_buffer(tiles.bytes(32, 32))
    })
    .unwrap();
    // 64 × 32 texels are 4 × 2 tiles of 8 bytes.
    let plan = checked(&g, &wgpu());
    assert_eq!(plan.resources()[0].bytes, 64);
    // In a smaller frame, the declared range exceeds the buffer.
    let small = Options::for_frame(16, 16);
    let refused = compile(&g, &wgpu(), &small, &mut Scratch::new(), &mut Plan::new()).unwrap_err();
    let first = &refused.listed[0];
    assert_eq!(first.reason, CompileReason::NoSuchBytes { offset: 0, bytes: 64, size: 8 });
    assert_eq!(first.pass.as_ref().map(|p| p.name.as_str()), Some("fill"));
    // A range computed from the frame size is valid at any size: here the last row of tiles.
    for frame in [[64, 32], [16, 16], [100, 50]] {
        g.reset();
        let extent = Extent::fraction(16);
        let [x, y] = extent.texels(frame).map(u64::from);
        let tiles = g.buffer("tiles", BufferSize::per_texel(8, extent));
        g.add_fn("fill", |p| {
            p.side_effect();
            p.storage_write_buffer(tiles.bytes(8 * x * (y - 1), 8 * x), ZERO)
        })
        .unwrap();
        let options = Options::for_frame(frame[0], frame[1]);
        compile(&g, &wgpu(), &options, &mut Scratch::new(), &mut Plan::new()).unwrap();
    }
    let none = Options::for_frame(0, 16);
    assert!(compile(&g, &wgpu(), &none, &mut Scratch::new(), &mut Plan::new()).is_err());
}

#[test]
fn a_plan_of_which_nothing_runs_says_so() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr());
    let a = g.add_fn("draw", |p| p.color(a, BLACK)).unwrap();
    let idle = plan(&g, &wgpu());
    assert_eq!(idle.warnings().collect::<Vec<_>>(), [Warning::NothingRuns]);
    let outputs = [dump::text(&idle), dump::json(&idle, ""), dump::dot(&idle), dump::mermaid(&idle), dump::svg(&idle)];
    for output in outputs {
        assert!(output.contains("export a resource"), "{output}");
    }
    g.export(a).unwrap();
    assert_eq!(plan(&g, &wgpu()).warnings().count(), 0);
    assert_eq!(plan(&Graph::new(), &wgpu()).warnings().count(), 0, "an empty graph gives no warning");
}
