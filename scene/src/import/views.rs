//! Buffer views compressed with `EXT_meshopt_compression` or `KHR_meshopt_compression`.
//!
//! All compressed views are decoded in parallel before any view is read. The decoded bytes replace those of the view,
//! transparently for accessors, animations and images. Uncompressed fallbacks are not read.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;

use gltf_json::buffer::View;
use gltf_json::{Buffer, Root, Value};

use super::source::Source;
use crate::error::SceneError;
use crate::meshopt::{Filter, Layout, MeshoptError, Mode, decode as decode_view};
use crate::parallel::in_parallel;
use crate::progress::{Progress, ProgressFn, Stage, report};

/// Both names of the extension, the newer first.
const NAMES: [&str; 2] = ["KHR_meshopt_compression", "EXT_meshopt_compression"];

/// A compressed view that is located but not decoded.
struct Compressed<'a> {
    view: usize,
    /// Place for messages: `buffer view 3: EXT_meshopt_compression`.
    at: String,
    layout: Layout,
    bytes: &'a [u8],
}

/// Decodes the compressed buffer views of the file; the result is keyed by view index.
///
/// # Errors
///
/// Fails for an invalid extension object, for a stream that does not decode, and if memory is short. Reports the first
/// error in file order.
pub(super) fn decode(
    source: &Source<'_>,
    progress: &mut ProgressFn<'_>,
) -> Result<BTreeMap<usize, Vec<u8>>, SceneError> {
    let mut compressed = Vec::new();
    for (view, json) in source.root.buffer_views.iter().enumerate() {
        if let Some((name, json)) = of_view(json) {
            compressed.push(find(source, view, name, json)?);
        }
    }
    for view in &compressed {
        source.keep_file(&view.at, view.layout.bytes())?;
    }
    let mut decoded: Vec<Option<Result<Vec<u8>, MeshoptError>>> = vec![None; compressed.len()];
    let (mut stopped, mut done) = (Ok(()), 0);
    in_parallel(
        &compressed,
        |_| (),
        |view, ()| decode_view(&view.layout, view.bytes),
        |i, result| {
            done += 1;
            let (total, item) = (compressed.len(), &compressed[i].at);
            if stopped.is_ok() {
                stopped = report(progress, source.file, Progress { stage: Stage::Decompression, done, total, item });
            }
            let go_on = stopped.is_ok() && result.is_ok();
            decoded[i] = Some(result);
            if go_on { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        },
    );
    stopped?;
    // After an error, later views may be missing, but no earlier ones.
    let all = compressed.iter().zip(decoded).filter_map(|(view, result)| Some((view, result?)));
    all.map(|(view, result)| match result {
        Ok(bytes) => Ok((view.view, bytes)),
        Err(error) => Err(source.malformed(&view.at, error.to_string())),
    })
    .collect()
}

/// Returns the buffers that need not be read, since every view of them is compressed. These are marked as fallback, or
/// have no URI and are not the binary chunk.
pub(super) fn fallbacks(root: &Root, has_blob: bool) -> BTreeSet<usize> {
    let is_marked = |buffer: &Buffer| {
        let others = buffer.extensions.as_ref().map(|extensions| &extensions.others);
        let json = others.and_then(|others| NAMES.into_iter().find_map(|name| others.get(name)));
        json.is_some_and(|json| json.get("fallback").and_then(Value::as_bool) == Some(true))
    };
    let compressed = root.buffer_views.iter().filter(|view| of_view(view).is_some());
    let parents: BTreeSet<usize> = compressed.map(|view| view.buffer.value()).collect();
    let buffers = root.buffers.iter().enumerate();
    let is_fallback = |(index, buffer): &(usize, &Buffer)| {
        let has_data = buffer.uri.is_some() || (*index == 0 && has_blob);
        is_marked(buffer) || (!has_data && parents.contains(index))
    };
    buffers.filter(is_fallback).map(|(index, _)| index).collect()
}

/// Returns the extension object of a view, and the name under which it appears.
fn of_view(view: &View) -> Option<(&'static str, &Value)> {
    let others = &view.extensions.as_ref()?.others;
    NAMES.into_iter().find_map(|name| Some((name, others.get(name)?)))
}

/// Reads and checks the extension object of a view.
fn find<'a>(source: &'a Source<'_>, view: usize, name: &str, json: &Value) -> Result<Compressed<'a>, SceneError> {
    let at = format!("buffer view {view}: {name}");
    let number = |key: &str| match json.get(key).map(Value::as_u64) {
        Some(Some(number)) => Ok(number),
        Some(None) => Err(source.malformed(&at, format!("its {key} is not a whole number"))),
        None => Err(source.malformed(&at, format!("it has no {key}"))),
    };
    let size =
        |key: &str| usize::try_from(number(key)?).map_err(|_| source.malformed(&at, format!("its {key} is too large")));
    let text = |key: &str| json.get(key).map(|value| value.as_str().unwrap_or("no text"));
    let mode = match text("mode") {
        Some("ATTRIBUTES") => Mode::Attributes,
        Some("TRIANGLES") => Mode::Triangles,
        Some("INDICES") => Mode::Indices,
        mode => return Err(source.malformed(&at, format!("its mode is {:?}, which is unknown", mode.unwrap_or("")))),
    };
    let filter = match text("filter") {
        None | Some("NONE") => Filter::None,
        Some("OCTAHEDRAL") => Filter::Octahedral,
        Some("QUATERNION") => Filter::Quaternion,
        Some("EXPONENTIAL") => Filter::Exponential,
        Some("COLOR") => Filter::Color,
        Some(filter) => return Err(source.malformed(&at, format!("its filter is {filter:?}, which is unknown"))),
    };
    let layout = Layout { count: size("count")?, stride: size("byteStride")?, mode, filter };
    let start = if json.get("byteOffset").is_some() { number("byteOffset")? } else { 0 };
    let bytes = source.range(size("buffer")?, start, number("byteLength")?, &at, format_args!("it"))?;
    layout.check(bytes.len()).map_err(|error| source.malformed(&at, error.to_string()))?;
    let promised = source.root.buffer_views[view].byte_length.0;
    if layout.bytes() != promised {
        let reason = format!("its count and byteStride make {} bytes, but the view has {promised}", layout.bytes());
        return Err(source.malformed(&at, reason));
    }
    Ok(Compressed { view, at, layout, bytes })
}
