//! Texture preview of the live frame: any version, mip level, layer, plane and sample, as numbers and as a picture. It
//! executes a second plan, so the frame's own plan is unchanged.

pub mod look;
pub mod pan;
mod picture;
mod read;
mod save;

pub use read::{BINS, Found, histogram, read};
pub use save::save;

use super::frame::Running;
use crate::job::Job;
use framegraph::Plan;
use framegraph_wgpu::inspect::{InspectTarget, Inspector, all_targets};
use look::Look;
use pan::Pan;
use std::sync::Arc;
use std::time::Duration;

/// Maximum time that panels wait for a picture.
const PATIENCE: Duration = Duration::from_millis(10);

/// Displayed picture of a texture.
pub struct Picture {
    /// RGBA, 8 bits per channel.
    pub rgba8: Vec<u8>,
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Number of the picture, for caching.
    pub made: u64,
}

/// State of the texture preview.
#[derive(Default)]
pub struct Preview {
    /// Full name of the resource.
    pub name: Option<String>,
    /// Number of the version; `None` for the newest.
    pub version: Option<usize>,
    /// Mip level.
    pub mip: u8,
    /// Array layer or slice.
    pub layer: u16,
    /// Index of the plane among the existing ones.
    pub plane: usize,
    /// Sample; `None` for the average.
    pub sample: Option<u8>,
    /// Channels and range.
    pub look: Look,
    /// Zoom and position.
    pub pan: Pan,
    /// Updates the preview in every frame.
    pub follow: bool,
    /// Inspectable subresources of the resource.
    pub targets: Vec<InspectTarget>,
    /// Last inspected texture.
    pub found: Option<Arc<Found>>,
    /// Picture of the texture.
    pub picture: Option<Picture>,
    /// Texel whose values stay visible.
    pub pinned: Option<[u32; 2]>,
    /// Reason that inspection failed.
    pub error: Option<String>,
    /// Typed path of the file to save.
    pub path: String,
    /// Result of saving.
    pub saved: Option<Result<String, String>>,
    inspector: Option<Inspector>,
    listed: Option<(String, u64)>,
    /// Last request: the target, whether the preview followed, and the number of the frame or else of the plan.
    asked: Option<(InspectTarget, bool, u64)>,
    reading: bool,
    /// Resource and plane for which the look was chosen.
    looked: Option<(String, usize)>,
    drawing: Option<Job<Vec<u8>>>,
    drawn: Option<(Look, u64)>,
    finds: u64,
}

impl Preview {
    /// Selects another resource, with its newest version and first subresource.
    pub fn look_at(&mut self, name: &str) {
        if self.name.as_deref() == Some(name) {
            return;
        }
        self.name = Some(name.to_owned());
        (self.version, self.mip, self.layer, self.plane, self.sample) = (None, 0, 0, 0, None);
        (self.asked, self.pinned, self.saved) = (None, None, None);
        self.pan = Pan::default();
    }

    /// Inspects the texture again in the next frame.
    pub fn again(&mut self) {
        self.asked = None;
    }

    /// Returns whether a texture is being read.
    pub fn is_reading(&self) -> bool {
        self.reading
    }

    /// Lists the inspectable subresources of the resource after a change of the plan, which a number identifies.
    fn list(&mut self, plan: &Plan, plans: u64) {
        let Some(name) = self.name.clone() else { return };
        let listed = (name, plans);
        if self.listed.as_ref() == Some(&listed) {
            return;
        }
        let name = &listed.0;
        let graph = plan.graph();
        let resource = |target: &InspectTarget| graph.versions()[target.version.index()].resource;
        // Plan rows number resources of equal names, in order.
        let (plain, number) = match name.rsplit_once('#').map(|(plain, number)| (plain, number.parse::<usize>())) {
            Some((plain, Ok(number))) => (plain, number.max(1)),
            _ => (name.as_str(), 1),
        };
        let mut all = all_targets(plan);
        all.retain(|target| target.name == plain);
        let mut of_name: Vec<_> = all.iter().map(resource).collect();
        of_name.sort_unstable();
        of_name.dedup();
        let own = of_name.get(number - 1).copied();
        all.retain(|target| Some(resource(target)) == own);
        (self.targets, self.listed) = (all, Some(listed));
    }

