//! Measurements on their way to the CPU: some frames late, without waiting.

use super::wanted::MeasuredTextures;
use crate::gpu_scene::previous_view::PreviousView;
use framegraph::{Plan, Texture};
use framegraph_wgpu::{Executor, Gpu, Pixels, Readback, ReadbackError, Subresource};
use std::collections::VecDeque;

/// Measurements older than this number of frames are ignored.
const OLDEST_FRAMES: u64 = 8;
/// Maximum number of frames in flight; further frames are not measured.
const MAX_FLIGHTS: usize = 4;

/// Latest measurement of earlier frames.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Measurement {
    /// Measuring is off.
    #[default]
    Off,
    /// Nothing has arrived yet, or it is too old.
    Unknown,
    /// The latest measurement that has arrived.
    Known(Measured),
}

/// Measurement of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Brightest channel of all pixels in nits, before depth of field and bloom; `None` if not measured.
    pub most_nits: Option<f32>,
    /// Distance of the nearest and the farthest surface from the eye plane, in meters; infinite for the background.
    /// `None` if not measured, or without a perspective projection.
    pub distances_m: Option<[f64; 2]>,
    /// Age in frames, at least 1.
    pub frames_ago: u32,
}

/// Number of readbacks that were started, arrived and were skipped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeasureCounts {
    /// Number of measured frames.
    pub begun: u32,
    /// Number of frames whose measurements have arrived.
    pub come: u32,
    /// Number of frames not measured because too many were in flight.
    pub left_out: u32,
}

/// Measurements of a view. Kept by the caller from frame to frame, one for each measured view.
#[derive(Debug, Default)]
pub struct Measuring {
    frame: u64,
    flights: VecDeque<Flight>,
    latest: Option<(u64, Measured)>,
    counts: MeasureCounts,
}

/// A frame in flight.
#[derive(Debug)]
struct Flight {
    frame: u64,
    stand: PreviousView,
    light: Option<Arriving>,
    depth: Option<Arriving>,
}

/// A readback that is pending or has arrived.
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

    /// Returns the maximum and minimum of all texels, if they have arrived.
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
    /// Creates an empty history.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Starts to read back the measurements of the frame executed last, if any. `stand` is the view of that frame.
    ///
    /// # Errors
    /// Fails if the device fails.
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

    /// Returns the latest measurement, for decisions about the next frame. Never waits.
    ///
    /// # Errors
    /// Fails if the device is lost.
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

    /// Discards all measurements, for example after a camera cut.
    pub fn forget(&mut self) {
        self.flights.clear();
        self.latest = None;
    }

    /// Returns the number of readbacks so far.
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
        // For a parallel projection, w does not depend on z.
        let perspective = row.z != 0.0;
        Measured {
            most_nits: both(&self.light).map(|[most, _]| most / self.stand.exposure),
            distances_m: both(&self.depth).filter(|_| perspective).map(|depths| depths.map(distance_m)),
            frames_ago: 1,
        }
    }
}
