//! Disk cache of prefiltered light.
//!
//! The name of an entry is a hash of everything that determines its content: texels, settings, tables, and the text of
//! the shader and of its library. An entry is therefore never stale. Unused entries stay until the folder is emptied,
//! which is safe at any time.
//!
//! ```text
//! 0   8  "fg-cache"           24  16  key
//! 8   4  version of the file  40   8  length of the payload
//! 12  4  kind of the entry    48   8  checksum of everything else
//! 16  8  zero                 56   …  payload
//! ```
//!
//! Entries are written to a temporary file and renamed. A truncated, damaged or outdated file causes a warning and is
//! rewritten. A folder that cannot be written causes a warning. Neither is an error.

use std::ffi::OsString;
use std::hash::Hasher;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use siphasher::sip::SipHasher13;
use siphasher::sip128::{Hasher128, SipHasher13 as SipHasher13x128};

use super::entry::{EntryError, decode_dfg, decode_light};
use super::texture::CubeShape;
use framegraph::Format;
use framegraph_scene::error::one_line;
use framegraph_shaders::{Source, library};
use framegraph_wgpu::Gpu;

/// Version of the file layout. The meaning of the payload is part of the key.
const VERSION: u32 = 1;
const MAGIC: &[u8; 8] = b"fg-cache";
const HEADER_BYTES: usize = 56;
const CHECKSUM: std::ops::Range<usize> = 48..56;

/// Folder that keeps prefiltered light between runs of a program, or no folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cache {
    folder: Option<PathBuf>,
    /// True if a folder was requested but the environment names none, which each use reports as a warning.
    homeless: bool,
}

impl Default for Cache {
    /// Returns [`Cache::user`].
    fn default() -> Self {
        Self::user()
    }
}

impl Cache {
    /// Returns the user's cache: `framegraph/ibl` in `XDG_CACHE_HOME`, else in `.cache` of the home folder, else (on
    /// Windows) in `LOCALAPPDATA`. If none exists, nothing is kept, and each use causes a warning.
    #[must_use]
    pub fn user() -> Self {
        let variable = |name: &str| std::env::var_os(name);
        match user_folder(variable) {
            Some(folder) => Self::at(folder),
            None => Self { folder: None, homeless: true },
        }
    }

    /// Returns the cache that the variable `FRAMEGRAPH_LIGHT_CACHE` selects: `off` for [`Cache::off`], otherwise a
    /// folder. If it is not set, returns [`Cache::user`].
    #[must_use]
    pub fn from_env() -> Self {
        Self::chosen(std::env::var_os("FRAMEGRAPH_LIGHT_CACHE"))
    }

    fn chosen(value: Option<OsString>) -> Self {
        match value.filter(|value| !value.is_empty()) {
            None => Self::user(),
            Some(value) if value == "off" => Self::off(),
            Some(folder) => Self::at(folder),
        }
    }

    /// Returns a cache in this folder, which is created when first needed.
    #[must_use]
    pub fn at(folder: impl Into<PathBuf>) -> Self {
        Self { folder: Some(folder.into()), homeless: false }
    }

    /// Returns a disabled cache: nothing is read or written.
    #[must_use]
    pub fn off() -> Self {
        Self { folder: None, homeless: false }
    }

    /// Returns the folder, if any.
    #[must_use]
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// Returns true if results of `gpu` are kept: there is a folder, and the device draws.
    pub(super) fn keeps_results_of(&self, gpu: &Gpu) -> bool {
        self.folder.is_some() && gpu.info().backend != wgpu::Backend::Noop
    }

    fn path(&self, key: Key) -> Option<PathBuf> {
        self.folder.as_ref().map(|folder| folder.join(format!("{:032x}.light", key.finish())))
    }

    /// Decodes the payload of `key`, if the entry exists and is valid. Problems are added to `warnings`.
    pub(super) fn load<T>(
        &self,
        key: Key,
        kind: u32,
        warnings: &mut Vec<String>,
        decode: impl FnOnce(&[u8]) -> Result<T, EntryError>,
    ) -> Option<T> {
        if self.homeless {
            warnings.push("neither XDG_CACHE_HOME nor HOME names a folder to keep computed light in".into());
        }
        let path = self.path(key)?;
        let file = match read_file(&path) {
            Ok(file) => file,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return None,
            Err(error) => {
                warnings.push(format!("{}: cannot be read: {error}; it is computed anew", shown(&path)));
                return None;
            }
        };
        let decoded = payload(&file, key.finish(), kind).and_then(decode);
        decoded.map_err(|e| warnings.push(format!("{}: {e}; the cache entry is computed anew", shown(&path)))).ok()
    }

    /// Stores a payload under `key`. A failure is added to `warnings`.
    pub(super) fn store(&self, key: Key, kind: u32, payload: &[u8], warnings: &mut Vec<String>) {
        let (Some(folder), Some(path)) = (&self.folder, self.path(key)) else { return };
        if let Err(error) = write_whole(&path, &file(payload, key.finish(), kind)) {
            warnings.push(format!(
                "{}: nothing can be kept there: {error}; light is computed anew at each start (choose another folder with \
                 FRAMEGRAPH_LIGHT_CACHE, or `off`)",
                shown(folder)
            ));
        }
    }
}

/// Reads a regular file; fails for anything else.
fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    if std::fs::metadata(path)?.is_file() {
        std::fs::read(path)
    } else {
        Err(io::Error::other("it is no regular file"))
    }
}

fn shown(path: &Path) -> String {
    one_line(&path.display().to_string())
}

