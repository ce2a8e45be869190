//! Merging: the passes that share a step, and the reasons why others do not.

use crate::support::*;
use framegraph::*;
use framegraph_check::check;

/// Draws into `target`, optionally with a depth attachment of another shape.
fn overlay(g: &mut Graph, name: &str, target: Texture) -> Texture {
    g.add_fn(name, |p| {
        p.blends();
        p.color(target, Intent::Modify)
    })
    .unwrap()
}

fn drawn(g: &mut Graph, name: &str) -> Texture {
    let t = g.texture(&format!("{name}_out"), hdr());
    g.add_fn(name, |p| p.color(t, BLACK)).unwrap()
}

#[test]
fn the_same_attachments_are_one_step() {
    let mut g = Graph::new();
    let a = drawn(&mut g, "scene");
    let a = overlay(&mut g, "particles", a);
    let a = overlay(&mut g, "ui", a);
    g.export(a).unwrap();
    let p = plan(&g, &wgpu());
    assert_eq!(steps(&p), [["scene", "particles", "ui"]]);
    assert_eq!((p.counts().unresolves, p.counts().resolves), (0, 1));
    let off = plan_with(&g, &wgpu(), &Options { merge: false, ..options() });
    assert_eq!((off.counts().steps, off.counts().unresolves, off.counts().resolves), (3, 2, 3));
    assert_eq!(split_reason(&off, "ui"), Some(Refusal::Disabled));
}

#[test]
fn sampling_what_the_step_writes_splits() {
    let mut g = Graph::new();
    let a = drawn(&mut g, "scene");
    let b = filter(&mut g, "blur", a, Format::Rgba16Float);
    g.export(b).unwrap();
    let p = plan(&g, &Caps::tiler());
    assert_eq!(split_reason(&p, "blur"), Some(Refusal::SampledElsewhere));
}

#[test]
fn every_refusal_has_its_case() {
    type Declare = fn(&mut Graph, Texture) -> Texture;
    let cases: [(Refusal, Declare); 6] = [
        (Refusal::Extent, |g, _| {
            let t = g.texture("t", TextureDesc::new(Extent::fraction(2), Format::R8Unorm));
            g.add_fn("second", |p| p.color(t, BLACK)).unwrap()
        }),
        (Refusal::Samples, |g, _| {
            let t = g.texture("t", hdr().samples(4));
            g.add_fn("second", |p| p.color(t, BLACK)).unwrap()
        }),
        (Refusal::Layers, |g, _| {
            let t = g.texture("t", hdr().layers(3));
            g.add_fn("second", |p| p.color(t, BLACK)).unwrap()
        }),
        (Refusal::ColorsDiffer, |g, _| {
            let t = g.texture("t", hdr());
            g.add_fn("second", |p| p.color(t, BLACK)).unwrap()
        }),
        (Refusal::NeverMerge, |g, a| {
            g.add_fn("second", |p| {
                p.never_merge();
                p.color(a, Intent::Modify)
            })
            .unwrap()
        }),
        (Refusal::NotRaster, |g, a| {
            let t = g.texture("t", hdr());
            g.add_fn("second", |p| {
                p.sampled(a)?;
                p.storage_write(t, Intent::Overwrite)
            })
            .unwrap()
        }),
    ];
    for (refusal, declare) in cases {
        let mut g = Graph::new();
        let a = drawn(&mut g, "first");
        let b = declare(&mut g, a);
        g.export(b).unwrap();
        if g.resource_of(a) != g.resource_of(b) {
            g.export(a).unwrap();
        }
        let p = plan(&g, &wgpu());
        assert_eq!(p.counts().steps, 2, "{refusal:?}");
        assert_eq!(split_reason(&p, "second"), Some(refusal));
    }
}

/// Draws into `targets`, each in its slot.
fn draws(g: &mut Graph, name: &str, targets: &[(u8, Texture, Intent)]) -> Vec<Texture> {
    g.add_fn(name, |p| targets.iter().map(|(slot, t, intent)| p.color_at(*slot, *t, *intent)).collect()).unwrap()
}

/// Returns two passes that draw the same two textures, the second one in the given slots.
fn exchanged(slots: [u8; 2]) -> Graph {
    let mut g = Graph::new();
    let (a, b) = (g.texture("a", hdr()), g.texture("b", hdr()));
    let drawn = draws(&mut g, "first", &[(0, a, BLACK), (1, b, BLACK)]);
    let drawn = draws(&mut g, "second", &[(slots[0], drawn[0], Intent::Modify), (slots[1], drawn[1], Intent::Modify)]);
    drawn.into_iter().for_each(|t| g.export(t).unwrap());
    g
}

