//! Output files of a run, checked before the work and renamed into place together after it.
//!
//! Before the work, [`Outputs::add`] rejects paths that are not writable, that two outputs share, or that the run
//! reads. [`Outputs::write`] writes a temporary file in the same folder. [`Outputs::commit`] writes through pipes and
//! devices, then renames every file. If anything fails, no file changes.
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
//! assert!(!picture.exists(), "the file appears only at commit");
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

/// Destination of the bytes of an output. Every encoder of this repository writes to it.
pub trait Sink: Write + Seek {}

impl<T: Write + Seek> Sink for T {}

/// Error of an output file.
#[derive(thiserror::Error)]
pub enum OutputError {
    /// The system refuses the file.
    #[error("{}: cannot be written: {error}", path.display())]
    File {
        /// Path of the output.
        path: PathBuf,
        /// Reason of the system.
        error: io::Error,
    },
    /// The encoder failed, or the disk is full.
    #[error("{}: cannot be written: {reason}", path.display())]
    Encode {
        /// Path of the output.
        path: PathBuf,
        /// Reason of the encoder.
        reason: String,
    },
    /// The run reads the file.
    #[error("{}: it is an input of this run; choose another name", path.display())]
    Read {
        /// Path of the output.
        path: PathBuf,
    },
    /// Two outputs are one file.
    #[error("{}: two outputs have this name; rename one", path.display())]
    Twice {
        /// Path of the second output.
        path: PathBuf,
    },
}

impl std::fmt::Debug for OutputError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        Display::fmt(self, f)
    }
}

/// Output files of a run.
#[derive(Debug, Default)]
pub struct Outputs {
    files: Vec<Output>,
    /// Input files, with all links resolved.
    read: Vec<PathBuf>,
}

#[derive(Debug)]
struct Output {
    /// Path as the caller specified it.
    path: PathBuf,
    target: Target,
    content: Content,
    written: bool,
}

#[derive(Debug)]
enum Content {
    /// Temporary file in the same folder.
    Part(Part),
    /// Bytes for a pipe or a device, written at commit.
    Memory(Cursor<Vec<u8>>),
}

impl Outputs {
    /// Registers an input file, which no output may overwrite. A missing file is ignored; reading it fails later.
    ///
    /// # Errors
    /// [`OutputError::Read`] if a registered output is this file.
    pub fn reads(&mut self, path: &Path) -> Result<(), OutputError> {
        let Ok(read) = path.canonicalize() else { return Ok(()) };
        let over = self.files.iter().find(|file| matches!(&file.target, Target::File(place) if same(place, &read)));
        if let Some(Output { path, .. }) = over {
            return Err(OutputError::Read { path: path.clone() });
        }
        self.read.push(read);
        Ok(())
    }

    /// Registers an output file.
    ///
    /// # Errors
    /// [`OutputError`] if the path is not writable, is an input, or was registered before.
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
                // Also detects invalid names, which creating the temporary file would not.
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

    /// Writes the contents of an output, and registers it if necessary.
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

    /// Renames all written files into place and returns their paths.
    ///
    /// Pipes and devices come first, because they may fail while a rename hardly can.
    ///
    /// # Errors
    /// [`OutputError`]. In that case no file was replaced or created.
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
                let error = io::Error::other("its folder was removed, or it became a folder, during the run");
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

    /// Writes one file, completely or not at all.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn one(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
        Self::one_beside(path, bytes, &[])
    }

    /// Writes one file, completely or not at all, and never over one of the input files `read`.
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

/// Checks that files can be created in a folder.
///
/// # Errors
/// [`OutputError::File`] if they cannot.
pub fn check_folder(folder: &Path) -> Result<(), OutputError> {
    let failed = |error| OutputError::File { path: folder.into(), error };
    if !folder.is_dir() {
        return Err(failed(io::Error::other(format!("folder {} does not exist", folder.display()))));
    }
    Part::create(folder).map(drop).map_err(failed)
}

/// Returns whether a path is a pipe, a device or another special file, which is written through instead of replaced.
#[must_use]
pub fn is_special(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|about| !about.is_file() && !about.is_dir())
}
