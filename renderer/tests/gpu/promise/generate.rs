//! Generator of cases: every format × access × samples × dimension × view, and every limit and its neighbors.

use super::case::{Case, SIDE, Use, access, small, target, twin};
use framegraph::{
    AccessKind, Aspect, Caps, ClearValue, Dimension, Entry, Exit, Extent, Format, Intent, PassKind, TextureDesc,
};

/// Largest texture or buffer that a case creates on a device that draws, in bytes.
pub const BUDGET_BYTES: u64 = 32 << 20;

/// Returns all cases for a device. `budget_bytes` limits the size of a resource.
pub fn cases(caps: &Caps, budget_bytes: u64) -> Vec<Case> {
    let mut cases = Vec::new();
    formats(&mut cases);
    views(&mut cases);
    sizes(caps, budget_bytes, &mut cases);
    bindings(caps, &mut cases);
    bytes(caps, budget_bytes, &mut cases);
    attachments(&mut cases);
    layers(&mut cases);
    planes(&mut cases);
    slices(&mut cases);
    cases
}

/// Every format × access × samples × dimension × view.
fn formats(cases: &mut Vec<Case>) {
    let shapes = [("2D", 1, Dimension::D2), ("2 layers", 2, Dimension::D2), ("3D", 2, Dimension::D3)];
    for format in Format::ALL {
        for wanted in Use::ALL {
            for (shape, layers, dimension) in shapes {
                for samples in [1, 2, 4, 8, 16] {
                    for view in [None].into_iter().chain(twin(format).map(Some)) {
                        // Few sample counts are enough for shapes that no device multisamples.
                        if layers > 1 && samples > 4 || view.is_some() && samples == 2 {
                            continue;
                        }
                        let desc = TextureDesc { dimension, ..small(format).layers(layers).samples(samples) };
                        let name = format!("{format:?} {wanted:?} {shape} x{samples} as {view:?}");
                        cases.push(Case::new("format", name, move |frame| access(frame, desc, view, wanted)));
                    }
                }
            }
        }
    }
}

/// Attachments that never leave the tile, viewed in another format, alone and resolved; and mixed views.
fn views(cases: &mut Vec<Case>) {
    for format in Format::ALL {
        let Some(other) = twin(format) else { continue };
        for (samples, resolved, later) in
            [(1, false, false), (4, false, false), (4, true, false), (1, false, true), (4, true, true)]
        {
            let name = format!("{format:?} as {other:?} x{samples}, resolved {resolved}, sampled later {later}");
            cases.push(Case::new("view", name, move |frame| {
                let graph = frame.graph_mut();
                let desc = small(format);
                let samples = graph.texture("t", desc.samples(samples));
                let single = graph.texture("single", desc);
                let drawn = graph.add_fn("draw", |pass| {
                    pass.side_effect();
                    let drawn = pass.color(samples.viewed_as(other), Intent::Clear(ClearValue::BLACK))?;
                    if resolved { pass.resolve(drawn, single.viewed_as(other)) } else { Ok(drawn) }
                })?;
                if later {
                    graph.add_fn("look", |pass| {
                        pass.side_effect();
                        pass.sampled(drawn)?;
                        pass.kind(PassKind::Compute)
                    })?;
                }
                Ok(())
            }));
        }
    }
}

