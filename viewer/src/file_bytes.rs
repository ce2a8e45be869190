//! Reading a file by pieces, with progress, as long as somebody wants it.

use crate::job::Handle;
use program::input::open;
use std::io::Read;
use std::path::Path;

/// Bytes that are read between two looks at the progress.
const CHUNK_BYTES: usize = 1 << 20;

/// The bytes of a file, as long as the owner wants them.
pub(crate) fn bytes_of(path: &Path, most_bytes: u64, handle: &Handle) -> Result<Vec<u8>, String> {
    let shown = path.display();
    let unreadable = |e: std::io::Error| format!("{shown}: cannot be read: {e}");
    let file = open(path).map_err(unreadable)?;
    let too_large = || format!("{shown}: more than {most_bytes} bytes; files of that size are not read");
    let total = file.metadata().map_err(unreadable)?.len();
    if total > most_bytes {
        return Err(too_large());
    }
    // Some files have no end, and say that they have no length.
    let mut file = file.take(most_bytes + 1);
    let mut bytes = Vec::new();
    loop {
        let before = bytes.len();
        file.by_ref().take(CHUNK_BYTES as u64).read_to_end(&mut bytes).map_err(unreadable)?;
        handle.step(bytes.len() as u64, total.max(bytes.len() as u64));
        if handle.is_cancelled() {
            return Err(format!("{shown}: reading was cancelled"));
        }
        if bytes.len() as u64 > most_bytes {
            return Err(too_large());
        }
        if bytes.len() == before {
            return Ok(bytes);
        }
    }
}
