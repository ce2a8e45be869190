//! Saves a texture: the displayed picture as PNG, the values as OpenEXR.

use super::Preview;
use framegraph_scene::picture::{encode_exr, encode_png};
use program::outputs::Outputs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// Writes the picture to a `.png` file, or the values of all channels to an `.exr` file, never over an input file.
///
/// # Errors
/// One line that names the file: nothing to save, an unknown extension, or a failure to write.
pub fn save(preview: &Preview, path: &Path, read: &[PathBuf]) -> Result<(), String> {
    let shown = path.display();
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let (Some(found), Some(picture)) = (&preview.found, &preview.picture) else {
        return Err(format!("{shown}: no texture to save; select one"));
    };
    let mut bytes = Cursor::new(Vec::new());
    match ending.as_str() {
        "png" => encode_png(&mut bytes, picture.size, &picture.rgba8),
        "exr" => encode_exr(&mut bytes, found.texels.size, &found.numbers),
        _ => return Err(format!("{shown}: unknown extension; use png for the picture or exr for the values")),
    }
    .map_err(|error| format!("{shown}: {error}"))?;
    Outputs::one_beside(path, &bytes.into_inner(), read).map_err(|error| error.to_string())
}
