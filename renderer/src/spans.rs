//! Spans of executed frames for `tracing` (feature `tracing`). Without the feature they compile to nothing.

#[cfg(feature = "tracing")]
pub(crate) use with_tracing::{executed, here, span};
#[cfg(not(feature = "tracing"))]
pub(crate) use without_tracing::{NoSpan, executed, here, span};

#[cfg(feature = "tracing")]
mod with_tracing {
    use framegraph::Plan;
    use tracing::span::EnteredSpan;

    /// Opens a span that ends when the returned guard is dropped. Fields after the semicolon are recorded later. A
    /// macro, because `tracing` needs a static for each place.
    macro_rules! span {
        ($name:literal in $parent:expr) => {
            tracing::debug_span!(parent: $parent, $name).entered()
        };
        ($name:literal $(, $field:ident = $value:expr)* $(; $($later:ident),*)?) => {
            tracing::debug_span!($name $(, $field = $value)* $($(, $later = tracing::field::Empty)*)?).entered()
        };
    }
    pub(crate) use span;

    /// Returns the current span, in which other threads continue.
    pub(crate) fn here() -> tracing::Span {
        tracing::Span::current()
    }

    /// Records what a frame executed in its span.
    pub(crate) fn executed(span: &EnteredSpan, plan: &Plan) {
        if span.is_disabled() {
            return;
        }
        let (counts, traffic) = (plan.counts(), plan.traffic(plan.frame()));
        span.record("steps", counts.steps);
        span.record("passes", counts.passes);
        span.record("loads", counts.unresolves);
        span.record("stores", counts.resolves);
        span.record("loaded_bytes", traffic.loaded_bytes);
        span.record("stored_bytes", traffic.stored_bytes);
    }
}

#[cfg(not(feature = "tracing"))]
mod without_tracing {
    use framegraph::Plan;

    /// Replaces a span. Its fields are not evaluated.
    #[must_use]
    pub(crate) struct NoSpan;

    macro_rules! span {
        ($name:literal in $parent:expr) => {
            ($parent, crate::spans::NoSpan)
        };
        ($name:literal $(, $field:ident = $value:expr)* $(; $($later:ident),*)?) => {
            crate::spans::NoSpan
        };
    }
    pub(crate) use span;

    #[inline(always)]
    pub(crate) fn here() -> NoSpan {
        NoSpan
    }

    #[inline(always)]
    pub(crate) fn executed(_: &NoSpan, _: &Plan) {}
}