#[test]
fn the_same_targets_in_other_slots_merge_where_slots_are_mapped() {
    for slots in [[0, 1], [1, 0], [2, 5]] {
        let g = exchanged(slots);
        for (caps, mapped) in [(Caps::desktop(), true), (Caps::tiler(), true), (wgpu(), false)] {
            let p = plan(&g, &caps);
            assert!(check::examine(&p).is_clean());
            let merges = mapped || slots == [0, 1];
            assert_eq!(p.counts().steps, if merges { 1 } else { 2 }, "{slots:?}, {}", caps.name);
            assert_eq!(split_reason(&p, "second"), (!merges).then_some(Refusal::SlotsDiffer));
            let [a, b] = [p.attachments()[0], p.attachments()[1]];
            assert_eq!((a.role, b.role), (Role::Color(0), Role::Color(1)), "slots of the first pass");
        }
    }
}

#[test]
fn slots_that_a_pass_leaves_out_are_masked() {
    // Depth is shared; the second pass uses a slot that is free in the first.
    let mut g = Graph::new();
    let (a, b, z) = (g.texture("a", hdr()), g.texture("b", hdr()), g.texture("z", depth()));
    let (a, z) = g.add_fn("first", |p| Ok((p.color(a, BLACK)?, p.depth(z, FAR)?))).unwrap();
    let b = g
        .add_fn("second", |p| {
            p.depth(z, Intent::Modify)?;
            p.color_at(2, b, BLACK)
        })
        .unwrap();
    g.export(a).unwrap();
    g.export(b).unwrap();
    let p = plan(&g, &wgpu());
    assert!(check::examine(&p).is_clean());
    assert_eq!(steps(&p), [["first", "second"]]);
    let few = plan(&g, &Caps { max_color_bytes_per_sample: 8, ..wgpu() });
    assert_eq!(split_reason(&few, "second"), Some(Refusal::TooManyAttachments));
}

#[test]
fn hazards_are_those_of_parts() {
    // The second pass samples another layer than the first one draws.
    let caps = [wgpu(), Caps::tiler(), Caps::desktop()];
    let layers = |read: u16, drawn: u16| {
        let mut g = Graph::new();
        let t = g.import_texture("t", hdr().layers(3), Entry::Defined, Exit::Keep);
        let out = g.texture("out", hdr());
        let (t, out) = g.add_fn("first", |p| Ok((p.color(t.layer(drawn), BLACK)?, p.color(out, BLACK)?))).unwrap();
        let out = g
            .add_fn("second", |p| {
                p.sampled(t.layer(read))?;
                p.color_at(1, out, Intent::Modify)
            })
            .unwrap();
        g.export(out).unwrap();
        g
    };
    // One plane is drawn, the other sampled.
    let planes = |read: Aspect| {
        let mut g = Graph::new();
        let ds = color(Format::Depth32FloatStencil8);
        let ds = g.import_texture("ds", ds, Entry::Defined, Exit::Keep);
        let out = g.texture("out", hdr());
        let (ds, out) =
            g.add_fn("first", |p| Ok((p.depth(ds.aspect(Aspect::Depth), FAR)?, p.color(out, BLACK)?))).unwrap();
        let out = g
            .add_fn("second", |p| {
                p.sampled(ds.aspect(read))?;
                p.color(out, Intent::Modify)
            })
            .unwrap();
        g.export(out).unwrap();
        g
    };
    // One level is written in memory, the other read there.
    let levels = |read: u8| {
        let mut g = Graph::new();
        let t = g.import_texture("t", hdr().mips(2), Entry::Defined, Exit::Keep);
        let out = g.texture("out", hdr());
        let (t, out) =
            g.add_fn("first", |p| Ok((p.storage_write(t.mip(1), Intent::Overwrite)?, p.color(out, BLACK)?))).unwrap();
        let out = g
            .add_fn("second", |p| {
                p.sampled(t.mip(read))?;
                p.color(out, Intent::Modify)
            })
            .unwrap();
        g.export(out).unwrap();
        g
    };
    let elsewhere = Some(Refusal::SampledElsewhere);
    for caps in caps {
        let refused = |g: &Graph| {
            let p = plan(g, &caps);
            let report = check::examine(&p);
            assert!(report.is_clean(), "{report}");
            split_reason(&p, "second")
        };
        assert_eq!([0, 1, 2].map(|read| refused(&layers(read, 1))), [None, elsewhere, None]);
        assert_eq!([0, 1].map(|read| refused(&levels(read))), [None, Some(Refusal::StorageHazard)]);
        // wgpu tracks both planes of a texture together.
        let stencil = if caps.separate_planes { None } else { elsewhere };
        assert_eq!([Aspect::Depth, Aspect::Stencil].map(|read| refused(&planes(read))), [elsewhere, stencil]);
    }
}