/// Returns the folder of [`Cache::user`]; `variable` reads the environment.
fn user_folder(variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    // The XDG specification ignores relative paths.
    let absolute = |name: &str| variable(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let base = absolute("XDG_CACHE_HOME")
        .or_else(|| absolute("HOME").map(|home| home.join(".cache")))
        .or_else(|| absolute("LOCALAPPDATA"))?;
    Some(base.join("framegraph").join("ibl"))
}

/// Returns the file contents of an entry.
fn file(payload: &[u8], key: u128, kind: u32) -> Vec<u8> {
    let mut file = Vec::with_capacity(HEADER_BYTES + payload.len());
    file.extend(MAGIC);
    file.extend(VERSION.to_le_bytes());
    file.extend(kind.to_le_bytes());
    file.extend([0; 8]);
    file.extend(key.to_le_bytes());
    file.extend((payload.len() as u64).to_le_bytes());
    file.extend([0; 8]);
    file.extend(payload);
    let sum = checksum(&file);
    file[CHECKSUM].copy_from_slice(&sum.to_le_bytes());
    file
}

/// Returns the payload of a file, which must be of this entry.
fn payload(file: &[u8], key: u128, kind: u32) -> Result<&[u8], EntryError> {
    let (header, payload) = file.split_at_checked(HEADER_BYTES).ok_or(EntryError::CutShort)?;
    if header[..8] != *MAGIC {
        return Err(EntryError::Magic);
    }
    if header[8..12] != VERSION.to_le_bytes() {
        return Err(EntryError::Version);
    }
    if header[40..48] != (payload.len() as u64).to_le_bytes() {
        return Err(EntryError::CutShort);
    }
    if header[CHECKSUM] != checksum(file).to_le_bytes() {
        return Err(EntryError::Checksum);
    }
    if header[12..16] != kind.to_le_bytes() || header[24..40] != key.to_le_bytes() {
        return Err(EntryError::Name);
    }
    Ok(payload)
}

/// Decodes bytes as a cache entry, and as the payload of light and of a small table, ignoring the header. Returns true
/// if any of them is valid. Never panics; for fuzzing.
#[doc(hidden)]
#[must_use]
pub fn examine(bytes: &[u8]) -> bool {
    let word = |at: usize, count: usize| bytes.get(at..at + count).unwrap_or_default();
    let kind = <[u8; 4]>::try_from(word(12, 4)).map_or(0, u32::from_le_bytes);
    let key = <[u8; 16]>::try_from(word(24, 16)).map_or(0, u128::from_le_bytes);
    let shape = CubeShape { texels: 4, levels: 2, format: Format::Rg11b10Ufloat };
    let of_payload = |payload: &[u8]| decode_light(payload, &shape).is_ok() || decode_dfg(payload, 4).is_ok();
    let whole = payload(bytes, key, kind).is_ok_and(of_payload);
    whole | bytes.get(HEADER_BYTES..).is_some_and(of_payload)
}

/// Returns SipHash-1-3 of everything except the checksum.
fn checksum(file: &[u8]) -> u64 {
    let mut hasher = SipHasher13::new();
    hasher.write(&file[..CHECKSUM.start]);
    hasher.write(&file[CHECKSUM.end..]);
    hasher.finish()
}

/// Writes a temporary file, then renames it to the target.
fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    static WRITES: AtomicU32 = AtomicU32::new(0);
    let folder = path.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder)?;
    sweep(folder);
    let part = path.with_extension(format!("{}-{}.part", std::process::id(), WRITES.fetch_add(1, Ordering::Relaxed)));
    let write = || {
        let mut file = std::fs::File::create(&part)?;
        file.write_all(bytes)?;
        file.flush()?;
        std::fs::rename(&part, path)
    };
    let written = write();
    if written.is_err() {
        // The first error is the one to report; a part that cannot be removed was most likely never made.
        drop(std::fs::remove_file(&part));
    }
    written
}

/// Maximum time to write an entry. Older temporary files were left by killed programs.
const STALE: Duration = Duration::from_secs(600);

/// Removes temporary files of killed programs, as far as possible.
fn sweep(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let is_part = entry.path().extension().is_some_and(|ending| ending == "part");
        let age = entry.metadata().and_then(|about| about.modified()).ok().and_then(|time| time.elapsed().ok());
        if is_part && age.is_some_and(|age| age > STALE) {
            drop(std::fs::remove_file(entry.path()));
        }
    }
}

/// Key of a cache entry: 128 bits of SipHash over everything that determines its content.
#[derive(Clone, Copy)]
pub(super) struct Key(SipHasher13x128);

impl Key {
    /// Starts the key of an entry that an embedded pass computes, with the text of the pass and of the whole library.
    /// `what` separates kinds of entries.
    pub fn of(what: &str, pass: &str) -> Self {
        let read = |source: &Source<'static>| library::in_use(source.path).map(|wgsl| Source { wgsl, ..*source });
        Self::made_by(what, pass, library::SOURCES.iter().filter_map(read))
    }

    fn made_by<'a>(what: &str, pass: &str, sources: impl Iterator<Item = Source<'a>>) -> Self {
        let mut key = Self(SipHasher13x128::new());
        key.add_text(what);
        for source in sources.filter(|source| source.path == pass || source.path.starts_with("lib/")) {
            key.add_text(source.path);
            key.add_text(source.wgsl);
        }
        key
    }

    /// Adds numbers and their count.
    pub fn add<T: bytemuck::NoUninit>(&mut self, numbers: &[T]) {
        let bytes: &[u8] = bytemuck::cast_slice(numbers);
        self.0.write(&(bytes.len() as u64).to_le_bytes());
        self.0.write(bytes);
    }

    /// Adds a text.
    pub fn add_text(&mut self, text: &str) {
        self.add(text.as_bytes());
    }

    pub fn finish(self) -> u128 {
        self.0.finish128().as_u128()
    }
}

#[cfg(test)]
mod tests;
