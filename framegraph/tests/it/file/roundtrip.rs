//! Properties of many random graphs and many damaged files.

use super::{FRAME_FILE, assert_same_plan};
use crate::support::*;
use framegraph::file::*;
use framegraph::*;

/// The generator SplitMix64 of Vigna (public domain reference, 2015).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    fn one<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }
}

fn random_desc(r: &mut Random) -> TextureDesc {
    let format = Format::ALL[r.below(Format::ALL.len())];
    let extent = match r.below(4) {
        0 => Extent::absolute(1 + r.below(300) as u32, 1 + r.below(300) as u32),
        1 => Extent::Relative { num: 1 + r.below(3) as u16, den: 1 + r.below(4) as u16, align: 1 + r.below(16) as u16 },
        _ => Extent::FRAME,
    };
    let mut desc = TextureDesc::new(extent, format);
    match r.below(5) {
        0 => desc.mips = r.one(&[TextureDesc::ALL_MIPS, 2, 5]),
        1 => desc.layers = 1 + r.below(7) as u16,
        2 => desc.samples = r.one(&[1, 2, 4, 8]),
        3 => desc.dimension = Dimension::D3,
        _ => {}
    }
    desc
}

fn random_range(r: &mut Random) -> Range {
    let mut range = Range::ALL;
    if r.below(2) == 0 {
        (range.mip, range.mips) = (r.below(3) as u8, r.one(&[1, 2, u8::MAX]));
    }
    if r.below(3) == 0 {
        (range.layer, range.layers) = (r.below(4) as u16, r.one(&[1, 2, u16::MAX]));
    }
    if r.below(6) == 0 {
        range.aspect = r.one(&[Aspect::Depth, Aspect::Stencil]);
    }
    if r.below(4) == 0 {
        range.view = Some(r.one(&[Format::Rgba8Unorm, Format::Rgba8UnormSrgb]));
    }
    range
}

fn random_intent(r: &mut Random) -> Intent {
    match r.below(7) {
        0 => Intent::Clear(ClearValue::Color([0.1, -0.0, f64::INFINITY, 1e-300])),
        1 => Intent::Clear(ClearValue::DepthStencil(0.1, 7)),
        2 => Intent::Clear(ClearValue::FAR_REVERSED),
        3 => Intent::Clear(ClearValue::Zero),
        4 => Intent::Modify,
        _ => Intent::Overwrite,
    }
}

/// Returns a random graph of valid declarations. Names are duplicate, empty, or contain special characters.
fn random_graph(seed: u64) -> Graph {
    const NAMES: [&str; 9] = ["a", "b", "a", "", "x@y", "entry", "tab\t\"quote\" ü", "a#2", "e/f"];
    let r = &mut Random(seed);
    let mut g = Graph::new();
    let (mut textures, mut buffers, mut previous) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..1 + r.below(6) {
        let name = r.one(&NAMES);
        let entry = r.one(&[Entry::Defined, Entry::Undefined]);
        let exit = r.one(&[Exit::Keep, Exit::Discard]);
        match r.below(6) {
            0 => textures.push(g.import_texture(name, random_desc(r), entry, exit)),
            1 if r.below(3) == 0 => {
                buffers.push(g.buffer(name, BufferSize::per_texel(3, random_desc(r).extent)));
            }
            1 => buffers.push(g.buffer(name, 1 + r.below(999) as u64)),
            2 => buffers.push(g.import_buffer(name, 4, entry, exit)),
            3 => {
                let history = g.history(name, random_desc(r), 3);
                textures.push(history);
                previous.extend(g.previous(history, 1 + r.below(4) as u8).ok());
            }
            _ => textures.push(g.texture(name, random_desc(r))),
        }
    }
    for _ in 0..r.below(7) {
        let (new_textures, new_buffers) = (&mut textures, &mut buffers);
        let name = r.one(&NAMES);
        g.add_fn(name, |p| {
            if r.below(3) == 0 && new_textures.len() < 12 {
                new_textures.push(p.texture(r.one(&NAMES), random_desc(r)));
            }
            for _ in 0..r.below(6) {
                random_access(p, r, new_textures, new_buffers, &previous);
            }
            for flag in 0..5 {
                match (r.below(8), flag) {
                    (0, 0) => p.side_effect(),
                    (0, 1) => p.pointwise(),
                    (0, 2) => p.blends(),
                    (0, 3) => p.takes_epilogue(),
                    (0, _) => p.never_merge(),
                    _ => {}
                }
            }
            let _ = p.kind(r.one(&[PassKind::Raster, PassKind::Compute, PassKind::Copy]));
            Ok(())
        })
        .unwrap();
    }
    for texture in &textures {
        match r.below(4) {
            0 => drop(g.export(*texture)),
            1 => drop(g.readback(*texture)),
            _ => {}
        }
    }
    buffers.iter().filter(|_| r.below(3) == 0).for_each(|b| drop(g.export_buffer(*b)));
    g
}

