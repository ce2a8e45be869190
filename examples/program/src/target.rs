//! Destination of an output: a regular file to create or replace, or a special file that is written through.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Kind of file at an output path.
#[derive(Debug)]
pub(crate) enum Target {
    /// Regular or missing file: the path with all links resolved.
    File(PathBuf),
    /// Open device.
    Device(File),
    /// Named pipe, opened when there are bytes to write.
    Pipe(PathBuf),
    /// The file that standard output refers to.
    Output,
    /// The file that standard error refers to.
    Error,
}

/// Maximum number of links to follow, as on Linux.
const MAX_LINKS: usize = 40;

impl Target {
    /// Determines the kind of a path without changing it.
    pub fn find(path: &Path) -> io::Result<Self> {
        let about = match fs::metadata(path) {
            Ok(about) => about,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return followed(path).map(Self::File),
            Err(error) => return Err(error),
        };
        if about.is_dir() {
            return Err(io::Error::other("it is a folder; name a file"));
        }
        if let Some(device) = device(path, &about)? {
            return Ok(device);
        }
        if let Some(stream) = standard(&about) {
            return Ok(stream);
        }
        if about.is_file() {
            // A read-only file must not be replaced either.
            OpenOptions::new().write(true).open(path)?;
            return followed(path).map(Self::File);
        }
        pipe(path, &about)
    }

    /// Returns whether both are one file or one pipe. A device may take several outputs in sequence.
    pub fn is(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::File(a), Self::File(b)) | (Self::Pipe(a), Self::Pipe(b)) => same(a, b),
            (Self::Output, Self::Output) | (Self::Error, Self::Error) => true,
            _ => false,
        }
    }

    /// Writes to a pipe, device or standard stream. A closed reader is not an error.
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        let all = |to: &mut dyn Write| to.write_all(bytes).and_then(|()| to.flush());
        let written = match self {
            Self::File(path) => unreachable!("{} is replaced, not written through", path.display()),
            Self::Device(file) => all(file),
            Self::Pipe(path) => open_pipe(path).and_then(|mut pipe| all(&mut pipe)),
            Self::Output => all(&mut io::stdout().lock()),
            Self::Error => all(&mut io::stderr().lock()),
        };
        match written {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            written => written,
        }
    }
}

/// Resolves all links of a path; the file itself may be missing.
fn followed(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MAX_LINKS {
        let name = path.file_name().ok_or_else(|| io::Error::other("the path names no file"))?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let folder = folder.canonicalize().map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => io::Error::other(format!("folder {} does not exist", folder.display())),
            _ => error,
        })?;
        let place = folder.join(name);
        match fs::symlink_metadata(&place) {
            Ok(about) if about.is_symlink() => path = folder.join(fs::read_link(&place)?),
            Ok(_) => return Ok(place),
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(place),
            Err(error) => return Err(error),
        }
    }
    Err(io::Error::other("its symbolic links form a cycle"))
}

/// Returns whether two resolved paths are the same file, also under different names (hard links).
pub(crate) fn same(a: &Path, b: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let id = |path: &Path| fs::metadata(path).ok().map(|about| (about.dev(), about.ino()));
        if let (Some(a), Some(b)) = (id(a), id(b)) {
            return a == b;
        }
    }
    a == b
}

/// Opens a character device; `None` for any other file.
#[cfg(unix)]
fn device(path: &Path, about: &fs::Metadata) -> io::Result<Option<Target>> {
    use std::os::unix::fs::FileTypeExt;
    let is_device = about.file_type().is_char_device();
    is_device.then(|| OpenOptions::new().write(true).open(path).map(Target::Device)).transpose()
}

#[cfg(unix)]
fn pipe(path: &Path, about: &fs::Metadata) -> io::Result<Target> {
    use std::os::unix::fs::FileTypeExt;
    if about.file_type().is_fifo() {
        Ok(Target::Pipe(path.to_owned()))
    } else {
        Err(io::Error::other("it is not a file, pipe or character device"))
    }
}

#[cfg(not(unix))]
fn device(_: &Path, _: &fs::Metadata) -> io::Result<Option<Target>> {
    Ok(None)
}

#[cfg(not(unix))]
fn pipe(path: &Path, _: &fs::Metadata) -> io::Result<Target> {
    OpenOptions::new().write(true).open(path).map(Target::Device)
}

/// Returns the standard stream that refers to this file. Opening the file again would overwrite earlier output from
/// its start.
#[cfg(unix)]
fn standard(about: &fs::Metadata) -> Option<Target> {
    use std::os::fd::AsFd;
    use std::os::unix::fs::MetadataExt;
    let same = |stream: &dyn AsFd| {
        let stream = File::from(stream.as_fd().try_clone_to_owned().ok()?);
        let stream = stream.metadata().ok()?;
        Some((stream.dev(), stream.ino()) == (about.dev(), about.ino()))
    };
    if same(&io::stdout()) == Some(true) {
        return Some(Target::Output);
    }
    (same(&io::stderr()) == Some(true)).then_some(Target::Error)
}

#[cfg(not(unix))]
fn standard(_: &fs::Metadata) -> Option<Target> {
    None
}

/// Opens a pipe for writing. Waits for a reader until a signal arrives.
#[cfg(unix)]
fn open_pipe(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;
    use std::time::Duration;
    loop {
        match OpenOptions::new().write(true).custom_flags(libc::O_NONBLOCK).open(path) {
            // A reader exists. Without the flag, writes block until it reads.
            Ok(_open) => return OpenOptions::new().write(true).open(path),
            Err(error) if error.raw_os_error() == Some(libc::ENXIO) => {}
            Err(error) => return Err(error),
        }
        crate::interrupt::check().map_err(io::Error::other)?;
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[cfg(not(unix))]
fn open_pipe(path: &Path) -> io::Result<File> {
    OpenOptions::new().write(true).open(path)
}
