//! The files that a run writes: checked before the work, put in place together after it.
//!
//! [`Outputs::add`] refuses, before anything is rendered, what cannot be written, what two outputs would share, and what the
//! run reads. [`Outputs::write`] makes the file beside its place. [`Outputs::commit`] writes through pipes and devices, then
//! gives every file its name; when anything fails, no file is changed.
//!
//! ```
//! use program::outputs::Outputs;
//! use std::path::Path;
//!
//! let folder = std::env::temp_dir();
//! let picture = folder.join("program-outputs-example.txt");
//! let mut outputs = Outputs::default();
//! outputs.add(&picture)?;
//! outputs.write(&picture, |file| file.write_all(b"light"))?;
//! assert!(!picture.exists(), "it is made beside its place");
//! outputs.commit()?;
//! assert_eq!(std::fs::read(&picture).unwrap(), b"light");
//! # std::fs::remove_file(&picture).unwrap();
//! # Ok::<(), program::outputs::OutputError>(())
//! ```

use crate::part::Part;
use crate::place;
use crate::target::{Target, same};
use std::fmt::Display;
use std::fs;
use std::io::{self, BufWriter, Cursor, Seek, Write};
use std::path::{Path, PathBuf};

/// What an output is written into: all encoders of this repository can.
pub trait Sink: Write + Seek {}

impl<T: Write + Seek> Sink for T {}

/// An output cannot be written.
#[derive(thiserror::Error)]
pub enum OutputError {
    /// The system refuses.
    #[error("{}: cannot be written: {error}", path.display())]
    File {
        /// The output.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// The encoder refuses, or the disk is full.
    #[error("{}: cannot be written: {reason}", path.display())]
    Encode {
        /// The output.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// The run reads the file.
    #[error("{}: it is read and would be written over; choose another name", path.display())]
    Read {
        /// The output.
        path: PathBuf,
    },
    /// Two outputs are one file.
    #[error("{}: two files would be written under this name; name them apart", path.display())]
    Twice {
        /// The second of them.
        path: PathBuf,
    },
}

impl std::fmt::Debug for OutputError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        Display::fmt(self, f)
    }
}

/// The files that a run writes.
#[derive(Debug, Default)]
pub struct Outputs {
    files: Vec<Output>,
    /// Files that are read, behind all links.
    read: Vec<PathBuf>,
}

#[derive(Debug)]
struct Output {
    /// As it was given.
    path: PathBuf,
    target: Target,
    content: Content,
    written: bool,
}

#[derive(Debug)]
enum Content {
    /// Beside its place.
    Part(Part),
    /// What goes through a pipe or device, which takes it only when all is well.
    Memory(Cursor<Vec<u8>>),
}

impl Outputs {
    /// A file that the run reads: no output may be written over it. One that is not there is left to whoever reads it.
    ///
    /// # Errors
    /// [`OutputError::Read`], when an output that was added is this file.
    pub fn reads(&mut self, path: &Path) -> Result<(), OutputError> {
        let Ok(read) = path.canonicalize() else { return Ok(()) };
        let over = self.files.iter().find(|file| matches!(&file.target, Target::File(place) if same(place, &read)));
        if let Some(Output { path, .. }) = over {
            return Err(OutputError::Read { path: path.clone() });
        }
        self.read.push(read);
        Ok(())
    }

    /// A file that will be written.
    ///
    /// # Errors
    /// [`OutputError`]: it cannot be written, it is read, or it was added before.
    pub fn add(&mut self, path: &Path) -> Result<(), OutputError> {
        let failed = |error| OutputError::File { path: path.into(), error };
        let target = Target::find(path).map_err(failed)?;
        if self.files.iter().any(|file| file.target.is(&target)) {
            return Err(OutputError::Twice { path: path.into() });
        }
        let content = match &target {
            Target::File(place) => {
                if self.read.iter().any(|read| same(read, place)) {
                    return Err(OutputError::Read { path: path.into() });
                }
                // A name that the system does not take is noticed here, too: nothing of it is in the part's.
                let folder = place.parent().unwrap_or(Path::new("."));
                Content::Part(Part::create(folder).map_err(failed)?)
            }
            Target::Output => {
                crate::print::divert();
                Content::Memory(Cursor::default())
            }
            _ => Content::Memory(Cursor::default()),
        };
        self.files.push(Output { path: path.into(), target, content, written: false });
        Ok(())
    }