/// Declares one access of any kind; invalid ones leave nothing.
fn random_access(
    p: &mut PassBuilder<'_>,
    r: &mut Random,
    textures: &mut [Texture],
    buffers: &mut [Buffer],
    previous: &[Previous],
) {
    let intent = random_intent(r);
    if r.below(4) == 0 && !buffers.is_empty() {
        let at = r.below(buffers.len());
        let kinds = [AccessKind::StorageRead, AccessKind::Uniform, AccessKind::Vertex, AccessKind::Index];
        if r.below(2) == 0 {
            let _ = p.read_buffer(buffers[at], r.one(&kinds));
        } else if let Ok(b) = p.write_buffer(buffers[at], AccessKind::StorageWrite, intent) {
            buffers[at] = b;
        }
        return;
    }
    if textures.is_empty() {
        return;
    }
    let at = r.below(textures.len());
    let part = textures[at].range(random_range(r));
    let read = match (r.below(4), previous) {
        (0, [.., last]) => ReadOnly::from(*last),
        _ => part.read_only(),
    };
    let written = match r.below(10) {
        0 => p.sampled(read).is_err().then_some(textures[at]),
        1 => p.same_pixel(read).is_err().then_some(textures[at]),
        2 => p.storage_read(read).is_err().then_some(textures[at]),
        3 => p.depth_read_only(read).is_err().then_some(textures[at]),
        4 => p.depth(part, intent).ok(),
        5 => p.storage_write(part, intent).ok(),
        6 => p.color_at(r.below(8) as u8, part, intent).ok(),
        7 => p.color(part, intent).ok().map(|ms| {
            let other = (at + 1) % textures.len();
            if let Ok(t) = p.resolve(ms, textures[other].mip(0)) {
                textures[other] = t;
            }
            if other == at { textures[at] } else { ms }
        }),
        _ => p.color(part, intent).ok(),
    };
    if let Some(written) = written {
        textures[at] = written;
    }
}

#[test]
fn every_graph_reads_back_as_it_was() {
    let (mut compiled, mut passes) = (0, 0);
    for seed in 0..600 {
        let graph = random_graph(seed);
        let text = to_ron(&graph, "random", FRAME);
        let again = match GraphFile::parse("r.ron", &text).and_then(|f| f.graph(&[])) {
            Ok(again) => again,
            Err(errors) => panic!("seed {seed}: {errors}\n{text}"),
        };
        assert_eq!(to_ron(&again, "random", FRAME), text, "seed {seed}");
        assert_eq!(again.accesses().len(), graph.accesses().len(), "seed {seed}");
        passes += graph.passes().len();
        for caps in [wgpu(), Caps::tiler()] {
            let run = |g: &Graph| {
                let mut plan = Plan::new();
                compile(g, &caps, &options(), &mut Scratch::new(), &mut plan).map(|()| plan)
            };
            match (run(&graph), run(&again)) {
                (Ok(a), Ok(b)) => {
                    assert_same_plan(&a, &b);
                    compiled += 1;
                }
                // Deferred errors of a graph are not part of the file.
                (Err(a), _) if put_off(&a) => {}
                (Err(a), Err(b)) => assert_eq!(a.listed.len(), b.listed.len(), "seed {seed}: {a}\n{b}"),
                (a, b) => panic!("seed {seed}: {:?} against {:?}", a.map(drop), b.map(drop)),
            }
        }
    }
    assert!(compiled > 60 && passes > 1000, "{compiled} plans of {passes} passes: too few");
}

