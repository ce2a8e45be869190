//! Parsed file with its bytes, the input of all parts of the importer.

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

/// The document, its buffers, and the memory charged so far.
pub(super) struct Source<'a> {
    /// Path for messages and for relative paths.
    pub file: &'a Path,
    /// The JSON as the schema types have it. Indices in it are unchecked.
    pub root: &'a Root,
    /// The document as JSON, for extensions that the schema types do not cover.
    pub json: &'a Value,
    /// Document of `root` and `json`.
    pub document: &'a Document,
    /// Bytes of each buffer, at least as long as the JSON states.
    pub buffers: Vec<Buffer<'a>>,
    /// Decoded bytes of each compressed buffer view, by index; they replace those in its buffer.
    pub views: BTreeMap<usize, Vec<u8>>,
    /// Decoded meshes that the scene draws, by buffer view.
    pub meshes: BTreeMap<usize, PackedMesh>,
    /// Memory budget of all decoded data.
    pub memory: &'a Memory,
    allow_outside: bool,
    /// True if triangles keep the order of the file.
    pub keep_order: bool,
    /// Material extensions that animations change, as messages name them: `material 3: KHR_materials_sheen`.
    animated: BTreeSet<String>,
    /// Block formats that the device can sample.
    pub block_formats: BlockFormats,
    /// For each image of the file, the first identical one.
    images: Vec<usize>,
    /// Bytes charged for the scene.
    kept_bytes: Cell<u64>,
    /// Bytes charged for encoded data, released with this object.
    file_bytes: Cell<u64>,
    files: RefCell<BTreeSet<PathBuf>>,
}

/// Bytes of a buffer.
pub(super) enum Buffer<'a> {
    /// Bytes of the file, a data URI or another file.
    Bytes(Cow<'a, [u8]>),
    /// A buffer with neither a URI nor a binary chunk, which an extension or application may fill (section 3.6.1.1).
    /// Zeros are allocated on first use.
    Absent(OnceCell<Vec<u8>>),
}

impl Buffer<'_> {
    /// Returns true if zeros were read from an absent buffer.
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

    /// Returns an error at a place in this file.
    pub fn malformed(&self, at: &str, reason: impl Into<String>) -> SceneError {
        SceneError::malformed(self.file, at, reason)
    }

    /// Returns the error of a file referenced by this one. If the file is missing, the error suggests a file whose name
    /// differs in letter case.
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

    /// Returns an error about an exceeded limit.
    pub fn too_large(&self, what: Quantity, value: u64, limit: u64) -> SceneError {
        SceneError::TooLarge { file: self.file.into(), what, value, limit }
    }

    /// Returns the first identical image of the file; identical images are decoded once.
    pub fn same_image(&self, image: usize) -> usize {
        self.images[image]
    }

    /// Returns true if an animation changes a property of the material extension at a place.
    pub fn is_animated(&self, at: &str) -> bool {
        self.animated.contains(at)
    }

    /// Resolves the URI at a place.
    pub fn resolve(&self, at: &str, uri: &str) -> Result<Resource, SceneError> {
        resolve(self.file, at, uri, self.allow_outside)
    }

    /// Records a file that was read.
    pub fn note_file(&self, file: &Path) {
        self.files.borrow_mut().insert(file.into());
    }

    /// Returns the files that were read, sorted by name.
    pub fn files(&self) -> Vec<PathBuf> {
        self.files.borrow().iter().cloned().collect()
    }

    /// Charges memory for a part of the scene.
    pub fn keep(&self, bytes: u64) -> Result<(), OverBudget> {
        self.memory.keep(bytes)?;
        self.kept_bytes.set(self.kept_bytes.get() + bytes);
        Ok(())
    }

    /// Charges memory for bytes that are dropped after decoding.
    pub fn keep_file(&self, at: &str, bytes: u64) -> Result<(), SceneError> {
        self.memory.keep(bytes).map_err(|budget| self.over(at, budget))?;
        self.file_bytes.set(self.file_bytes.get() + bytes);
        Ok(())
    }

    /// Charges memory for vertices before they are decoded. Accessors may state any count without bytes, and views may
    /// overlap, so the file size is no bound.
    pub fn charge(&self, bytes: u64) -> Result<(), SceneError> {
        self.keep(bytes).map_err(|budget| self.over("vertices", budget))
    }

    /// Returns an error about an exceeded memory budget.
    pub fn over(&self, at: &str, budget: OverBudget) -> SceneError {
        SceneError::Memory { file: self.file.into(), at: at.into(), budget }
    }

    /// Marks the scene as complete: its memory stays charged.
    pub fn finish(&self) {
        self.kept_bytes.set(0);
    }

    /// Returns the bytes of a buffer view and its stride, if stated.
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

    /// Returns a range of a buffer. `name` is the object that states the range.
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
            // Every other buffer has all the bytes it states.
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

