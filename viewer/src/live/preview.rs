//! Texture preview of the live frame: any version, mip level, layer, plane and sample, as numbers and as a picture. It
//! executes a second plan, so the frame's own plan is unchanged.

use super::frame::Running;
use framegraph_wgpu::inspect::{Channel, DisplayImage, DisplayMode, InspectTarget, Inspector, Texels, all_targets};

/// Number of histogram bins.
pub const BINS: usize = 64;

/// Inspected texture.
pub struct Found {
    /// Description.
    pub title: String,
    /// Texels.
    pub texels: Texels,
    /// Texels as numbers.
    pub numbers: Vec<[f32; 4]>,
    /// Minimum and maximum finite values of the existing channels; 0 if none is finite.
    pub span: [f32; 2],
    /// Displayed picture.
    pub picture: DisplayImage,
    /// Number of the picture, for caching.
    pub made: u64,
    /// Histogram of each channel over the displayed range.
    pub histogram: Vec<[u32; BINS]>,
}

/// State of the texture preview.
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
    /// Display mode.
    pub mode: DisplayMode,
    /// Updates the preview in every frame.
    pub follow: bool,
    /// Last inspected texture.
    pub found: Option<Found>,
    /// Reason that inspection failed.
    pub error: Option<String>,
    inspector: Option<Inspector>,
    asked: Option<(InspectTarget, u64)>,
    shown: Option<DisplayMode>,
    made: u64,
}

impl Default for Preview {
    fn default() -> Self {
        Self {
            name: None,
            version: None,
            mip: 0,
            layer: 0,
            plane: 0,
            sample: None,
            mode: DisplayMode::Auto,
            follow: false,
            found: None,
            error: None,
            inspector: None,
            asked: None,
            shown: None,
            made: 0,
        }
    }
}

impl Preview {
    /// Selects another resource, with its newest version and first subresource.
    pub fn look_at(&mut self, name: &str) {
        if self.name.as_deref() == Some(name) {
            return;
        }
        self.name = Some(name.to_owned());
        (self.version, self.mip, self.layer, self.plane, self.sample) = (None, 0, 0, 0, None);
        self.asked = None;
    }

    /// Inspects the texture again in the next frame.
    pub fn again(&mut self) {
        self.asked = None;
    }

    /// Returns the inspectable subresources of the resource.
    pub fn targets(&self, running: &Running) -> Vec<InspectTarget> {
        let Some(name) = &self.name else { return Vec::new() };
        let graph = running.plan().graph();
        let resource = |target: &InspectTarget| graph.versions()[target.version.index()].resource;
        // Plan rows number resources of equal names, in order.
        let (plain, number) = match name.rsplit_once('#').map(|(plain, number)| (plain, number.parse::<usize>())) {
            Some((plain, Ok(number))) => (plain, number.max(1)),
            _ => (name.as_str(), 1),
        };
        let mut all = all_targets(running.plan());
        all.retain(|target| target.name == plain);
        let mut of_name: Vec<_> = all.iter().map(resource).collect();
        of_name.sort_unstable();
        of_name.dedup();
        let own = of_name.get(number - 1).copied();
        all.retain(|target| Some(resource(target)) == own);
        all
    }

    /// Returns the selected subresource.
    fn target(&self, targets: &[InspectTarget]) -> Option<InspectTarget> {
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
        found.sample = self.sample;
        Some(found)
    }

    /// Inspects the texture after a change of the selection; `frame` identifies the drawn frame if the preview follows.
    pub fn refresh(&mut self, running: &Running, frame: u64) {
        let targets = self.targets(running);
        let Some(target) = self.target(&targets) else {
            (self.found, self.error) =
                (None, self.name.as_ref().map(|name| format!("`{name}` has no texels in this frame")));
            return;
        };
        let frame = if self.follow { frame } else { running.plans() };
        let asked = (target, frame);
        if self.asked.as_ref() != Some(&asked) {
            self.shown = None;
            match self.look(running, &asked.0) {
                Ok(found) => (self.found, self.error) = (Some(found), None),
                Err(error) => (self.found, self.error) = (None, Some(error)),
            }
            self.asked = Some(asked);
        }
        self.display(running);
    }