#[test]
fn compute_between_splits_and_says_so() {
    let mut g = Graph::new();
    let a = drawn(&mut g, "first");
    let t = g.texture("t", hdr());
    let t = g.add_fn("compute", |p| p.storage_write(t, Intent::Overwrite)).unwrap();
    let a = overlay(&mut g, "second", a);
    g.export(a).unwrap();
    g.export(t).unwrap();
    let p = plan(&g, &wgpu());
    assert_eq!(split_reason(&p, "second"), Some(Refusal::ComputeBetween));
}

#[test]
fn another_depth_attachment_splits() {
    let mut g = Graph::new();
    let a = drawn(&mut g, "first");
    let (z, y) = (g.texture("z", depth()), g.texture("y", depth()));
    let a = g
        .add_fn("with_z", |p| {
            p.depth(z, FAR)?;
            p.color(a, Intent::Modify)
        })
        .unwrap();
    let a = g
        .add_fn("with_y", |p| {
            p.depth(y, FAR)?;
            p.color(a, Intent::Modify)
        })
        .unwrap();
    g.export(a).unwrap();
    let p = plan(&g, &wgpu());
    assert_eq!(steps(&p), [vec!["first", "with_z"], vec!["with_y"]]);
    assert_eq!(split_reason(&p, "with_y"), Some(Refusal::DepthDiffers));
}

#[test]
fn a_resolved_attachment_cannot_change_afterwards() {
    let mut g = Graph::new();
    let (ms, into) = (g.texture("ms", hdr().samples(4)), g.texture("into", hdr()));
    let (ms, into) = g
        .add_fn("first", |p| {
            let ms = p.color(ms, BLACK)?;
            Ok((ms, p.resolve(ms, into)?))
        })
        .unwrap();
    let ms = overlay(&mut g, "second", ms);
    g.export(ms).unwrap();
    g.export(into).unwrap();
    let p = plan(&g, &wgpu());
    assert_eq!(split_reason(&p, "second"), Some(Refusal::ResolveBetween));
}

/// Returns an on-tile deferred frame: G-buffer, lighting that reads it at the same pixel, and transparent objects.
pub fn deferred() -> Graph {
    let mut g = Graph::new();
    let out = screen(&mut g);
    let names = ["albedo", "normal", "pbr"];
    let gbuffer = names.map(|n| g.texture(n, color(Format::Rgba8Unorm)));
    let (z, light) = (g.texture("depth", depth()), g.texture("light", hdr()));
    let (gbuffer, z) = g
        .add_fn("gbuffer", |p| {
            let gbuffer = [p.color(gbuffer[0], BLACK)?, p.color(gbuffer[1], BLACK)?, p.color(gbuffer[2], BLACK)?];
            Ok((gbuffer, p.depth(z, FAR)?))
        })
        .unwrap();
    let light = g
        .add_fn("lighting", |p| {
            for input in gbuffer {
                p.same_pixel(input)?;
            }
            p.same_pixel(z)?;
            p.color(light, Intent::Overwrite)
        })
        .unwrap();
    g.add_fn("tonemap", |p| {
        p.same_pixel(light)?;
        p.color(out, Intent::Overwrite)
    })
    .unwrap();
    g
}

#[test]
fn a_tiler_keeps_a_deferred_frame_in_the_tile() {
    let p = plan(&deferred(), &Caps::tiler());
    assert_eq!(steps(&p), [["gbuffer", "lighting", "tonemap"]]);
    let c = p.counts();
    assert_eq!((c.unresolves, c.resolves, c.memoryless), (0, 1, 5), "{}", dump::text(&p));
}

#[test]
fn a_device_without_same_pixel_reads_splits_the_deferred_frame() {
    let p = plan(&deferred(), &wgpu());
    assert_eq!(p.counts().steps, 3);
    assert_eq!(split_reason(&p, "lighting"), Some(Refusal::SamePixelUnsupported));
    assert_eq!(p.counts().resolves, 4 + 1 + 1);
}

#[test]
fn tile_memory_limits_a_step() {
    let small = Caps { tile_bytes_per_pixel: 24, ..Caps::tiler() };
    let p = plan(&deferred(), &small);
    assert_eq!(split_reason(&p, "lighting"), Some(Refusal::TileMemory));
}
