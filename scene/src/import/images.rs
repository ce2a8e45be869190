//! Decoding of texture images: headers first, then pixels in parallel, as cores and memory allow.

use std::borrow::Cow;
use std::ops::ControlFlow;
use std::path::PathBuf;

use gltf_json as json;

use super::limits::MAX_IMAGE_SIDE_TEXELS;
use super::source::Source;
use super::texture::Roughness;
use super::uri::Resource;
use crate::codec::{CodecError, TextureHeader, TextureLevels, decode_texture, texture_header};
use crate::error::{SceneError, Unsupported, one_line};
use crate::memory::{Loan, OverBudget};
use crate::parallel::in_parallel;
use crate::progress::{Progress, ProgressFn, Stage, report};
use crate::read::{file_bytes, read_file, read_start};
use crate::texture::{BlockFormats, Image, Texture, TextureRole};

/// An image that is located but not decoded.
struct Encoded<'a> {
    /// File for messages: the image's own, or the one it is embedded in.
    file: PathBuf,
    /// Place in the file, for messages.
    at: String,
    /// Encoded bytes; `None` for a separate file, which is read when it is decoded.
    bytes: Option<Cow<'a, [u8]>>,
    header: TextureHeader,
    /// Block formats to which it may be transcoded.
    formats: BlockFormats,
    /// Bytes that decoding needs in addition to the image, the encoded bytes included.
    working_bytes: u64,
}

/// Size of the prefix that is first searched for a header; some files have large metadata before it.
const START_BYTES: u64 = 1 << 16;

