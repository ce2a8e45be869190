//! Spans of compilations for `tracing` (feature `tracing`). Without the feature they compile to nothing.

#[cfg(feature = "tracing")]
pub(crate) use with_tracing::{compiled, span};
#[cfg(not(feature = "tracing"))]
pub(crate) use without_tracing::{NoSpan, compiled, span};

#[cfg(feature = "tracing")]
mod with_tracing {
    use crate::plan::Plan;
    use tracing::span::EnteredSpan;

    /// Evaluates an expression in a span, or opens a span that ends when the returned guard is dropped. Fields after the
    /// semicolon are recorded later. A macro, because `tracing` needs a static for each place.
    macro_rules! span {
        ($name:literal => $body:expr) => {{
            let _span = tracing::trace_span!($name).entered();
            $body
        }};
        ($name:literal $(, $field:ident = $value:expr)* $(; $($later:ident),*)?) => {
            tracing::debug_span!($name $(, $field = $value)* $($(, $later = tracing::field::Empty)*)?).entered()
        };
    }
    pub(crate) use span;

    /// Records the results of a compilation in its span.
    pub(crate) fn compiled(span: &EnteredSpan, plan: &Plan) {
        if span.is_disabled() {
            return;
        }
        let (counts, memory) = (plan.counts(), plan.memory());
        span.record("steps", counts.steps);
        span.record("culled", counts.culled);
        span.record("loads", counts.unresolves);
        span.record("stores", counts.resolves);
        span.record("bytes", memory.bytes + memory.own_bytes);
        span.record("barriers", plan.barriers().len());
    }
}

#[cfg(not(feature = "tracing"))]
mod without_tracing {
    use crate::plan::Plan;

    /// Replaces a span. Its fields are not evaluated.
    #[must_use]
    pub(crate) struct NoSpan;

    macro_rules! span {
        ($name:literal => $body:expr) => {
            $body
        };
        ($name:literal $(, $field:ident = $value:expr)* $(; $($later:ident),*)?) => {
            crate::spans::NoSpan
        };
    }
    pub(crate) use span;

    #[inline(always)]
    pub(crate) fn compiled(_: &NoSpan, _: &Plan) {}
}
