//! Prints the table of glTF extensions in `docs/reference/files.md`.

use framegraph_scene::import::extensions_table;
use std::io::Write as _;

fn main() -> std::io::Result<()> {
    std::io::stdout().write_all(extensions_table().as_bytes())
}