#[test]
fn damaged_files_never_panic_and_every_error_has_its_place() {
    let r = &mut Random(7);
    let mut outcomes = [0, 0];
    let words: Vec<&str> = FRAME_FILE.split_inclusive([' ', '(', ')', ',', '"']).collect();
    for _ in 0..4_000 {
        let text = match r.below(3) {
            0 => damaged_bytes(r),
            1 => {
                let mut words = words.clone();
                for _ in 0..1 + r.below(2) {
                    let (a, b) = (r.below(words.len()), r.below(words.len()));
                    words[a] = words[b];
                }
                words.concat()
            }
            _ => {
                let mut words = words.clone();
                words.remove(r.below(words.len()));
                words.concat()
            }
        };
        let outcome = GraphFile::parse("d.ron", &text).and_then(|f| {
            let graph = f.graph(&[])?;
            let mut plan = Plan::new();
            compile(&graph, &wgpu(), &options(), &mut Scratch::new(), &mut plan).map_err(|e| f.explain(&e))
        });
        outcomes[usize::from(outcome.is_err())] += 1;
        let Err(errors) = outcome else { continue };
        let lines = text.lines().count().max(1);
        for error in &errors.listed {
            assert!((1..=lines + 1).contains(&error.line) && error.column >= 1, "{error}\n{text}");
            let line = error.to_string();
            assert!(!line.contains('\n') && line.contains("; "), "{line}");
        }
        assert!(!errors.listed.is_empty());
    }
    assert!(outcomes[0] > 20 && outcomes[1] > 1000, "{outcomes:?}: too few");
}

fn put_off(errors: &CompileErrors) -> bool {
    let is = |e: &CompileError| matches!(e.reason, CompileReason::Declare(_));
    errors.listed.iter().any(is)
}

fn damaged_bytes(r: &mut Random) -> String {
    let mut bytes = FRAME_FILE.as_bytes().to_vec();
    for _ in 0..1 + r.below(4) {
        let at = r.below(bytes.len());
        match r.below(4) {
            0 => bytes[at] = r.next() as u8,
            1 => drop(bytes.drain(at..(at + r.below(40)).min(bytes.len()))),
            2 => bytes.insert(at, r.one(b"()[]{},:\"@-0919\\/*#rn\xff\x00")),
            _ => {
                let slice = bytes[at..(at + 30).min(bytes.len())].to_vec();
                let to = r.below(bytes.len());
                bytes.splice(to..to, slice);
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[test]
fn nesting_and_length_are_bounded() {
    for text in [
        "(".repeat(100_000),
        "[".repeat(100_000),
        format!("(version: 1, expect: {}", "[".repeat(100_000)),
        format!("(version: 1, passes: [{}", "Raster(".repeat(100_000)),
        format!("/*{}", "/*".repeat(100_000)),
        format!(
            "(version: 1, features: {{\"a\": true}}, passes: [Raster(name: \"p\", when: \"{}a\")])",
            "a&&".repeat(100_000)
        ),
    ] {
        let _ = GraphFile::parse("n.ron", &text).and_then(|f| f.graph(&[]));
    }
    // Many errors, each of which searches a suggestion.
    let resources: Vec<_> = (0..400).map(|i| format!("Buffer(name: \"b{i}\", bytes: 1)")).collect();
    let accesses: Vec<_> = (0..400).map(|i| format!("Uniform(of: \"c{i}\")")).collect();
    let (resources, accesses) = (resources.join(","), accesses.join(","));
    let text =
        format!("(version: 1, resources: [{resources}], passes: [Compute(name: \"p\", accesses: [{accesses}])])");
    let errors = GraphFile::parse("n.ron", &text).and_then(|f| f.graph(&[])).unwrap_err();
    assert_eq!(errors.listed.len(), 100);
    // Many subresources, each of which the compiler would track.
    let texture = r#"Texture(name: "t", format: R8Unorm, layers: 65535, mips: 14, size: Texels(8192, 8192))"#;
    let textures: Vec<_> = (0..40).map(|i| texture.replacen("t\"", &format!("t{i}\""), 1)).collect();
    let text = format!("(version: 1, resources: [{}])", textures.join(","));
    let errors = GraphFile::parse("n.ron", &text).and_then(|f| f.graph(&[])).unwrap_err();
    assert!(errors.to_string().contains("fewer levels or layers"), "{errors}");
}
