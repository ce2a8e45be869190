//! Where an output goes: a file that is replaced or new, or something that is written through.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// What stands at a path that is to be written.
#[derive(Debug)]
pub(crate) enum Target {
    /// A regular file, or none yet: the path with all links followed.
    File(PathBuf),
    /// A device that is open.
    Device(File),
    /// A named pipe, which is opened when there is something to write.
    Pipe(PathBuf),
    /// What standard output is.
    Output,
    /// What standard error is.
    Error,
}

/// Links that are followed before a circle is suspected, as on Linux.
const MOST_LINKS: usize = 40;

impl Target {
    /// Looks at a path without changing anything there.
    pub fn find(path: &Path) -> io::Result<Self> {
        let about = match fs::metadata(path) {
            Ok(about) => about,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return followed(path).map(Self::File),
            Err(error) => return Err(error),
        };
        if about.is_dir() {
            return Err(io::Error::other("it is a folder"));
        }
        if let Some(device) = device(path, &about)? {
            return Ok(device);
        }
        if let Some(stream) = standard(&about) {
            return Ok(stream);
        }
        if about.is_file() {
            // A file that may not be written is not replaced either.
            OpenOptions::new().write(true).open(path)?;
            return followed(path).map(Self::File);
        }
        pipe(path, &about)
    }

    /// Whether both write into one file or pipe. A device may take several outputs: one after the other, or none at all.
    pub fn is(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::File(a), Self::File(b)) | (Self::Pipe(a), Self::Pipe(b)) => same(a, b),
            (Self::Output, Self::Output) | (Self::Error, Self::Error) => true,
            _ => false,
        }
    }

    /// Writes what goes through. A reader that has closed its end has seen enough.
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

/// The canonical folder and the name that a file has, or will have, behind all links.
fn followed(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        let name = path.file_name().ok_or_else(|| io::Error::other("it names no file"))?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let folder = folder.canonicalize().map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => io::Error::other(format!("there is no folder {}", folder.display())),
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
    Err(io::Error::other("its links go in a circle"))
}

/// Whether two paths without links are one file: the same name, or other names of the same file.
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

/// A character device, opened; none for anything else.
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
        Err(io::Error::other("it is neither a file, a pipe nor a character device"))
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

/// Whether this is the file that standard output or standard error goes to. Opened anew it would be written from its
/// beginning, over what the shell or this program has put there.
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

/// Waits for a reader, unless a signal comes first.
#[cfg(unix)]
fn open_pipe(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;
    use std::time::Duration;
    loop {
        match OpenOptions::new().write(true).custom_flags(libc::O_NONBLOCK).open(path) {
            // The reader is there; without the flag, writing waits for it to read.
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