/// Decodes the images with these distinct file indices, in this order. `textures` define the roles of the images.
/// Images from which `computed` ones are made stay RGBA8.
///
/// All headers are read before any pixel, so that the memory check does not depend on thread timing. The first error in
/// list order is reported, for the same reason.
pub(super) fn decode(
    source: &Source<'_>,
    indices: &[usize],
    (textures, computed): (&[Texture], &[Roughness]),
    progress: &mut ProgressFn<'_>,
) -> Result<Vec<Image>, SceneError> {
    let mut encoded = Vec::with_capacity(indices.len());
    for (done, &index) in indices.iter().enumerate() {
        let is_read = computed.iter().any(|roughness| roughness.image.index() == done);
        let sampled = if is_read { BlockFormats::default() } else { source.block_formats };
        let formats = formats(sampled, textures, done);
        let image = find(source, &source.root.images[index], index, formats)?;
        let step = Progress { stage: Stage::Headers, done: done + 1, total: indices.len(), item: &image.at };
        report(progress, source.file, step)?;
        encoded.push(image);
    }
    let over = |image: &Encoded<'_>, budget| over(image, budget);
    for image in &encoded {
        source.keep(image.header.image_bytes).map_err(|budget| over(image, budget))?;
    }
    for image in &encoded {
        source.memory.lend(image.working_bytes).map(drop).map_err(|budget| over(image, budget))?;
    }
    let mut images: Vec<Option<Result<Image, SceneError>>> = Vec::new();
    images.resize_with(encoded.len(), || None);
    let (mut stopped, mut finished) = (Ok(()), 0);
    let admit = |image: &Encoded<'_>| source.memory.lend(image.working_bytes);
    in_parallel(&encoded, admit, decode_one, |i, result| {
        finished += 1;
        let step = Progress { stage: Stage::Images, done: finished, total: encoded.len(), item: &encoded[i].at };
        if stopped.is_ok() {
            stopped = report(progress, source.file, step);
        }
        let go_on = stopped.is_ok() && result.is_ok();
        images[i] = Some(result);
        if go_on { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    stopped?;
    // After an error, later images may be missing, but no earlier ones.
    images.into_iter().flatten().collect()
}

/// Returns the block formats for the image at this position of the list. Normal maps do not become ETC2: its blocks
/// vary along one color axis at a time, which distorts normals.
fn formats(of_device: BlockFormats, textures: &[Texture], place: usize) -> BlockFormats {
    let is_normal = |texture: &Texture| texture.image.index() == place && texture.role == TextureRole::Normal;
    BlockFormats { etc2: of_device.etc2 && !textures.iter().any(is_normal), ..of_device }
}

fn over(image: &Encoded<'_>, budget: OverBudget) -> SceneError {
    let [width, height] = image.header.size_texels;
    SceneError::Memory { file: image.file.clone(), at: format!("{}, {width}×{height}", image.at), budget }
}

/// Locates the bytes of an image and reads its header.
fn find<'a>(
    source: &'a Source<'_>,
    json: &json::Image,
    index: usize,
    formats: BlockFormats,
) -> Result<Encoded<'a>, SceneError> {
    let name = json.name.as_deref().filter(|name| !name.is_empty());
    let at = name.map_or_else(|| format!("image {index}"), |name| format!("image {index} {:?}", one_line(name)));
    let (file, bytes) = match (json.buffer_view, &json.uri) {
        (Some(view), _) => (source.file.to_path_buf(), Some(Cow::Borrowed(source.view(view.value(), &at)?.0))),
        (None, Some(uri)) => match source.resolve(&at, uri)? {
            Resource::Bytes(bytes) => {
                source.keep_file(&at, bytes.len() as u64)?;
                (source.file.to_path_buf(), Some(Cow::Owned(bytes)))
            }
            Resource::File(file) => (file, None),
        },
        (None, None) => return Err(source.malformed(&at, "it has neither a URI nor a buffer view")),
    };
    let mut image = Encoded { file, at, bytes, header: TextureHeader::default(), formats, working_bytes: 0 };
    let named = |error| source.named(&image.at, error);
    let header = match &image.bytes {
        Some(bytes) => texture_header(bytes, MAX_IMAGE_SIDE_TEXELS, formats),
        None => {
            image.working_bytes = file_bytes(&image.file).map_err(named)?;
            let start = read_start(&image.file, START_BYTES).map_err(named)?;
            match texture_header(&start, MAX_IMAGE_SIDE_TEXELS, formats) {
                Err(CodecError::Other(_)) if start.len() as u64 == START_BYTES => {
                    let whole = read_file(&image.file).map_err(named)?;
                    texture_header(&whole, MAX_IMAGE_SIDE_TEXELS, formats)
                }
                header => header,
            }
        }
    };
    image.header = header.map_err(|error| refused(&image, error))?;
    image.working_bytes += image.header.working_bytes;
    source.note_file(&image.file);
    Ok(image)
}

fn decode_one(encoded: &Encoded<'_>, loan: Result<Loan<'_>, OverBudget>) -> Result<Image, SceneError> {
    let _loan = loan.map_err(|budget| over(encoded, budget))?;
    let bytes: Cow<'_, [u8]> = match &encoded.bytes {
        Some(bytes) => Cow::Borrowed(bytes),
        None => Cow::Owned(read_file(&encoded.file)?),
    };
    let decoded = decode_texture(&bytes, MAX_IMAGE_SIDE_TEXELS, encoded.formats);
    let TextureLevels { size_texels, format, levels } = decoded.map_err(|error| refused(encoded, error))?;
    let [width, height] = size_texels;
    let image = Image { name: String::new(), width, height, format, levels };
    if size_texels != encoded.header.size_texels || image.size_bytes() != encoded.header.image_bytes {
        return Err(SceneError::malformed(&encoded.file, &encoded.at, "its size changed while it was read"));
    }
    let file = one_line(&encoded.file.display().to_string());
    let name = match &encoded.bytes {
        Some(_) => format!("{file}: {}", encoded.at),
        None => file,
    };
    Ok(Image { name, ..image })
}

fn refused(image: &Encoded<'_>, error: CodecError) -> SceneError {
    let (file, at) = (image.file.clone(), image.at.clone());
    match error {
        CodecError::Kind(kind) => SceneError::Unsupported { file, feature: Unsupported::Image { at, kind } },
        error => SceneError::Picture { file, at, error },
    }
}