/// Sizes, layers and levels at their limits.
fn sizes(caps: &Caps, budget_bytes: u64, cases: &mut Vec<Case>) {
    let near = |limit: u64| [limit.saturating_sub(1), limit, limit + 1].into_iter().filter(|n| *n > 0);
    let mut texture = |name: String, desc: TextureDesc| {
        if desc.bytes([SIDE; 2]) > budget_bytes {
            return;
        }
        for wanted in [Use::Sampled, Use::StorageWrite] {
            let name = format!("{name} {wanted:?}");
            cases.push(Case::new("size", name, move |frame| access(frame, desc, None, wanted)));
        }
    };
    let of = |w: u64, h: u64| TextureDesc::new(Extent::absolute(w as u32, h as u32), Format::R32Float);
    for side in near(caps.max_texture_texels.into()) {
        texture(format!("{side} wide"), of(side, 1));
        texture(format!("{side} high"), of(1, side));
    }
    for layers in near(caps.max_texture_layers.into()).filter(|n| *n <= u64::from(u16::MAX)) {
        texture(format!("{layers} layers"), of(1, 1).layers(layers as u16));
    }
    for side in near(caps.max_volume_texels.into()) {
        let volume = |desc: TextureDesc| TextureDesc { dimension: Dimension::D3, ..desc };
        texture(format!("volume {side} wide"), volume(of(side, 1)));
        texture(format!("volume {side} high"), volume(of(1, side)));
        if side <= u64::from(u16::MAX) {
            texture(format!("volume {side} deep"), volume(of(1, 1).layers(side as u16)));
        }
    }
    for (width, height, depth) in [(8, 8, 1), (8, 1, 1), (3, 5, 1), (2, 2, 16), (1, 1, 1)] {
        for mips in 1..=6 {
            let desc = of(width, height).mips(mips);
            texture(format!("{width}x{height} with {mips} levels"), desc);
            let desc = TextureDesc { dimension: Dimension::D3, ..desc.layers(depth) };
            texture(format!("{width}x{height}x{depth} with {mips} levels"), desc);
        }
    }
    for format in Format::ALL.into_iter().filter(|f| f.is_compressed()) {
        for (width, height) in [(4, 4), (8, 8), (6, 8), (8, 12), (12, 12), (16, 16), (1, 1)] {
            let desc = TextureDesc::new(Extent::absolute(width, height), format);
            let name = format!("{format:?} {width}x{height}");
            cases.push(Case::new("block", name, move |frame| access(frame, desc, None, Use::Sampled)));
        }
    }
}

/// Number of bindings of one pass.
fn bindings(caps: &Caps, cases: &mut Vec<Case>) {
    let limits = [
        ("sampled textures", caps.max_sampled_textures),
        ("storage textures", caps.max_storage_textures),
        ("storage buffers", caps.max_storage_buffers),
        ("uniform buffers", caps.max_uniform_buffers),
    ];
    for (what, limit) in limits.into_iter().filter(|(_, limit)| *limit < 300) {
        // A raster pass has two stages.
        let one = (limit.saturating_sub(1)..=limit + 1).flat_map(|n| [(n, false), (n, true)]);
        for (count, raster) in one.chain((limit * 2 - 1..=limit * 2 + 1).map(|n| (n, true))) {
            let name = format!("{count} {what}, raster {raster}");
            cases.push(Case::new("bindings", name, move |frame| {
                let graph = frame.graph_mut();
                let format = if what == "storage textures" { Format::R32Float } else { Format::Rgba8Unorm };
                let textures: Vec<_> = (0..count)
                    .map(|n| graph.import_texture(&format!("t{n}"), small(format), Entry::Defined, Exit::Discard))
                    .collect();
                let buffers: Vec<_> = (0..count)
                    .map(|n| graph.import_buffer(&format!("b{n}"), 64, Entry::Defined, Exit::Discard))
                    .collect();
                graph.add_fn("case", |pass| {
                    pass.side_effect();
                    for (texture, buffer) in textures.iter().zip(&buffers) {
                        match what {
                            "sampled textures" => drop(pass.sampled(*texture)?),
                            "storage textures" => drop(pass.storage_write(*texture, Intent::Overwrite)?),
                            "storage buffers" => drop(pass.storage_read_buffer(*buffer)?),
                            _ => drop(pass.uniform(*buffer)?),
                        }
                    }
                    if raster { target(pass) } else { pass.kind(PassKind::Compute) }
                })
            }));
        }
    }
}

