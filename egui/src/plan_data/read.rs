//! Reader of saved plans, with one-sentence errors.

use super::data::PlanData;
use super::rows::Form;
use serde::Deserialize;
use serde::de::IgnoredAny;

/// Maximum number of unknown fields to list.
const NAMED: usize = 8;

/// Error of reading a saved plan.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum ReadError {
    /// The text is invalid or truncated JSON.
    #[error("line {line}: invalid JSON: {reason}{}", if *.truncated { "; the text is truncated; copy or save it again" } else { "" })]
    Syntax {
        /// Line, from 1.
        line: usize,
        /// Error of the parser.
        reason: String,
        /// True if the text ends within the object.
        truncated: bool,
    },
    /// JSON with another schema.
    #[error("not a plan: `schema` is {}, expected `framegraph-plan`; save a plan with `plan FRAME.ron --format json`", quoted(.schema.as_deref()))]
    Schema {
        /// The `schema` field, if present.
        schema: Option<String>,
    },
    /// Plan with another version.
    #[error("unsupported plan version {version}, expected {known}; save it again with this version of the library")]
    Version {
        /// Version of the file.
        version: u64,
        /// Supported version.
        known: u32,
    },
    /// A field is missing or has the wrong type.
    #[error("line {line}: {reason}; docs/reference/plan-json.md documents the fields")]
    Field {
        /// Line, from 1.
        line: usize,
        /// Error of the parser.
        reason: String,
    },
    /// A row refers to a missing row.
    #[error("{place}: {what} {index} does not exist, the plan has {count}; the file is damaged, save it again")]
    Dangling {
        /// The referring row.
        place: String,
        /// Kind of the missing row: a step or a slot.
        what: &'static str,
        /// Index of the missing row.
        index: usize,
        /// Number of existing rows.
        count: usize,
    },
}

impl std::fmt::Debug for ReadError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{self}")
    }
}

fn quoted(schema: Option<&str>) -> String {
    schema.map_or_else(|| "missing".into(), |s| format!("`{}`", s.chars().take(40).collect::<String>()))
}

/// Fields that identify the form of a file.
#[derive(Deserialize)]
struct Head {
    schema: Option<String>,
    version: Option<u64>,
}

/// Reads a plan. Unknown fields are ignored and listed in [`PlanData::notes`].
///
/// # Errors
/// [`ReadError`], with line and reason.
pub fn read(text: &[u8]) -> Result<PlanData, ReadError> {
    let mut unknown: Vec<String> = Vec::new();
    let mut more = 0;
    let mut deserializer = serde_json::Deserializer::from_slice(text);
    let form: Result<Form, _> = serde_ignored::deserialize(&mut deserializer, |path| {
        // Report one path for all rows of a list.
        let path = path.to_string();
        let path = path.split('.').map(|part| if part.parse::<usize>().is_ok() { "*" } else { part });
        let path = path.collect::<Vec<_>>().join(".");
        if unknown.contains(&path) {
        } else if unknown.len() < NAMED {
            unknown.push(path);
        } else {
            more += 1;
        }
    });
    let form = form.and_then(|form| deserializer.end().map(|()| form)).map_err(|error| explained(text, &error))?;
    known(Some(form.schema.clone()), Some(form.version))?;
    dangling(&form)?;
    let mut notes = Vec::new();
    if !unknown.is_empty() {
        let rest = if more > 0 { format!(" and {more} more") } else { String::new() };
        notes.push(format!("unknown fields are not shown: {}{rest}", unknown.join(", ")));
    }
    if form.flows.is_none() {
        notes.push("the file is from a version without `flows`: the graph has no edges; save it again".into());
    }
    Ok(PlanData::new(form, notes))
}

/// Rejects other schemas and versions.
fn known(schema: Option<String>, version: Option<u64>) -> Result<(), ReadError> {
    if schema.as_deref() != Some("framegraph-plan") {
        return Err(ReadError::Schema { schema });
    }
    match version {
        Some(version) if version != u64::from(framegraph::dump::JSON_VERSION) => {
            Err(ReadError::Version { version, known: framegraph::dump::JSON_VERSION })
        }
        _ => Ok(()),
    }
}

/// Explains a failure. A wrong schema or version takes precedence over a missing field.
fn explained(text: &[u8], error: &serde_json::Error) -> ReadError {
    let (line, reason) = (error.line(), without_place(error));
    if error.is_syntax() || error.is_eof() {
        return ReadError::Syntax { line, reason, truncated: error.is_eof() };
    }
    // Valid JSON of another form.
    let head = match serde_json::from_slice::<Head>(text) {
        Ok(head) => head,
        Err(error) if error.is_syntax() || error.is_eof() => {
            let (line, reason) = (error.line(), without_place(&error));
            return ReadError::Syntax { line, reason, truncated: error.is_eof() };
        }
        Err(_) if serde_json::from_slice::<IgnoredAny>(text).is_ok() => Head { schema: None, version: None },
        Err(_) => return ReadError::Field { line, reason },
    };
    match known(head.schema, head.version) {
        Err(other) => other,
        Ok(()) => ReadError::Field { line, reason },
    }
}

/// Returns the message of the parser without ` at line 1 column 2`.
fn without_place(error: &serde_json::Error) -> String {
    let text = error.to_string();
    text.rsplit_once(" at line ").map_or(text.clone(), |(reason, _)| reason.to_owned())
}

/// Checks that every index refers to an existing row.
fn dangling(form: &Form) -> Result<(), ReadError> {
    let (steps, slots) = (form.steps.len(), form.slots.len());
    let step = |place: &dyn Fn() -> String, index: Option<usize>| match index {
        Some(index) if index >= steps => Err(ReadError::Dangling { place: place(), what: "step", index, count: steps }),
        _ => Ok(()),
    };
    for pass in &form.passes {
        step(&|| format!("pass `{}`", pass.name), pass.step)?;
    }
    for (index, row) in form.steps.iter().enumerate() {
        if row.index != index {
            let place = format!("step {index}");
            return Err(ReadError::Dangling { place, what: "index", index: row.index, count: steps });
        }
    }
    for resource in &form.resources {
        let place = || format!("resource `{}`", resource.name);
        let held = resource.held_steps.unwrap_or_default();
        let held = resource.held_steps.map(|_| held[0].max(held[1]));
        for index in [resource.first_step, resource.last_step, held] {
            step(&place, index)?;
        }
        if let Some(index) = resource.slot.filter(|slot| *slot >= slots) {
            return Err(ReadError::Dangling { place: place(), what: "slot", index, count: slots });
        }
    }
    for barrier in &form.barriers {
        let place = || format!("barrier of `{}`", barrier.resource);
        step(&place, Some(barrier.before_step))?;
        step(&place, barrier.after_step)?;
    }
    for decision in &form.decisions {
        step(&|| format!("decision `{}`", decision.reason), decision.step)?;
    }
    step(&|| "peak".into(), form.peak.as_ref().map(|peak| peak.step))
}
