//! Validation by naga, with errors mapped to the author's files.

use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

use super::link::Linked;
use crate::ShaderError;

/// Parses and validates the text with all optional capabilities allowed. The device checks later whether it supports
/// them.
///
/// # Errors
///
/// Errors of naga, with file and line.
pub(super) fn check(linked: &Linked) -> Result<(naga::Module, ModuleInfo), ShaderError> {
    let fault = |span: Option<naga::Span>, message: String| {
        let (file, line) = linked.origin(span.and_then(|span| span.to_range()).map_or(0, |range| range.start));
        ShaderError::Source { file: file.to_owned(), line, message }
    };
    let module = naga::front::wgsl::parse_str(&linked.wgsl).map_err(|error| {
        let label = error.labels().next();
        let detail = label.map(|(_, text)| text).filter(|text| !text.is_empty() && *text != error.message());
        let message = detail.map_or_else(|| error.message().to_owned(), |text| format!("{}: {text}", error.message()));
        fault(label.map(|(span, _)| span), message)
    })?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::all())
        .validate(&module)
        .map_err(|error| fault(error.spans().last().map(|(span, _)| *span), chain(error.as_inner())))?;
    Ok((module, info))
}

/// Formats an error and its causes in one line.
fn chain(error: &dyn std::error::Error) -> String {
    let mut line = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        line.push_str(&format!(": {error}"));
        cause = error.source();
    }
    line
}
