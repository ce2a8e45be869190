//! A parsed file with its bytes: what every part of the importer reads from.

use std::borrow::Cow;
use std::cell::{Cell, OnceCell, RefCell};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{Error, ErrorKind};
use std::path::{Component, Path, PathBuf};

use gltf_json::{Root, Value};

use super::channel_pointer::animated_extensions;
use super::document::Document;
use super::letter_case;
use super::packed::PackedMesh;
use super::uri::{Resource, resolve};
use crate::error::{Quantity, SceneError, one_line};
use crate::memory::{Memory, OverBudget};
use crate::options::LoadOptions;
use crate::texture::BlockFormats;

/// The document, its buffers, and how much memory was taken for what was made of them so far.
pub(super) struct Source<'a> {
    /// The file, for messages and for paths relative to it.
    pub file: &'a Path,
    /// The JSON as the schema types have it. Indices in it are unchecked.
    pub root: &'a Root,
    /// The JSON as it is, for extensions that the schema types leave out.
    pub json: &'a Value,
    /// The document that both are parts of.
    pub document: &'a Document,
    /// The bytes of each buffer, at least as long as the JSON says.
    pub buffers: Vec<Buffer<'a>>,
    /// The bytes of each compressed buffer view, by its index, which replace those in its buffer.
    pub views: BTreeMap<usize, Vec<u8>>,
    /// The compressed meshes that the scene draws, by their buffer views.
    pub meshes: BTreeMap<usize, PackedMesh>,
    /// The budget of everything that is decoded.
    pub memory: &'a Memory,
    allow_outside: bool,
    /// Triangles stay in the order of the file.
    pub keep_order: bool,
    /// Places of the material extensions that animations change, as messages name them: `material 3: KHR_materials_sheen`.
    animated: BTreeSet<String>,
    /// Formats of blocks that the device samples.
    pub block_formats: BlockFormats,
    /// For each image of the file the first that is the same.
    images: Vec<usize>,
    /// What was taken for the scene, which stays.
    kept_bytes: Cell<u64>,
    /// What was taken for encoded bytes, which go with this.
    file_bytes: Cell<u64>,
    files: RefCell<BTreeSet<PathBuf>>,
}

/// The bytes of a buffer.
pub(super) enum Buffer<'a> {
    /// Bytes of the file, a data URI or another file.
    Bytes(Cow<'a, [u8]>),
    /// A buffer with neither a URI nor a binary chunk, which an extension or application may fill (section 3.6.1.1).
    /// Zeros are made once it is read.
    Absent(OnceCell<Vec<u8>>),
}

impl Buffer<'_> {
    /// Returns whether zeros were read from an absent buffer.
    pub fn is_read_and_absent(&self) -> bool {
        matches!(self, Self::Absent(zeros) if zeros.get().is_some())
    }
}

impl<'a> Source<'a> {
    pub fn new(file: &'a Path, document: &'a Document, options: &'a LoadOptions) -> Self {
        let Document { root, json, .. } = document;
        Self {
            file,
            root,
            json,
            document,
            buffers: Vec::new(),
            views: BTreeMap::new(),
            meshes: BTreeMap::new(),
            memory: &options.memory,
            allow_outside: options.allow_outside,
            keep_order: options.keep_order,
            animated: animated_extensions(json),
            block_formats: options.block_formats,
            images: first_of_each(&root.images),
            kept_bytes: Cell::new(0),
            file_bytes: Cell::new(0),
            files: RefCell::default(),
        }
    }

    /// An error at a place in this file.
    pub fn malformed(&self, at: &str, reason: impl Into<String>) -> SceneError {
        SceneError::malformed(self.file, at, reason)
    }

    /// An error of a file that a place in this one names. For a missing file, the error names a file whose letters differ in
    /// case.
    pub fn named(&self, at: &str, error: SceneError) -> SceneError {
        let error = match error {
            SceneError::Read { file, source } if source.kind() == ErrorKind::NotFound => {
                let folder = self.file.parent().unwrap_or_else(|| Path::new(""));
                let source = match letter_case::candidate(folder, &file) {
                    None => source,
                    Some(path) => {
                        let path = one_line(&path.display().to_string());
                        let reason = format!("{source}; the folder has {path:?}, whose letters differ in case");
                        Error::new(ErrorKind::NotFound, reason)
                    }
                };
                SceneError::Read { file, source }
            }
            error => error,
        };
        SceneError::Named { file: self.file.into(), at: at.into(), error: Box::new(error) }
    }