/// Returns, for each image, the first with the same buffer view or the same URI; a leading `./` is ignored.
fn first_of_each(images: &[gltf_json::Image]) -> Vec<usize> {
    let mut first: BTreeMap<(Option<usize>, PathBuf), usize> = BTreeMap::new();
    let number = |(index, image): (usize, &gltf_json::Image)| {
        let view = image.buffer_view.map(|view| view.value());
        let path = |uri: &String| Path::new(uri).components().filter(|part| *part != Component::CurDir).collect();
        match (view, image.uri.as_ref().map(path)) {
            // An error only if the image is used.
            (None, None) => index,
            (view, path) => *first.entry((view, path.unwrap_or_default())).or_insert(index),
        }
    };
    images.iter().enumerate().map(number).collect()
}

/// Returns `length` bytes from `start`, if the slice contains them. Accepts untrusted 64-bit numbers.
pub(super) fn slice(data: &[u8], start: u64, length: u64) -> Option<&[u8]> {
    let end = start.checked_add(length)?;
    data.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?)
}

/// Returns the reason for an out-of-range index.
pub(super) fn beyond<T>(what: &str, index: usize, all: &[T]) -> String {
    format!("names {what} {index}, but there are {}", all.len())
}

/// A repairable fault of a file. All faults of one kind make one warning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Repair {
    /// Normals that are not finite or have no length.
    Normals,
    /// Tangents that are not finite, have no length or are parallel to the normal.
    Tangents,
    /// Texture coordinates that are not finite.
    TexCoords,
    /// Vertex colors that are not finite.
    Colors,
    /// Skin weights that are negative, not finite or do not add up to 1.
    Weights,
    /// Degenerate triangles in a mesh without normals.
    Triangles,
    /// Trailing indices that form no complete triangle or line.
    Corners,
    /// Absent buffers that are read.
    Absent,
    /// Unusable or unknown members of `extras.framegraph`.
    Switches,
}

impl Repair {
    /// Describes the fault of `count` elements and its repair.
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
    /// First place, for messages.
    first: String,
    /// Number of places.
    places: usize,
    /// Number of elements over all places.
    count: usize,
}

/// Warnings of one load, without duplicates.
pub(super) struct Warnings {
    file: String,
    lines: Vec<String>,
    repairs: BTreeMap<Repair, Repaired>,
}

impl Warnings {
    pub fn new(file: &Path) -> Self {
        Self { file: one_line(&file.display().to_string()), lines: Vec::new(), repairs: BTreeMap::new() }
    }

    /// Adds `text` with the file's name unless it is a duplicate. Only the first 100 warnings are kept.
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

    /// Counts `count` repaired elements at a place; zero adds no warning.
    pub fn count(&mut self, repair: Repair, at: &str, count: usize) {
        if count == 0 {
            return;
        }
        let new = || Repaired { first: at.into(), places: 0, count: 0 };
        let repaired = self.repairs.entry(repair).or_insert_with(new);
        repaired.places += 1;
        repaired.count += count;
    }

    /// Returns all warnings, followed by one for each kind of repair.
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
