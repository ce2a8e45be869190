//! Vertex streams from accessors.

use super::accessor::floats;
use super::packed::Values;
use super::source::Source;
use crate::error::SceneError;

/// Reads a vertex attribute; `count` is the required number of elements, if known.
pub(super) fn stream<const N: usize, T>(
    source: &Source<'_>,
    at: &str,
    what: &str,
    values: impl Into<Values>,
    count: Option<usize>,
    convert: impl Fn([f32; N]) -> T,
) -> Result<Vec<T>, SceneError> {
    let values = floats::<N>(source, values, &format!("{at} {what}"))?;
    if let Some(count) = count
        && values.len() != count
    {
        let reason = format!("{} elements of {what} for {count} vertices", values.len());
        return Err(source.malformed(at, reason));
    }
    Ok(values.into_iter().map(convert).collect())
}

/// Rejects a stream with an element that is not finite; the error names the first one.
pub(super) fn finite<T: std::fmt::Display>(
    source: &Source<'_>,
    at: &str,
    what: &str,
    values: &[T],
    is_finite: impl Fn(&T) -> bool,
) -> Result<(), SceneError> {
    match values.iter().position(|v| !is_finite(v)) {
        Some(i) => Err(source.malformed(at, format!("{what} of vertex {i} is not finite: {}", values[i]))),
        None => Ok(()),
    }
}