    /// An error about something in this file that is over its limit.
    pub fn too_large(&self, what: Quantity, value: u64, limit: u64) -> SceneError {
        SceneError::TooLarge { file: self.file.into(), what, value, limit }
    }

    /// The first image of the file that has the bytes of this one: each is decoded once.
    pub fn same_image(&self, image: usize) -> usize {
        self.images[image]
    }

    /// Returns whether an animation changes a property of the material extension at a place.
    pub fn is_animated(&self, at: &str) -> bool {
        self.animated.contains(at)
    }

    /// What the URI of a place stands for.
    pub fn resolve(&self, at: &str, uri: &str) -> Result<Resource, SceneError> {
        resolve(self.file, at, uri, self.allow_outside)
    }

    /// Notes a file that was read.
    pub fn note_file(&self, file: &Path) {
        self.files.borrow_mut().insert(file.into());
    }

    /// The files that were read, in order of their names.
    pub fn files(&self) -> Vec<PathBuf> {
        self.files.borrow().iter().cloned().collect()
    }

    /// Takes memory for a part of the scene.
    pub fn keep(&self, bytes: u64) -> Result<(), OverBudget> {
        self.memory.keep(bytes)?;
        self.kept_bytes.set(self.kept_bytes.get() + bytes);
        Ok(())
    }

    /// Takes memory for bytes that are decoded and then dropped.
    pub fn keep_file(&self, at: &str, bytes: u64) -> Result<(), SceneError> {
        self.memory.keep(bytes).map_err(|budget| self.over(at, budget))?;
        self.file_bytes.set(self.file_bytes.get() + bytes);
        Ok(())
    }

    /// Takes memory for vertices about to be decoded. Accessors may claim any count without bytes behind them, and views
    /// may overlap, so the file's size bounds nothing.
    pub fn charge(&self, bytes: u64) -> Result<(), SceneError> {
        self.keep(bytes).map_err(|budget| self.over("vertices", budget))
    }

    /// An error about something that does not fit into the budget.
    pub fn over(&self, at: &str, budget: OverBudget) -> SceneError {
        SceneError::Memory { file: self.file.into(), at: at.into(), budget }
    }

    /// The scene is whole: what was taken for it stays taken.
    pub fn finish(&self) {
        self.kept_bytes.set(0);
    }

    /// The bytes of a buffer view and its stride, if it states one.
    pub fn view(&self, index: usize, at: &str) -> Result<(&[u8], Option<usize>), SceneError> {
        let views = &self.root.buffer_views;
        let view = views.get(index).ok_or_else(|| self.malformed(at, beyond("buffer view", index, views)))?;
        let stride = view.byte_stride.map(|s| s.0).filter(|s| *s > 0);
        if let Some(bytes) = self.views.get(&index) {
            return Ok((bytes, stride));
        }
        let start = view.byte_offset.map_or(0, |offset| offset.0);
        let name = format_args!("buffer view {index}");
        Ok((self.range(view.buffer.value(), start, view.byte_length.0, at, name)?, stride))
    }

    /// A range of a buffer. `name` names the object that states the range.
    pub fn range(
        &self,
        buffer: usize,
        start: u64,
        length: u64,
        at: &str,
        name: std::fmt::Arguments<'_>,
    ) -> Result<&[u8], SceneError> {
        let data =
            self.buffers.get(buffer).ok_or_else(|| self.malformed(at, beyond("buffer", buffer, &self.buffers)))?;
        let data = match data {
            Buffer::Bytes(bytes) => bytes.as_ref(),
            Buffer::Absent(zeros) => {
                let length = self.root.buffers[buffer].byte_length.0;
                if zeros.get().is_none() {
                    self.keep_file(&format!("buffer {buffer}"), length)?;
                }
                zeros.get_or_init(|| vec![0; length as usize]).as_slice()
            }
        };
        slice(data, start, length).ok_or_else(|| {
            // Every other buffer has the bytes that it promises.
            let is_placeholder = (data.len() as u64) < self.root.buffers[buffer].byte_length.0;
            self.malformed(
                at,
                if is_placeholder {
                    format!("{name} refers to buffer {buffer}, a fallback without data; only compressed views may")
                } else {
                    format!("{name} covers {length} bytes from {start}, but buffer {buffer} has {}", data.len())
                },
            )
        })
    }
}

impl Drop for Source<'_> {
    fn drop(&mut self) {
        self.memory.free(self.kept_bytes.get() + self.file_bytes.get());
    }
}