/// Sizes of buffers, and offsets and sizes of ranges.
fn bytes(caps: &Caps, budget_bytes: u64, cases: &mut Vec<Case>) {
    let kinds = {
        use AccessKind::*;
        [Uniform, Vertex, Index, Indirect, StorageRead, StorageWrite, CopySource, CopyTarget]
    };
    for kind in kinds {
        let mut sizes: Vec<u64> = (1..=9).chain([16, 255, 256, 257, 65535, 1 << 20]).collect();
        // Large buffers take time, so each limit is met once.
        let limit = match kind {
            AccessKind::Uniform => caps.max_uniform_bytes,
            AccessKind::StorageRead => caps.max_storage_bytes,
            _ => caps.max_buffer_bytes,
        };
        let tried = matches!(kind, AccessKind::Uniform | AccessKind::StorageRead | AccessKind::Vertex);
        let near = [limit - 4, limit - 1, limit, limit.saturating_add(1), limit.saturating_add(4)];
        sizes.extend(near.into_iter().filter(|_| tried));
        sizes.retain(|bytes| *bytes <= budget_bytes);
        for size in sizes.iter().copied() {
            let name = format!("{size} bytes as {kind}");
            cases.push(Case::new("bytes", name, move |frame| buffer(frame, size, None, kind, Intent::Overwrite)));
        }
        for offset in [0, 1, 2, 4, 16, 64, 128, 256, 260] {
            for bytes in [1, 3, 4, 6, 16, 256] {
                let name = format!("bytes {offset}..{} as {kind}", offset + bytes);
                let range = Some((offset, bytes));
                cases.push(Case::new("range", name, move |frame| buffer(frame, 1024, range, kind, Intent::Overwrite)));
                if matches!(kind, AccessKind::StorageWrite | AccessKind::CopyTarget) {
                    let name = format!("cleared bytes {offset}..{} as {kind}", offset + bytes);
                    let zero = Intent::Clear(ClearValue::Zero);
                    cases.push(Case::new("clear", name, move |frame| buffer(frame, 1024, range, kind, zero)));
                }
            }
        }
    }
    for size in [1, 2, 3, 4, 5, 7, 8, 64] {
        let zero = Intent::Clear(ClearValue::Zero);
        let name = format!("a cleared buffer of {size} bytes");
        cases.push(Case::new("clear", name, move |frame| buffer(frame, size, None, AccessKind::CopyTarget, zero)));
    }
}

/// Declares one access to a buffer, or to a range of it.
fn buffer(
    frame: &mut framegraph_wgpu::Frame,
    size: u64,
    range: Option<(u64, u64)>,
    kind: AccessKind,
    intent: Intent,
) -> Result<(), framegraph::DeclareError> {
    let graph = frame.graph_mut();
    let writes = matches!(kind, AccessKind::StorageWrite | AccessKind::CopyTarget);
    let buffer = match writes {
        true => graph.buffer("b", size),
        false => graph.import_buffer("b", size, Entry::Defined, Exit::Discard),
    };
    graph.add_fn("case", |pass| {
        pass.side_effect();
        let part = range.map_or(buffer.into(), |(offset, bytes)| buffer.bytes(offset, bytes));
        match writes {
            true => drop(pass.write_buffer(part, kind, intent)?),
            false => drop(pass.read_buffer(part, kind)?),
        }
        if matches!(kind, AccessKind::Vertex | AccessKind::Index) { target(pass) } else { Ok(()) }
    })
}

/// A generator of numbers (xorshift), so that cases are the same in every run.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end as u64) as usize
    }
}

/// Combinations of color attachments, with slots that are left out, and passes without attachments.
fn attachments(cases: &mut Vec<Case>) {
    use Format::*;
    let formats = [R8Unorm, Rgba8Unorm, Rg8Unorm, R16Float, R32Float, Rgba16Float, Rgba32Float, Rgb10a2Unorm, R32Uint];
    let mut numbers = Numbers(0x9e37_79b9_7f4a_7c15);
    for number in 0..300 {
        let mut chosen = Vec::new();
        for slot in 0..8 {
            if numbers.below(3) != 0 {
                chosen.push((slot, formats[numbers.below(formats.len())]));
            }
        }
        let name = format!("{number}: {chosen:?}");
        cases.push(Case::new("attachments", name, move |frame| {
            frame.graph_mut().add_fn("case", |pass| {
                pass.side_effect();
                pass.kind(PassKind::Raster)?;
                for (slot, format) in &chosen {
                    let color = pass.texture(&format!("c{slot}"), small(*format));
                    pass.color_at(*slot, color, Intent::Overwrite)?;
                }
                Ok(())
            })
        }));
    }
    for reads in [false, true] {
        let name = format!("a raster pass without attachments, reads {reads}");
        cases.push(Case::new("attachments", name, move |frame| {
            let graph = frame.graph_mut();
            let image = graph.import_texture("t", small(Rgba8Unorm), Entry::Defined, Exit::Discard);
            graph.add_fn("case", |pass| {
                pass.side_effect();
                pass.kind(PassKind::Raster)?;
                if reads { pass.sampled(image).map(drop) } else { Ok(()) }
            })
        }));
    }
    for format in [R32Float, R32Uint, Rgba8Unorm, Rgba16Float] {
        let name = format!("{format:?} written by a raster pass");
        cases.push(Case::new("attachments", name, move |frame| {
            frame.graph_mut().add_fn("case", |pass| {
                pass.side_effect();
                let stored = pass.texture("t", small(format));
                pass.storage_write(stored, Intent::Overwrite)?;
                target(pass)
            })
        }));
    }
}