    /// Makes the contents of an output, which is added if it was not.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn write<E: Display>(
        &mut self,
        path: &Path,
        fill: impl FnOnce(&mut dyn Sink) -> Result<(), E>,
    ) -> Result<(), OutputError> {
        let known = self.files.iter().position(|file| file.path == path && !file.written);
        let index = match known {
            Some(index) => index,
            None => {
                self.add(path)?;
                self.files.len() - 1
            }
        };
        let file = &mut self.files[index];
        let encode = |error: E| OutputError::Encode { path: path.into(), reason: error.to_string() };
        match &mut file.content {
            Content::Memory(bytes) => fill(bytes).map_err(encode)?,
            Content::Part(part) => {
                let mut to = BufWriter::new(&part.file);
                fill(&mut to).map_err(encode)?;
                to.flush().map_err(|error| OutputError::File { path: path.into(), error })?;
            }
        }
        file.written = true;
        Ok(())
    }

    /// Puts what was written in its place and returns the names. Pipes and devices come first: they may fail, while to
    /// give a file its name hardly can.
    ///
    /// # Errors
    /// [`OutputError`]: no file was replaced, and none is new.
    pub fn commit(self) -> Result<Vec<PathBuf>, OutputError> {
        let mut parts = Vec::new();
        let mut names = Vec::new();
        let mut through = Vec::new();
        for Output { path, target, content, written } in self.files {
            match (target, content) {
                _ if !written => {}
                (Target::File(place), Content::Part(part)) => parts.push((path.clone(), place, part)),
                (target, Content::Memory(bytes)) => through.push((path.clone(), target, bytes)),
                (..) => unreachable!("files are made in parts"),
            }
            if written {
                names.push(path);
            }
        }
        for (path, place, part) in &parts {
            let gone = !part.is_there() || place.is_dir();
            if gone {
                let error = io::Error::other("its place was removed or became a folder meanwhile");
                return Err(OutputError::File { path: path.clone(), error });
            }
        }
        for (path, mut target, bytes) in through {
            target.write(bytes.get_ref()).map_err(|error| OutputError::File { path, error })?;
        }
        let (paths, parts): (Vec<_>, _) = parts.into_iter().map(|(path, place, part)| (path, (place, part))).unzip();
        place::all(parts).map_err(|(index, error)| OutputError::File { path: paths[index].clone(), error })?;
        Ok(names)
    }

    /// Writes one file, whole or not at all.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn one(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
        Self::one_beside(path, bytes, &[])
    }

    /// The same, but not over one of the files that were read.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn one_beside(path: &Path, bytes: &[u8], read: &[PathBuf]) -> Result<(), OutputError> {
        let mut outputs = Self::default();
        for file in read {
            outputs.reads(file)?;
        }
        outputs.write(path, |file| file.write_all(bytes))?;
        outputs.commit().map(drop)
    }
}

/// Whether files can be written into a folder.
///
/// # Errors
/// [`OutputError::File`], when they cannot.
pub fn check_folder(folder: &Path) -> Result<(), OutputError> {
    let failed = |error| OutputError::File { path: folder.into(), error };
    if !folder.is_dir() {
        return Err(failed(io::Error::other(format!("there is no folder {}", folder.display()))));
    }
    Part::create(folder).map(drop).map_err(failed)
}

/// Whether what stands at a path is written through, such as a pipe or a device; a name beside it means nothing.
#[must_use]
pub fn is_special(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|about| !about.is_file() && !about.is_dir())
}