    /// Returns the selected subresource.
    fn target(&self) -> Option<InspectTarget> {
        let targets = &self.targets;
        let newest = targets.iter().map(|target| target.number).max()?;
        let number = self.version.filter(|v| targets.iter().any(|t| t.number == *v)).unwrap_or(newest);
        let of_version: Vec<&InspectTarget> = targets.iter().filter(|target| target.number == number).collect();
        let mut planes: Vec<_> = of_version.iter().map(|target| target.aspect).collect();
        planes.dedup();
        let aspect = *planes.get(self.plane).or(planes.first())?;
        let is_asked =
            |target: &&&InspectTarget| target.aspect == aspect && target.mip == self.mip && target.layer == self.layer;
        let found = of_version.iter().find(is_asked).or(of_version.first())?;
        let mut found = (*found).clone();
        found.sample = self.sample.or(found.sample);
        Some(found)
    }

    /// Returns the subresource to read after a change of the selection, with the inspector to use. `frame` identifies the
    /// drawn frame if the preview follows.
    pub(super) fn begin(&mut self, running: &Running, frame: u64) -> Option<(InspectTarget, Inspector)> {
        let target = self.begin_of(running.plan(), running.plans(), frame)?;
        let inspector = self.inspector.take().unwrap_or_else(|| Inspector::new(&running.screen().gpu));
        Some((target, inspector))
    }

    /// Returns the subresource of a plan to read, like [`begin`](Self::begin). `plans` identifies the plan.
    pub(crate) fn begin_of(&mut self, plan: &Plan, plans: u64, frame: u64) -> Option<InspectTarget> {
        self.list(plan, plans);
        let Some(target) = self.target() else {
            (self.found, self.picture) = (None, None);
            self.error = self.name.as_ref().map(|name| format!("`{name}` has no texels in this frame"));
            return None;
        };
        let asked = (target, self.follow, if self.follow { frame } else { plans });
        if self.reading || self.asked.as_ref() == Some(&asked) {
            return None;
        }
        self.reading = true;
        let target = asked.0.clone();
        self.asked = Some(asked);
        Some(target)
    }

    /// Ends reading without a result, because the thread that read the texture panicked.
    pub(crate) fn interrupted(&mut self) {
        self.reading = false;
    }

    /// Takes the result of reading a subresource. Ignores it if another one is selected by now.
    pub(super) fn take(&mut self, inspector: Inspector, target: &InspectTarget, result: Result<Found, String>) {
        self.inspector = Some(inspector);
        self.take_found(target, result);
    }

    /// Takes texels like [`take`](Self::take).
    pub(crate) fn take_found(&mut self, target: &InspectTarget, result: Result<Found, String>) {
        self.reading = false;
        let is_listed = self.name.is_some() && self.name.as_ref() == self.listed.as_ref().map(|(name, _)| name);
        if !is_listed || self.target().as_ref() != Some(target) {
            self.asked = None;
            return;
        }
        match result {
            Ok(found) => {
                let looked = (self.name.clone().unwrap_or_default(), self.plane);
                if self.looked.as_ref() != Some(&looked) {
                    (self.look, self.looked) = (Look::natural(&found), Some(looked));
                }
                self.finds += 1;
                (self.found, self.error) = (Some(Arc::new(found)), None);
            }
            Err(error) => (self.found, self.picture, self.error) = (None, None, Some(error)),
        }
    }

    /// Creates the picture after a change of the texture or the look, on another thread that calls `wake` at the end.
    /// Waits at most some milliseconds, or until it is finished if `blocking` is set.
    pub fn display(&mut self, blocking: bool, wake: impl FnOnce() + Send + 'static) {
        let Some(found) = self.found.clone() else { return };
        let wanted = (self.look.clone(), self.finds);
        if self.drawn.as_ref() != Some(&wanted) && self.drawing.is_none() {
            let (look, texture) = (self.look.clone(), found.clone());
            self.drawing = Some(Job::start("drawing a texture", wake, move |_| picture::picture(&texture, &look)));
            self.drawn = Some(wanted);
        }
        let patience = if blocking { Duration::from_secs(600) } else { PATIENCE };
        let Some(job) = &self.drawing else { return };
        let Some(result) = job.wait(patience) else { return };
        let failure = job.failure();
        self.drawing = None;
        let Ok(rgba8) = result else {
            (self.picture, self.error) = (None, Some(failure));
            return;
        };
        let made = self.picture.as_ref().map_or(0, |picture| picture.made) + 1;
        if rgba8.len() == found.numbers.len() * 4 {
            self.picture = Some(Picture { rgba8, size: found.texels.size, made });
        } else {
            // The texture changed in the meantime.
            self.drawn = None;
        }
    }
}
