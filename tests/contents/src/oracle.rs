//! The oracle: runs a graph as declared, pass by pass, on the CPU.
//!
//! It reads only the declaration, not the plan: there is no culling, merging or aliasing. Every part of every resource
//! has its own contents. Undefined contents are unknown, and so is everything derived from them.

use super::code::{LOOKS, STENCIL_STEP, Texel, chosen, coding, fold, look, mix, planes, texel_hash, word};
use super::copy::NOTES;
use super::spec::{self, Class, Paint};
use framegraph::{Access, AccessKind, Aspect, Desc, Graph, Kind, Mode, PassId, PassKind, ResourceId};

/// Contents of one level of one layer of one plane; `None` if they are undefined.
pub type Part = Option<Vec<Texel>>;

/// Contents of a resource.
#[derive(Clone, Debug)]
pub enum Contents {
    /// Parts at index `(mip · layers + layer) · planes + plane`.
    Texture(Vec<Part>),
    Buffer(Option<Vec<u8>>),
}

/// Results of a frame.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Contents by resource.
    pub contents: Vec<Contents>,
    /// Digests of shader passes; `None` for copy passes and undefined digests.
    pub digests: Vec<Option<u32>>,
    /// Notes of copy passes; `None` if missing or undefined.
    pub notes: Vec<[Option<Vec<u8>>; NOTES]>,
}

/// History images of earlier frames, newest first, by the resource that a frame writes.
pub type Past = Vec<Vec<Contents>>;

/// Runs a frame. `entry` has the contents of imports, `past` the history images of earlier frames. `pixelwise` is that
/// of [`spec::inputs`].
pub fn run(graph: &Graph, frame: u32, entry: &[Option<Contents>], past: &Past, pixelwise: bool) -> Outcome {
    let ids = graph.resource_ids().zip(graph.resources());
    let contents = ids.map(|(id, row)| match row.kind {
        kind @ Kind::Imported { .. } if kind.defined_on_entry() => {
            entry.get(id.index()).cloned().flatten().unwrap_or_else(|| blank(graph, id, false))
        }
        Kind::HistoryPrevious { current, age } => {
            let images = &past[current.index()];
            images.get(usize::from(age) - 1).cloned().unwrap_or_else(|| blank(graph, id, true))
        }
        Kind::Imported { .. } | Kind::Transient | Kind::HistoryCurrent { .. } => blank(graph, id, false),
    });
    let notes = vec![[None, None]; graph.passes().len()];
    let mut machine = Machine { graph, frame, contents: contents.collect(), notes, pixelwise };
    let digests = graph.pass_ids().map(|pass| machine.pass(pass)).collect();
    Outcome { contents: machine.contents, digests, notes: machine.notes }
}

/// Returns undefined contents, or zeros.
pub fn blank(graph: &Graph, resource: ResourceId, zero: bool) -> Contents {
    match graph.resources()[resource.index()].desc {
        Desc::Buffer(b) => Contents::Buffer(zero.then(|| vec![0; b.bytes(super::FRAME) as usize])),
        Desc::Texture(t) => {
            let levels = 0..t.mip_count(super::FRAME) as u8;
            let each = usize::from(t.layers) * planes(t.format).len();
            let part = |mip| {
                let [width, height] = spec::texels(graph, resource, mip);
                zero.then(|| vec![[0; 4]; (width * height) as usize])
            };
            Contents::Texture(levels.flat_map(|mip| (0..each).map(move |_| part(mip))).collect())
        }
    }
}

/// Returns the index of a part.
pub fn part_index(graph: &Graph, resource: ResourceId, mip: u8, layer: u16, plane: Aspect) -> usize {
    let Desc::Texture(t) = graph.resources()[resource.index()].desc else { return 0 };
    let count = planes(t.format).len();
    (usize::from(mip) * usize::from(t.layers) + usize::from(layer)) * count + spec::plane_index(t.format, plane)
}

/// State of the frame that is being executed.
pub struct Machine<'g> {
    pub graph: &'g Graph,
    pub frame: u32,
    pub contents: Vec<Contents>,
    pub notes: Vec<[Option<Vec<u8>>; NOTES]>,
    pixelwise: bool,
}

