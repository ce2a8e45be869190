//! What was measured on its way to the CPU: frames late, and never waited for.

use super::wanted::MeasuredTextures;
use crate::gpu_scene::previous_view::PreviousView;
use framegraph::{Plan, Texture};
use framegraph_wgpu::{Executor, Gpu, Pixels, Readback, ReadbackError, Subresource};
use std::collections::VecDeque;

/// What is older than so many frames is not known any more.
const OLDEST_FRAMES: u64 = 8;
/// So many frames are on their way at most; those between are not measured.
const MAX_FLIGHTS: usize = 4;

/// What is known of frames before by measuring them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Measurement {
    /// Nothing is measured.
    #[default]
    Off,
    /// It is measured, and nothing has come yet, or what has come is too old.
    Unknown,
    /// The youngest that has come.
    Known(Measured),
}

/// What a frame had.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// The brightest channel of all pixels in nits, before depth of field and bloom; none if that was not measured.
    pub most_nits: Option<f32>,
    /// Distance from the eye's plane of the nearest and the farthest that was seen, in m, infinite for the sky; none if that
    /// was not measured, or not through a perspective.
    pub distances_m: Option<[f64; 2]>,
    /// How many frames ago that was, at least 1.
    pub frames_ago: u32,
}

/// How often what was measured had come when it was looked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeasureCounts {
    /// Frames that were measured.
    pub begun: u32,
    /// Frames whose measures have come.
    pub come: u32,
    /// Frames that were not measured, since others were still on their way.
    pub left_out: u32,
}

/// Kept by the caller from frame to frame, one for each view that is measured.
#[derive(Debug, Default)]
pub struct Measuring {
    frame: u64,
    flights: VecDeque<Flight>,
    latest: Option<(u64, Measured)>,
    counts: MeasureCounts,
}

/// A frame on its way.
#[derive(Debug)]
struct Flight {
    frame: u64,
    stand: PreviousView,
    light: Option<Arriving>,
    depth: Option<Arriving>,
}

/// A copy that has come, or not yet.
#[derive(Debug)]
enum Arriving {
    Away(Readback),
    Here(Pixels),
}

impl Arriving {
    fn look(self, gpu: &Gpu) -> Result<Self, ReadbackError> {
        match self {
            Self::Away(readback) => Ok(match readback.try_take(gpu)? {
                Ok(pixels) => Self::Here(pixels),
                Err(readback) => Self::Away(readback),
            }),
            here => Ok(here),
        }
    }

    /// The most and the least of all texels, where they have come.
    fn both(&self) -> Option<[f32; 2]> {
        match self {
            Self::Away(_) => None,
            Self::Here(pixels) => Some(
                pixels
                    .rgba()
                    .iter()
                    .fold([0.0_f32, f32::INFINITY], |[most, least], texel| [most.max(texel[0]), least.min(texel[1])]),
            ),
        }
    }
}

impl Measuring {
    /// None yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Begins to copy what the frame that was executed last has measured, if it has; `stand` is the view's.
    ///
    /// # Errors
    /// When the device fails.
    pub fn begin(
        &mut self,
        gpu: &Gpu,
        (executor, plan): (&Executor, &Plan),
        textures: MeasuredTextures,
        stand: PreviousView,
    ) -> Result<(), ReadbackError> {
        self.frame += 1;
        if textures.light.is_none() && textures.depth.is_none() {
            return Ok(());
        }
        if self.flights.len() >= MAX_FLIGHTS {
            self.counts.left_out += 1;
            return Ok(());
        }
        let copy = |handle: Option<Texture>| match handle.and_then(|handle| executor.texture(plan, handle)) {
            Some(texture) => Readback::start(gpu, texture, Subresource::FIRST).map(|copy| Some(Arriving::Away(copy))),
            None => Ok(None),
        };
        let flight = Flight { frame: self.frame, stand, light: copy(textures.light)?, depth: copy(textures.depth)? };
        self.flights.push_back(flight);
        self.counts.begun += 1;
        Ok(())
    }

    /// What is known for the frame that is decided next. Never waits.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn known(&mut self, gpu: &Gpu) -> Result<Measurement, ReadbackError> {
        while let Some(flight) = self.flights.pop_front() {
            let look = |arriving: Option<Arriving>| arriving.map(|arriving| arriving.look(gpu)).transpose();
            let flight = Flight { light: look(flight.light)?, depth: look(flight.depth)?, ..flight };
            let away = |arriving: &Option<Arriving>| matches!(arriving, Some(Arriving::Away(_)));
            if away(&flight.light) || away(&flight.depth) {
                self.flights.push_front(flight);
                break;
            }
            self.counts.come += 1;
            self.latest = Some((flight.frame, flight.measured()));
        }
        let next = self.frame + 1;
        Ok(match self.latest.filter(|(frame, _)| next - frame <= OLDEST_FRAMES) {
            Some((frame, measured)) => Measurement::Known(Measured { frames_ago: (next - frame) as u32, ..measured }),
            None => Measurement::Unknown,
        })
    }

    /// Forgets what was measured, for a view that looks elsewhere at once.
    pub fn forget(&mut self) {
        self.flights.clear();
        self.latest = None;
    }

    /// How often it had come.
    pub fn counts(&self) -> MeasureCounts {
        self.counts
    }
}

impl Flight {
    fn measured(&self) -> Measured {
        let both = |arriving: &Option<Arriving>| arriving.as_ref().and_then(Arriving::both);
        let row = self.stand.projection().depth.as_dvec4();
        let distance_m = |depth: f32| {
            let depth = f64::from(depth);
            let per_m = (depth * row.z - row.x) / (depth * row.w - row.y);
            if per_m > 0.0 { per_m.recip() } else { f64::INFINITY }
        };
        // The w of a parallel projection does not depend on z.
        let perspective = row.z != 0.0;
        Measured {
            most_nits: both(&self.light).map(|[most, _]| most / self.stand.exposure),
            distances_m: both(&self.depth).filter(|_| perspective).map(|depths| depths.map(distance_m)),
            frames_ago: 1,
        }
    }
}
