//! Light lists by froxel, and a report on the lights of a scene.

use super::assign::froxels_of;
use super::grid::FroxelGrid;
use super::reach::Reach;
use super::select::{DropReason, Selection};
use super::settings::{FroxelSettings, LightSearch};
use crate::gpu_scene::shadow_views::FitCamera;
use framegraph_scene::Renderables;
use framegraph_shaders::layout::FroxelUniforms;
use glam::DQuat;

/// Maximum number of entries of all lists, 16 MiB.
const MAX_ENTRIES: usize = 1 << 22;

/// Light lists by froxel, in the layout of shaders.
#[derive(Clone, Debug, PartialEq)]
pub struct LightLists {
    /// Froxel grid of the view.
    pub uniforms: FroxelUniforms,
    /// Start of each froxel's list, and the end of the last one; then the lists of light indices in increasing order.
    pub words: Vec<u32>,
}

impl LightLists {
    /// Number of storage buffers of a fragment stage with lists: lights, lists and shadow maps.
    const STORAGE_BUFFERS: u32 = 3;

    /// Returns true if a device with these limits can bind light lists in addition to the other bindings of shading.
    /// Otherwise every light is evaluated everywhere, with the same picture.
    pub fn can_be_bound(limits: &wgpu::Limits) -> bool {
        limits.max_storage_buffers_per_shader_stage >= Self::STORAGE_BUFFERS
    }

    /// Returns the list of froxel `number`.
    ///
    /// # Panics
    /// Panics if the froxel does not exist.
    pub fn list(&self, number: usize) -> &[u32] {
        let [begin, end] = [self.words[number], self.words[number + 1]];
        &self.words[begin as usize..end as usize]
    }

    /// Builds lists from the froxels of each light; `None` if there are too many entries. Lights without a range,
    /// `everywhere` of them, come first.
    fn new(grid: &FroxelGrid, reaches: &[Reach], view_from_world: DQuat, everywhere: u32) -> Option<Self> {
        let count = grid.count();
        let mut hits: Vec<[u32; 2]> = Vec::new();
        for (light, reach) in (everywhere..).zip(reaches) {
            froxels_of(grid, reach, view_from_world, |froxel| hits.push([froxel, light]));
            if hits.len() > MAX_ENTRIES {
                return None;
            }
        }
        let head = count + 1;
        let mut words = vec![0; head + hits.len()];
        // Counts the entries of each list, then sums them into offsets.
        for [froxel, _] in &hits {
            words[*froxel as usize + 1] += 1;
        }
        words[0] = head as u32;
        for froxel in 0..count {
            words[froxel + 1] += words[froxel];
        }
        let mut next = words[..count].to_vec();
        for [froxel, light] in hits {
            let place = &mut next[froxel as usize];
            words[*place as usize] = light;
            *place += 1;
        }
        Some(Self { uniforms: grid.uniforms(everywhere), words })
    }
}

/// Report on the lights of a scene in a view. The sun is not counted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightReport {
    /// Number of lights that are kept.
    pub kept: usize,
    /// Indices of dropped lights in the scene, with reasons.
    pub dropped: Vec<(usize, DropReason)>,
    /// Method of finding the lights that are kept.
    pub found: Found,
}

/// Method of finding lights in a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Found {
    /// Light lists by froxel.
    ByFroxels {
        /// Number of tiles across and down, and of slices.
        counts: [u32; 3],
        /// Number of lights without a finite range, which are in no list.
        everywhere: usize,
        /// Number of entries of all lists.
        entries: usize,
        /// Number of entries of the longest list.
        longest: usize,
    },
    /// Every light is evaluated everywhere.
    All(LookedAtAll),
}

/// Reason for evaluating every light everywhere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LookedAtAll {
    /// Requested, or there are no lights.
    #[default]
    Asked,
    /// Number of lights with a finite range, too few for lists to be faster.
    Few(usize),
    /// The lists would have too many entries.
    TooLong,
}

impl Default for Found {
    fn default() -> Self {
        Self::All(LookedAtAll::Asked)
    }
}

impl std::fmt::Display for LightReport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} of {} lights shade, ", self.kept, self.kept + self.dropped.len())?;
        match self.found {
            Found::ByFroxels { counts: [x, y, z], everywhere, entries, longest } => {
                let mean = entries as f64 / f64::from(x * y * z);
                write!(f, "by {x}x{y}x{z} froxels, {mean:.2} a list, at most {longest}")?;
                if everywhere > 0 {
                    write!(f, ", and {everywhere} without an end")?;
                }
            }
            Found::All(why) => {
                f.write_str("all of them looked at everywhere")?;
                match why {
                    LookedAtAll::Asked => {}
                    LookedAtAll::Few(count) => write!(f, ": {count} that have an end are few")?,
                    LookedAtAll::TooLong => write!(f, ": lists would have more than {MAX_ENTRIES} entries")?,
                }
            }
        }
        let mut groups: Vec<(String, usize)> = Vec::new();
        for reason in self.dropped.iter().map(|(_, reason)| reason.to_string()) {
            match groups.iter_mut().find(|(own, _)| *own == reason) {
                Some((_, count)) => *count += 1,
                None => groups.push((reason, 1)),
            }
        }
        for (index, (reason, count)) in groups.iter().enumerate() {
            write!(f, "{} {count} {reason}", if index == 0 { "; dropped:" } else { "," })?;
        }
        Ok(())
    }
}

/// Returns the light lists of a view, if it uses them, and the report.
pub(crate) fn lists(
    scene: &Renderables,
    selection: Selection<'_>,
    camera: &FitCamera<'_>,
    size_px: [u32; 2],
    search: LightSearch,
) -> (Option<LightLists>, LightReport) {
    let Selection { kept, everywhere, dropped } = selection;
    let ending = kept.len() - everywhere;
    let report = |found| LightReport { kept: kept.len(), dropped, found };
    let settings: FroxelSettings = match search {
        LightSearch::All => return (None, report(Found::All(LookedAtAll::Asked))),
        LightSearch::Auto(_) if ending < LightSearch::FEW => {
            return (None, report(Found::All(LookedAtAll::Few(ending))));
        }
        LightSearch::Auto(settings) | LightSearch::Froxels(settings) => settings,
    };
    let grid = FroxelGrid::new(camera, size_px, &settings);
    let bounds = scene.whole();
    let of = |light: &&framegraph_scene::Light| Reach::of(light, camera.camera.eye, &bounds);
    let reaches: Vec<Reach> = kept[everywhere..].iter().filter_map(of).collect();
    let view_from_world = camera.camera.world_from_view.inverse();
    let Some(lists) = LightLists::new(&grid, &reaches, view_from_world, everywhere as u32) else {
        return (None, report(Found::All(LookedAtAll::TooLong)));
    };
    let longest = (0..grid.count()).map(|froxel| lists.list(froxel).len()).max().unwrap_or(0);
    let entries = lists.words.len() - grid.count() - 1;
    (Some(lists), report(Found::ByFroxels { counts: grid.counts, everywhere, entries, longest }))
}