impl Machine<'_> {
    /// Runs one pass and returns its digest.
    fn pass(&mut self, pass: PassId) -> Option<u32> {
        if self.graph.passes()[pass.index()].kind == PassKind::Copy {
            self.copy(pass);
            return None;
        }
        let compute = self.graph.passes()[pass.index()].kind == PassKind::Compute;
        let salt = spec::salt(pass, self.frame);
        let digest = self.digest(pass, salt);
        let with_arguments = self.with_arguments(pass, digest, compute);
        let accesses = self.graph.accesses_of(pass);
        // Color is tested against the depth before the pass.
        for (row, access) in accesses.iter().enumerate().filter(|(_, a)| a.kind == AccessKind::Color) {
            self.paint(Some(pass), row, access, Aspect::All, salt, with_arguments);
            self.paint_where_tested(pass, row, access, salt, digest);
        }
        for (row, access) in accesses.iter().enumerate() {
            match access.kind {
                AccessKind::Depth => {
                    let desc = self.graph.resources()[access.resource.index()].desc;
                    for plane in desc.texture().map_or(vec![], |t| spec::planes_of(t.format, access.range.aspect)) {
                        let digest = if plane == Aspect::Depth { with_arguments } else { digest };
                        self.paint(Some(pass), row, access, plane, salt, digest);
                    }
                }
                AccessKind::StorageWrite => {
                    let digest = if compute { with_arguments } else { digest };
                    match self.graph.resources()[access.resource.index()].desc {
                        Desc::Texture(_) => self.paint(None, row, access, Aspect::All, salt, digest),
                        Desc::Buffer(_) => self.write(row, access, salt, digest),
                    }
                }
                _ => {}
            }
        }
        // Resolves run after all drawing. All samples of a texel are equal here, so that every mode gives the same
        // result; the test `resolve` covers the modes.
        for access in accesses.iter().filter(|a| a.kind == AccessKind::Resolve) {
            let depth = access.slot == Access::DEPTH;
            let from = accesses.iter().find(|a| match a.kind {
                AccessKind::Color => a.slot == access.slot,
                kind => kind.is_depth() && depth,
            });
            if let Some(from) = from {
                let plane = if depth { Aspect::Depth } else { Aspect::All };
                let spot = |a: &Access| part_index(self.graph, a.resource, a.range.mip, a.range.layer, plane);
                let (source, target) = (spot(from), spot(access));
                let part = self.part(from.resource, source).clone();
                *self.part_mut(access.resource, target) = part;
            }
        }
        digest
    }

    pub fn part(&self, resource: ResourceId, index: usize) -> &Part {
        match &self.contents[resource.index()] {
            Contents::Texture(parts) => &parts[index],
            Contents::Buffer(_) => &None,
        }
    }

    pub fn part_mut(&mut self, resource: ResourceId, index: usize) -> &mut Part {
        match &mut self.contents[resource.index()] {
            Contents::Texture(parts) => &mut parts[index],
            Contents::Buffer(_) => panic!("a texture was expected"),
        }
    }

    pub fn bytes(&self, resource: ResourceId) -> Option<&[u8]> {
        match &self.contents[resource.index()] {
            Contents::Buffer(bytes) => bytes.as_deref(),
            Contents::Texture(_) => None,
        }
    }

    /// Returns the digest of everything that the pass reads.
    fn digest(&self, pass: PassId, salt: u32) -> Option<u32> {
        let accesses = self.graph.accesses_of(pass);
        let mut hash = salt;
        for input in spec::inputs(self.graph, pass, self.pixelwise) {
            let access = &accesses[input.access];
            hash = match input.class {
                Class::Texture(_, samples) => {
                    let mips = spec::mips(self.graph, access);
                    self.fold_texture(hash, access, input.plane, mips, if samples { 4 } else { 0 })?
                }
                Class::Storage(_) => self.fold_texture(hash, access, input.plane, input.mip..input.mip + 1, 0)?,
                Class::Buffer => fold_words(hash, self.bytes(access.resource)?),
                Class::Uniform => {
                    let first = input.offset as usize;
                    fold_words(hash, &self.bytes(access.resource)?[first..first + spec::UNIFORM_BYTES as usize])
                }
                Class::SamePixel(..) | Class::InTile(..) => hash,
            };
        }
        Some(mix(hash, 0))
    }

    /// Adds all layers of some levels to a digest. With `samples`, adds the one layer once per sample.
    fn fold_texture(
        &self,
        mut hash: u32,
        access: &Access,
        plane: Aspect,
        mips: std::ops::Range<u8>,
        samples: u32,
    ) -> Option<u32> {
        let layers: Vec<u16> = spec::layers(self.graph, access).collect();
        for (level, mip) in (0u32..).zip(mips) {
            let repeated = if samples > 0 { vec![layers[0]; samples as usize] } else { layers.clone() };
            for (index, layer) in (0u32..).zip(repeated) {
                let at = part_index(self.graph, access.resource, mip, layer, plane);
                let texels = self.part(access.resource, at).as_ref()?;
                hash = fold(hash, level * 256 + index + 1);
                for number in 0..LOOKS {
                    let texel = texels[look(number, texels.len() as u32) as usize];
                    hash = texel.into_iter().fold(hash, fold);
                }
            }
        }
        Some(hash)
    }

    /// Returns the digest of indirect work. Each triangle covers the whole target, so the last triangle of the last
    /// instance remains.
    fn with_arguments(&self, pass: PassId, digest: Option<u32>, compute: bool) -> Option<u32> {
        let Some(row) = spec::indirect(self.graph, pass) else { return digest };
        let bytes = self.bytes(self.graph.accesses_of(pass)[row].resource)?;
        let word = |i: usize| u32::from_le_bytes([bytes[4 * i], bytes[4 * i + 1], bytes[4 * i + 2], bytes[4 * i + 3]]);
        if compute {
            return Some(mix(mix(mix(digest?, word(0)), word(1)), word(2)));
        }
        let [vertices, instances, first_vertex, first_instance] = [word(0), word(1), word(2), word(3)];
        let last_instance = first_instance + instances - 1;
        let first_of_last_triangle = first_vertex + (vertices / 3 - 1) * 3;
        Some(mix(mix(digest?, last_instance), first_of_last_triangle))
    }

    /// Returns the texels that a pass reads at the same pixel, of the layer at `index`; `None` if some are undefined.
    fn same_pixel(&self, pass: Option<PassId>, index: u16) -> Option<Vec<Vec<Texel>>> {
        let Some(pass) = pass else { return Some(Vec::new()) };
        let inputs = spec::inputs(self.graph, pass, self.pixelwise).into_iter();
        let texels = inputs.filter(|input| matches!(input.class, Class::SamePixel(..))).map(|input| {
            let access = &self.graph.accesses_of(pass)[input.access];
            let layers = spec::layers(self.graph, access);
            let layer = (access.range.layer + index).min(layers.end - 1);
            let at = part_index(self.graph, access.resource, access.range.mip, layer, input.plane);
            self.part(access.resource, at).clone()
        });
        texels.collect()
    }

    /// Writes every part of an access. Texels depend on the same-pixel reads of `pass`.
    fn paint(
        &mut self,
        pass: Option<PassId>,
        row: usize,
        access: &Access,
        plane: Aspect,
        salt: u32,
        digest: Option<u32>,
    ) {
        let Desc::Texture(desc) = self.graph.resources()[access.resource.index()].desc else { return };
        let coding = coding(desc.format, plane);
        let index = spec::plane_index(desc.format, plane);
        for mip in spec::mips(self.graph, access) {
            for layer in spec::layers(self.graph, access) {
                let same = self.same_pixel(pass, layer - access.range.layer);
                let tag = spec::tag(row, index, mip) + u32::from(layer);
                let [width, height] = spec::texels(self.graph, access.resource, mip);
                let at = part_index(self.graph, access.resource, mip, layer, plane);
                let cleared = if access.mode == Mode::Clear {
                    Some(vec![coding.cleared(self.graph.clears()[access.clear as usize]); (width * height) as usize])
                } else {
                    None
                };
                let part = self.part_mut(access.resource, at);
                let old = match spec::paint(access.mode) {
                    Paint::All => Some(vec![[0; 4]; (width * height) as usize]),
                    Paint::Over => part.take(),
                    Paint::Cleared => cleared,
                };
                *part = old.zip(digest).zip(same).map(|((mut texels, digest), same)| {
                    for ((at, texel), (x, y)) in texels.iter_mut().enumerate().zip(places(width, height)) {
                        if access.mode == Mode::Overwrite || chosen(salt, tag, x, y) {
                            *texel = coding.painted(with_same(texel_hash(digest, tag, x, y), &same, at));
                        }
                    }
                    texels
                });
            }
        }
    }

    /// Draws a color attachment again where read-only depth and stencil tests pass.
    fn paint_where_tested(&mut self, pass: PassId, row: usize, access: &Access, salt: u32, digest: Option<u32>) {
        let Some(tested) = spec::tested(self.graph, pass) else { return };
        let tested = &self.graph.accesses_of(pass)[tested];
        let Desc::Texture(depth) = self.graph.resources()[tested.resource.index()].desc else { return };
        let Desc::Texture(color) = self.graph.resources()[access.resource.index()].desc else { return };
        let coding = coding(color.format, Aspect::All);
        let layers = spec::layers(self.graph, access).zip(spec::layers(self.graph, tested));
        for (layer, tested_layer) in layers {
            for plane in spec::planes_of(depth.format, tested.range.aspect) {
                let at = part_index(self.graph, tested.resource, tested.range.mip, tested_layer, plane);
                let tests = self.part(tested.resource, at).clone();
                let same = self.same_pixel(Some(pass), layer - access.range.layer);
                let tag = spec::tag(row, 0, access.range.mip) + u32::from(layer);
                let [width, height] = spec::texels(self.graph, access.resource, access.range.mip);
                let at = part_index(self.graph, access.resource, access.range.mip, layer, Aspect::All);
                let part = self.part_mut(access.resource, at);
                let known = part.take().zip(tests).zip(digest).zip(same);
                *part = known.map(|(((mut texels, tests), digest), same)| {
                    let all = access.mode == Mode::Overwrite;
                    for (at, ((texel, test), (x, y))) in
                        texels.iter_mut().zip(tests).zip(places(width, height)).enumerate()
                    {
                        let (passed, mark) = match plane {
                            Aspect::Stencil => (test[0] == STENCIL_STEP, spec::STENCIL_PASSED),
                            // The tested depth lies between the codes 32767 and 32768.
                            _ => (test[0] < 32768, spec::DEPTH_PASSED),
                        };
                        if passed && (all || chosen(salt, tag, x, y)) {
                            *texel = coding.painted(with_same(texel_hash(digest, tag | mark, x, y), &same, at));
                        }
                    }
                    texels
                });
            }
        }
    }

    /// Writes the words of a buffer.
    fn write(&mut self, row: usize, access: &Access, salt: u32, digest: Option<u32>) {
        let Contents::Buffer(bytes) = &mut self.contents[access.resource.index()] else { return };
        let length = self.graph.resources()[access.resource.index()].desc.bytes(super::FRAME) as usize;
        let paint = spec::paint(access.mode);
        let old = if paint == Paint::Over { bytes.take() } else { Some(vec![0; length]) };
        let tag = spec::tag(row, 0, 0);
        *bytes = old.zip(digest).map(|(mut bytes, digest)| {
            for (index, stored) in (0u32..).zip(bytes.chunks_exact_mut(4)) {
                let written = match paint {
                    Paint::All => true,
                    Paint::Over => index >= 4 && chosen(salt, tag, index, 0),
                    Paint::Cleared => index < 4 || chosen(salt, tag, index, 0),
                };
                if written {
                    stored.copy_from_slice(&word(digest, tag, index).to_le_bytes());
                }
            }
            bytes
        });
    }
}

/// Adds the texels of same-pixel reads to a hash.
fn with_same(hash: u32, same: &[Vec<Texel>], at: usize) -> u32 {
    same.iter().fold(hash, |hash, texels| texels[at].into_iter().fold(hash, fold))
}

/// Iterates over columns and rows, row by row.
pub fn places(width: u32, height: u32) -> impl Iterator<Item = (u32, u32)> {
    (0..height).flat_map(move |y| (0..width).map(move |x| (x, y)))
}

/// Adds words of a buffer to a digest.
fn fold_words(hash: u32, bytes: &[u8]) -> u32 {
    let words: Vec<u32> = bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
    (0..LOOKS).fold(hash, |hash, number| fold(hash, words[look(number, words.len() as u32) as usize]))
}
