//! Decoding PNG and JPEG images, on as many threads as there are cores.

use std::borrow::Cow;
use std::ops::ControlFlow;
use std::path::PathBuf;

use gltf_json as json;

use super::limits::MAX_IMAGE_SIDE_TEXELS;
use super::source::Source;
use super::uri::{Resource, resolve};
use crate::codec::{CodecError, decode_8};
use crate::error::{SceneError, Unsupported, one_line};
use crate::parallel::in_parallel;
use crate::progress::{Progress, ProgressFn, Stage, report};
use crate::read::read_file;
use crate::texture::Image;

/// An image that is found but not read.
struct Encoded<'a> {
    /// For messages: the image's own file, or the file it is embedded in.
    file: PathBuf,
    /// For messages: where in that file.
    at: String,
    bytes: Option<Cow<'a, [u8]>>,
}

/// Decodes the images with these indices in the file, in this order.
///
/// Threads take the next image as they become free; the result does not depend on which. The first
/// error in the order of the list is reported, so messages do not depend on it either.
pub(super) fn decode(
    source: &Source<'_>,
    indices: &[usize],
    progress: &mut ProgressFn<'_>,
) -> Result<Vec<Image>, SceneError> {
    let mut encoded = Vec::with_capacity(indices.len());
    for &index in indices {
        encoded.push(find(source, &source.root.images[index], index)?);
    }
    let mut budget = Ok(());
    let mut finished = 0;
    let results = in_parallel(&encoded, decode_one, |i, result| {
        finished += 1;
        let step = Progress { stage: Stage::Images, done: finished, total: encoded.len(), item: &encoded[i].at };
        if budget.is_ok() {
            budget = report(progress, source.file, step);
        }
        if let (Ok(()), Ok(image)) = (&budget, result) {
            budget = source.charge(image.rgba8.len() as u64);
        }
        if budget.is_err() || result.is_err() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    budget?;
    // After an error the images behind it may be missing, the ones before it never are.
    let mut images = Vec::with_capacity(results.len());
    for result in results {
        match result {
            Some(Ok(image)) => images.push(image),
            Some(Err(error)) => return Err(error),
            None => {}
        }
    }
    Ok(images)
}

/// Where an image's bytes are.
fn find<'a>(source: &'a Source<'_>, json: &json::Image, index: usize) -> Result<Encoded<'a>, SceneError> {
    let name = json.name.as_deref().filter(|name| !name.is_empty());
    let at = name.map_or_else(|| format!("image {index}"), |name| format!("image {index} {:?}", one_line(name)));
    let file = source.file.to_path_buf();
    if let Some(view) = json.buffer_view {
        let (bytes, _) = source.view(view.value(), &at)?;
        let bytes = Some(Cow::Borrowed(bytes));
        return Ok(Encoded { file, at, bytes });
    }
    let Some(uri) = &json.uri else {
        return Err(source.malformed(&at, "it has neither a URI nor a buffer view"));
    };
    Ok(match resolve(source.file, &at, uri)? {
        Resource::Bytes(bytes) => Encoded { file, at, bytes: Some(Cow::Owned(bytes)) },
        Resource::File(file) => Encoded { file, at, bytes: None },
    })
}

fn decode_one(encoded: &Encoded<'_>) -> Result<Image, SceneError> {
    let read: Vec<u8>;
    let bytes: &[u8] = match &encoded.bytes {
        Some(bytes) => bytes,
        None => {
            read = read_file(&encoded.file)?;
            &read
        }
    };
    let picture = decode_8(bytes, MAX_IMAGE_SIDE_TEXELS).map_err(|error| {
        let (file, at) = (encoded.file.clone(), encoded.at.clone());
        match error {
            CodecError::Kind(kind) => SceneError::Unsupported { file, feature: Unsupported::Image { at, kind } },
            error => SceneError::Picture { file, at, error },
        }
    })?;
    let file = one_line(&encoded.file.display().to_string());
    let name = match &encoded.bytes {
        Some(_) => format!("{file}: {}", encoded.at),
        None => file,
    };
    let [width, height] = picture.size_texels;
    Ok(Image { name, width, height, rgba8: picture.rgba8 })
}
