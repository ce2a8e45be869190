//! A subscriber of the crate `tracing` that writes the Trace Event Format of Perfetto and Chrome.
//!
//! Engines that have a subscriber need only the feature `tracing` of `framegraph-wgpu`. This one shows how little a
//! subscriber needs; `tracing-chrome` and `tracing-tracy` are complete ones.

use serde_json::{Map, Value, json};
use std::cell::RefCell;
use std::fmt::Debug;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Metadata, Subscriber};

/// Collects the spans of this project, from all threads. Clones share them.
#[derive(Clone, Debug)]
pub struct ChromeTrace {
    begun: Instant,
    state: Arc<Mutex<State>>,
}

#[derive(Debug, Default)]
struct State {
    spans: Vec<Span>,
    events: Vec<Value>,
    threads: u64,
}

#[derive(Debug)]
struct Span {
    metadata: &'static Metadata<'static>,
    fields: Map<String, Value>,
}

thread_local! {
    /// Number of this thread, from 1; 0 before its first span.
    static THREAD: RefCell<u64> = const { RefCell::new(0) };
    /// Open spans of this thread, with the time when each was entered.
    static OPEN: RefCell<Vec<(Id, Duration)>> = const { RefCell::new(Vec::new()) };
}

impl Default for ChromeTrace {
    fn default() -> Self {
        Self { begun: Instant::now(), state: Arc::default() }
    }
}

impl ChromeTrace {
    /// Returns the spans that have ended, as JSON that <https://ui.perfetto.dev> and `chrome://tracing` open.
    pub fn json(&self) -> Value {
        json!({ "displayTimeUnit": "ms", "traceEvents": self.state().events })
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Subscriber for ChromeTrace {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.target().starts_with("framegraph")
    }

    fn new_span(&self, attributes: &Attributes<'_>) -> Id {
        let mut fields = Fields::default();
        attributes.record(&mut fields);
        let mut state = self.state();
        state.spans.push(Span { metadata: attributes.metadata(), fields: fields.0 });
        Id::from_u64(state.spans.len() as u64)
    }

    fn record(&self, span: &Id, values: &Record<'_>) {
        let mut fields = Fields::default();
        values.record(&mut fields);
        self.state().spans[index(span)].fields.extend(fields.0);
    }

    fn record_follows_from(&self, _: &Id, _: &Id) {}

    fn event(&self, _: &Event<'_>) {}

    fn enter(&self, span: &Id) {
        OPEN.with_borrow_mut(|open| open.push((span.clone(), self.begun.elapsed())));
    }

    fn exit(&self, span: &Id) {
        let Some((_, since)) = OPEN.with_borrow_mut(|open| open.pop_if(|(last, _)| last == span)) else { return };
        let (now, mut state) = (self.begun.elapsed(), self.state());
        let thread = THREAD.with_borrow_mut(|thread| {
            if *thread == 0 {
                state.threads += 1;
                *thread = state.threads;
            }
            *thread
        });
        let Span { metadata, fields } = &state.spans[index(span)];
        let us = |time: Duration| time.as_secs_f64() * 1e6;
        let event = json!({
            "name": metadata.name(), "cat": metadata.target(), "ph": "X", "pid": 1, "tid": thread,
            "ts": us(since), "dur": us(now - since), "args": fields,
        });
        state.events.push(event);
    }
}

fn index(span: &Id) -> usize {
    span.into_u64() as usize - 1
}

/// Fields of a span as JSON.
#[derive(Default)]
struct Fields(Map<String, Value>);

impl Visit for Fields {
    fn record_u64(&mut self, field: &Field, value: u64) {
        self.0.insert(field.name().to_owned(), value.into());
    }

    fn record_str(&mut self, field: &Field, value: &str) {
        self.0.insert(field.name().to_owned(), value.into());
    }

    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        self.0.insert(field.name().to_owned(), format!("{value:?}").into());
    }
}