/// Layers attached at once.
fn layers(cases: &mut Vec<Case>) {
    for format in [Format::Rgba8Unorm, Format::Depth32Float] {
        for (layers, samples) in [1, 2, 3, 6, 7, 33].into_iter().flat_map(|n| [(n, 1), (n, 4)]) {
            let name = format!("{layers} layers of {format:?} x{samples}");
            cases.push(Case::new("layers", name, move |frame| {
                let wanted = if format.is_depth_stencil() { Use::Depth } else { Use::Color };
                access(frame, small(format).layers(layers).samples(samples), None, wanted)
            }));
        }
    }
}

/// Planes of a depth-stencil texture, attached and read by one pass or by two.
fn planes(cases: &mut Vec<Case>) {
    let aspects = [Aspect::All, Aspect::Depth, Aspect::Stencil];
    for format in [Format::Depth24PlusStencil8, Format::Depth32FloatStencil8] {
        for (attached, read) in aspects.into_iter().flat_map(|a| aspects.map(|b| (a, b))) {
            for (writes, same_pixel, apart) in [false, true]
                .into_iter()
                .flat_map(|w| [(w, false, false), (w, true, false), (w, false, true), (w, true, true)])
            {
                let name = format!(
                    "{format:?} {attached:?} attached, writes {writes}, {read:?} read, same pixel {same_pixel}, apart {apart}"
                );
                cases.push(Case::new("planes", name, move |frame| {
                    let graph = frame.graph_mut();
                    let ds = graph.import_texture("ds", small(format), Entry::Defined, Exit::Discard);
                    let attach = |pass: &mut framegraph::PassBuilder<'_>, ds: framegraph::Texture| {
                        pass.side_effect();
                        match writes {
                            true => pass.depth(ds.aspect(attached), Intent::Modify),
                            false => pass.depth_read_only(ds.aspect(attached)).map(|_| ds),
                        }
                    };
                    let look = |pass: &mut framegraph::PassBuilder<'_>, ds: framegraph::Texture| match same_pixel {
                        true => pass.same_pixel(ds.aspect(read)).map(drop),
                        false => pass.sampled(ds.aspect(read)).map(drop),
                    };
                    if apart {
                        let ds = graph.add_fn("attach", |pass| attach(pass, ds))?;
                        return graph.add_fn("look", |pass| {
                            pass.side_effect();
                            look(pass, ds).and_then(|()| target(pass))
                        });
                    }
                    graph.add_fn("case", |pass| {
                        look(pass, ds)?;
                        attach(pass, ds).map(drop)
                    })
                }));
            }
        }
    }
}

/// Slices of three-dimensional textures as attachments.
fn slices(cases: &mut Vec<Case>) {
    for format in [Format::Rgba8Unorm, Format::Rgba16Float, Format::R32Float, Format::Depth32Float] {
        for (mip, slice, depth) in [(0, 0, 4), (0, 3, 4), (0, 4, 4), (1, 1, 4), (1, 2, 4), (2, 0, 4), (0, 0, 1)] {
            for intent in [Intent::Overwrite, Intent::Clear(ClearValue::BLACK), Intent::Modify] {
                let name = format!("{format:?} slice {slice} of {depth}, level {mip}, {intent:?}");
                cases.push(Case::new("slices", name, move |frame| {
                    let graph = frame.graph_mut();
                    let desc = TextureDesc { dimension: Dimension::D3, ..small(format).layers(depth).mips(3) };
                    let volume = match intent {
                        Intent::Modify => graph.import_texture("v", desc, Entry::Defined, Exit::Discard),
                        _ => graph.texture("v", desc),
                    };
                    let volume = graph.add_fn("draw", |pass| {
                        pass.side_effect();
                        pass.color(volume.mip(mip).layer(slice), intent)
                    })?;
                    graph.add_fn("look", |pass| {
                        pass.side_effect();
                        pass.sampled(volume.mip(mip))?;
                        pass.kind(PassKind::Compute)
                    })
                }));
            }
        }
    }
}