    fn look(&mut self, running: &Running, target: &InspectTarget) -> Result<Found, String> {
        let frames = running.frames();
        let inspector = self.inspector.get_or_insert_with(|| Inspector::new(&running.screen().gpu));
        let (executor, plan, world) = (frames.executor(), frames.plan(), &running.loaded.world);
        let found = inspector.inspect_target(executor, plan, frames.frame(), world, frames.imports(), target.clone());
        let found = found.map_err(|e| e.to_string())?;
        let (title, numbers) = (found.title(), found.texels.numbers());
        let picture = DisplayImage { rgba8: Vec::new(), range: [0.0; 2], non_finite: 0 };
        let span = span(&numbers, found.texels.channels());
        Ok(Found { title, texels: found.texels, numbers, span, picture, made: 0, histogram: Vec::new() })
    }

    /// Converts the texels to a picture after a change of the display mode.
    fn display(&mut self, running: &Running) {
        if self.shown == Some(self.mode) {
            return;
        }
        let near_m = running.rig.camera(None).projection.near_m() as f32;
        if let Some(found) = &mut self.found {
            found.picture = found.texels.display(self.mode, near_m);
            self.made += 1;
            found.made = self.made;
            found.histogram = histogram(&found.numbers, found.texels.channels(), found.span);
            self.shown = Some(self.mode);
        }
    }
}

impl Found {
    /// Returns the values of a texel; `None` outside the picture.
    pub fn texel(&self, [x, y]: [u32; 2]) -> Option<[f32; 4]> {
        let [width, height] = self.texels.size;
        (x < width && y < height).then(|| self.numbers[(y * width + x) as usize])
    }
}

/// Returns the minimum and maximum finite values of the first `channels` channels; 0 if none is finite.
fn span(numbers: &[[f32; 4]], channels: usize) -> [f32; 2] {
    let finite = numbers.iter().flat_map(|texel| &texel[..channels]).copied().filter(|x| x.is_finite());
    let [low, high] = finite.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
    if low <= high { [low, high] } else { [0.0; 2] }
}

/// Counts the values of each channel per bin of a range; NaN and infinity are ignored.
pub fn histogram(numbers: &[[f32; 4]], channels: usize, [low, high]: [f32; 2]) -> Vec<[u32; BINS]> {
    let mut all = vec![[0; BINS]; channels];
    let per_bin = (high - low) / BINS as f32;
    for texel in numbers {
        for (boxes, number) in all.iter_mut().zip(texel).filter(|(_, number)| number.is_finite()) {
            let at = if per_bin > 0.0 { ((number - low) / per_bin) as usize } else { 0 };
            boxes[at.min(BINS - 1)] += 1;
        }
    }
    all
}

/// Channels by name.
pub const CHANNELS: [(&str, Channel); 4] =
    [("red", Channel::Red), ("green", Channel::Green), ("blue", Channel::Blue), ("alpha", Channel::Alpha)];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_finite_value_is_in_one_bin() {
        let numbers = [[0.0, 1.0, f32::NAN, 1.0], [0.5, -1.0, 2.0, 1.0], [1.0, f32::INFINITY, 0.0, 1.0]];
        let found = histogram(&numbers, 3, [-1.0, 2.0]);
        let sums: Vec<u32> = found.iter().map(|boxes| boxes.iter().sum()).collect();
        assert_eq!(sums, [3, 2, 2]);
        assert_eq!((found[1][0], found[2][BINS - 1]), (1, 1));
        assert_eq!(histogram(&[[5.0; 4]], 1, [5.0, 5.0])[0][0], 1);
    }
}