/// For each image the first with the same bytes: the same buffer view, or the same URI but for `./`.
fn first_of_each(images: &[gltf_json::Image]) -> Vec<usize> {
    let mut first: BTreeMap<(Option<usize>, PathBuf), usize> = BTreeMap::new();
    let number = |(index, image): (usize, &gltf_json::Image)| {
        let view = image.buffer_view.map(|view| view.value());
        let path = |uri: &String| Path::new(uri).components().filter(|part| *part != Component::CurDir).collect();
        match (view, image.uri.as_ref().map(path)) {
            // Neither is an error once the image is used.
            (None, None) => index,
            (view, path) => *first.entry((view, path.unwrap_or_default())).or_insert(index),
        }
    };
    images.iter().enumerate().map(number).collect()
}

/// `length` bytes from `start`, if the slice has them. Takes the file's 64-bit numbers as they are.
pub(super) fn slice(data: &[u8], start: u64, length: u64) -> Option<&[u8]> {
    let end = start.checked_add(length)?;
    data.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?)
}

/// The reason for an index that is too large.
pub(super) fn beyond<T>(what: &str, index: usize, all: &[T]) -> String {
    format!("names {what} {index}, but there are {}", all.len())
}

/// A fault of a file that the importer repairs. All of one kind are one warning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Repair {
    /// Normals that are not finite or have no length.
    Normals,
    /// Tangents that are not finite, have no length or lie along the normal.
    Tangents,
    /// Texture coordinates that are not finite.
    TexCoords,
    /// Vertex colors that are not finite.
    Colors,
    /// Skin weights that are negative, not finite or do not add up to 1.
    Weights,
    /// Triangles without area in a mesh without normals.
    Triangles,
    /// Corners at the end of a list that make no whole triangle or line.
    Corners,
    /// Absent buffers that are read.
    Absent,
    /// Unusable or unknown members of `extras.framegraph`.
    Switches,
}

impl Repair {
    /// Says what was wrong with `count` elements, and what the importer does.
    fn sentence(self, count: usize) -> String {
        match self {
            Self::Normals => format!("{count} normals have no direction; they were recomputed from the triangles"),
            Self::Tangents => format!("{count} unusable tangents were replaced"),
            Self::TexCoords => format!("{count} texture coordinates are not finite; (0, 0) is used"),
            Self::Colors => format!("{count} vertex colors are not finite; 0 is used for their channels"),
            Self::Weights => format!("the skin weights of {count} vertices do not add up to 1; they were normalized"),
            Self::Triangles => format!("{count} triangles without area were dropped"),
            Self::Corners => format!("{count} indices at the end make no whole triangle or line; they are left out"),
            Self::Absent => "the buffer has neither a URI nor a binary chunk; zeros are read from it".into(),
            Self::Switches => format!("{count} switches are unknown or out of range; they are ignored"),
        }
    }
}

/// Repairs of one kind.
struct Repaired {
    /// The first place, for messages.
    first: String,
    /// Number of places.
    places: usize,
    /// Number of elements over all places.
    count: usize,
}

/// Warnings of one load, each once.
pub(super) struct Warnings {
    file: String,
    lines: Vec<String>,
    repairs: BTreeMap<Repair, Repaired>,
}

impl Warnings {
    pub fn new(file: &Path) -> Self {
        Self { file: one_line(&file.display().to_string()), lines: Vec::new(), repairs: BTreeMap::new() }
    }

    /// Adds `text` after the file's name, unless it was said before. After 100 only their number
    /// would help, so no more are kept.
    pub fn push(&mut self, text: impl AsRef<str>) {
        const MOST: usize = 100;
        let line = format!("{}: {}", self.file, one_line(text.as_ref()));
        if self.lines.contains(&line) || self.lines.len() > MOST {
            return;
        }
        if self.lines.len() == MOST {
            self.lines.push(format!("{}: further warnings are left out", self.file));
        } else {
            self.lines.push(line);
        }
    }

    /// Counts `count` repaired elements at a place; none are no warning.
    pub fn count(&mut self, repair: Repair, at: &str, count: usize) {
        if count == 0 {
            return;
        }
        let new = || Repaired { first: at.into(), places: 0, count: 0 };
        let repaired = self.repairs.entry(repair).or_insert_with(new);
        repaired.places += 1;
        repaired.count += count;
    }

    /// Returns all warnings: one for each kind of repair behind the others.
    pub fn into_lines(mut self) -> Vec<String> {
        for (repair, Repaired { first, places, count }) in std::mem::take(&mut self.repairs) {
            let others = match places - 1 {
                0 => String::new(),
                1 => " and one other place".into(),
                others => format!(" and {others} other places"),
            };
            self.push(format!("{first}{others}: {}", repair.sentence(count)));
        }
        self.lines
    }
}
