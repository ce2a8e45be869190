//! Chunked file reading with progress and cancellation.

use crate::job::Handle;
use program::input::open;
use std::io::Read;
use std::path::Path;

/// Bytes read between two updates of the progress.
const CHUNK_BYTES: usize = 1 << 20;

/// Reads a file of at most `max_bytes` bytes, unless the job is cancelled.
pub(crate) fn bytes_of(path: &Path, max_bytes: u64, handle: &Handle) -> Result<Vec<u8>, String> {
    let shown = path.display();
    let unreadable = |e: std::io::Error| format!("{shown}: cannot be read: {e}");
    let file = open(path).map_err(unreadable)?;
    let too_large = || format!("{shown}: larger than {max_bytes} bytes; use a smaller file");
    let total = file.metadata().map_err(unreadable)?.len();
    if total > max_bytes {
        return Err(too_large());
    }
    // Special files may never end although they report a length of zero.
    let mut file = file.take(max_bytes + 1);
    let mut bytes = Vec::new();
    loop {
        let before = bytes.len();
        file.by_ref().take(CHUNK_BYTES as u64).read_to_end(&mut bytes).map_err(unreadable)?;
        handle.step(bytes.len() as u64, total.max(bytes.len() as u64));
        if handle.is_cancelled() {
            return Err(format!("{shown}: reading cancelled"));
        }
        if bytes.len() as u64 > max_bytes {
            return Err(too_large());
        }
        if bytes.len() == before {
            return Ok(bytes);
        }
    }
}
