//! GPU timestamps: written by steps, resolved at the end of the frame, and mapped when the GPU is done.

use crate::device::gpu::Gpu;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use wgpu::{Buffer, BufferDescriptor, BufferUsages, CommandEncoder, MapMode, QuerySet, QuerySetDescriptor, QueryType};

const IDLE: u8 = 0;
const WAITING: u8 = 1;
const READY: u8 = 2;
const FAILED: u8 = 3;

/// Timestamp queries of one frame, with the buffers to read them.
#[derive(Debug)]
pub(crate) struct FrameTimestamps {
    queries: QuerySet,
    resolved: Buffer,
    read: Buffer,
    state: Arc<AtomicU8>,
    /// Plan that the frame executed, as a number that changes with the steps.
    pub(crate) generation: u64,
    /// Number of queries that the frame writes.
    pub(crate) used: u32,
    /// True if the frame counts for statistics.
    pub(crate) counted: bool,
    /// Frame number for the trace, if enabled.
    pub(crate) frame: Option<u64>,
}

impl FrameTimestamps {
    pub(crate) fn new(gpu: &Gpu, count: u32) -> Self {
        let size = u64::from(count) * 8;
        let buffer = |label, usage| {
            gpu.device.create_buffer(&BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        Self {
            queries: gpu.device.create_query_set(&QuerySetDescriptor {
                label: Some("timestamps"),
                ty: QueryType::Timestamp,
                count,
            }),
            resolved: buffer("timestamps resolved", BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC),
            read: buffer("timestamps read", BufferUsages::MAP_READ | BufferUsages::COPY_DST),
            state: Arc::new(AtomicU8::new(IDLE)),
            generation: 0,
            used: 0,
            counted: false,
            frame: None,
        }
    }

    /// Returns the query set that steps write to.
    pub(crate) fn queries(&self) -> &QuerySet {
        &self.queries
    }

    /// Returns the number of queries in the set.
    pub(crate) fn capacity(&self) -> u32 {
        self.queries.count()
    }

    /// Returns whether no frame is using the queries.
    pub(crate) fn is_idle(&self) -> bool {
        self.state.load(Ordering::Acquire) == IDLE
    }

    /// Resolves the queries and copies them to the readable buffer, at the end of the frame.
    pub(crate) fn resolve(&self, encoder: &mut CommandEncoder) {
        encoder.resolve_query_set(&self.queries, 0..self.used, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.read, 0, u64::from(self.used) * 8);
    }

    /// Requests mapping of the buffer, after the frame was submitted.
    pub(crate) fn map(&self) {
        self.state.store(WAITING, Ordering::Release);
        let state = self.state.clone();
        self.read.map_async(MapMode::Read, ..u64::from(self.used) * 8, move |mapped| {
            state.store(if mapped.is_ok() { READY } else { FAILED }, Ordering::Release);
        });
    }

    /// Returns the timestamps if they have arrived, and makes the queries idle again.
    pub(crate) fn take(&self) -> Option<Vec<u64>> {
        let taken = match self.state.load(Ordering::Acquire) {
            READY => {
                let mapped = self.read.get_mapped_range(..u64::from(self.used) * 8);
                let words = |bytes: wgpu::BufferView| {
                    bytes.as_chunks::<8>().0.iter().map(|bytes| u64::from_le_bytes(*bytes)).collect()
                };
                let timestamps = mapped.map(words).ok();
                self.read.unmap();
                timestamps
            }
            FAILED => None,
            _ => return None,
        };
        self.state.store(IDLE, Ordering::Release);
        taken
    }
}

/// Interval of GPU time, in nanoseconds of the GPU's clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Span {
    pub(crate) begin_ns: f64,
    pub(crate) end_ns: f64,
}

impl Span {
    pub(crate) fn ms(self) -> f64 {
        (self.end_ns - self.begin_ns) * 1e-6
    }
}

/// GPU time intervals of the steps of a frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StepSpans {
    /// Interval of each step; `None` if it was not measured or its timestamps are invalid.
    pub(crate) steps: Vec<Option<Span>>,
    /// True if all measured steps have valid intervals.
    complete: bool,
}

impl StepSpans {
    /// Converts timestamps to intervals. `queries` has the index of the first of two queries of each step.
    ///
    /// A timestamp of 0 was not written. An end that is not after its begin comes from a wrapped counter or a driver
    /// that gave up. Both are dropped.
    pub(crate) fn new(timestamps: &[u64], queries: &[Option<u32>], period_ns: f64) -> Self {
        let span = |query: u32| {
            let pair = timestamps.get(query as usize).zip(timestamps.get(query as usize + 1));
            let (begin, end) = pair.filter(|(begin, end)| **begin != 0 && end > begin)?;
            Some(Span { begin_ns: *begin as f64 * period_ns, end_ns: *end as f64 * period_ns })
        };
        let steps: Vec<_> = queries.iter().map(|query| query.and_then(span)).collect();
        let complete = steps.iter().zip(queries).all(|(span, query)| span.is_some() || query.is_none());
        Self { steps, complete }
    }

    /// Returns the interval from the first to the last timestamp of the frame. `None` if a step is invalid, or the
    /// counter wrapped between two steps.
    pub(crate) fn frame(&self) -> Option<Span> {
        let mut spans = self.steps.iter().flatten();
        let first = *spans.next().filter(|_| self.complete)?;
        let (mut end_ns, mut begun) = (first.end_ns, first.begin_ns);
        for span in spans {
            if span.begin_ns < begun {
                return None;
            }
            (end_ns, begun) = (end_ns.max(span.end_ns), span.begin_ns);
        }
        Some(Span { begin_ns: first.begin_ns, end_ns })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAIRS: [Option<u32>; 3] = [Some(0), None, Some(2)];

    fn ms(timestamps: &[u64]) -> (Vec<Option<f64>>, Option<f64>) {
        let measured = StepSpans::new(timestamps, &PAIRS, 2.0);
        (measured.steps.iter().map(|s| s.map(Span::ms)).collect(), measured.frame().map(Span::ms))
    }

    #[test]
    fn valid_timestamps_become_durations() {
        let found = ms(&[1_000_000, 3_000_000, 3_500_000, 4_000_000]);
        assert_eq!(found, (vec![Some(4.0), None, Some(1.0)], Some(6.0)));
    }

    #[test]
    fn invalid_timestamps_invalidate_their_frame() {
        assert_eq!(ms(&[0, 3_000_000, 3_500_000, 4_000_000]), (vec![None, None, Some(1.0)], None), "not written");
        assert_eq!(ms(&[5, 5, 3_500_000, 4_000_000]), (vec![None, None, Some(1.0)], None), "no time passed");
        assert_eq!(ms(&[u64::MAX - 5, 10, 20, 500_020]), (vec![None, None, Some(1.0)], None), "wrapped within a step");
        let wrapped = ms(&[u64::MAX - 500_000, u64::MAX, 20, 500_020]);
        assert_eq!(wrapped.1, None, "wrapped between two steps");
        assert_eq!(ms(&[1, 500_001]), (vec![Some(1.0), None, None], None), "timestamps are missing");
    }
}
