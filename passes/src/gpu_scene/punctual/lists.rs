//! The lists of lights by froxel, and what became of a scene's lights.

use super::assign::froxels_of;
use super::grid::FroxelGrid;
use super::reach::Reach;
use super::select::{DropReason, Selection};
use super::settings::{FroxelSettings, LightSearch};
use crate::gpu_scene::shadow_views::FitCamera;
use framegraph_scene::Renderables;
use framegraph_shaders::layout::FroxelUniforms;
use glam::DQuat;

/// Most entries of all lists, 16 MiB of them.
const MAX_ENTRIES: usize = 1 << 22;

/// Lists of lights by froxel, as shaders read them.
#[derive(Clone, Debug, PartialEq)]
pub struct LightLists {
    /// How the view is cut.
    pub uniforms: FroxelUniforms,
    /// For each froxel where its list begins, and where the last one ends; then the lists, numbers of the view's lights in
    /// rising order.
    pub words: Vec<u32>,
}

impl LightLists {
    /// Storage buffers that a fragment stage binds with lists: the lights, the lists and the shadow maps.
    const STORAGE_BUFFERS: u32 = 3;

    /// Whether a device of these limits binds lists beside what shading binds without them. Where it does not, all lights are
    /// looked at, which is the same picture.
    pub fn can_be_bound(limits: &wgpu::Limits) -> bool {
        limits.max_storage_buffers_per_shader_stage >= Self::STORAGE_BUFFERS
    }

    /// The list of froxel `number`.
    ///
    /// # Panics
    /// When there is no such froxel.
    pub fn list(&self, number: usize) -> &[u32] {
        let [begin, end] = [self.words[number], self.words[number + 1]];
        &self.words[begin as usize..end as usize]
    }

    /// Lists from the froxels of each light; none when they hold too much. `everywhere` lights come before the first one.
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
        // How long each list is, then where each begins.
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

/// What became of the lights of a scene in a view. The sun is not counted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightReport {
    /// Lights that are shaded with.
    pub kept: usize,
    /// Numbers of the others among the scene's lights.
    pub dropped: Vec<(usize, DropReason)>,
    /// How those that are kept are found.
    pub found: Found,
}

/// How lights are found at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Found {
    /// In the lists of froxels.
    ByFroxels {
        /// Tiles across and down, and slices.
        counts: [u32; 3],
        /// Lights that are in no list, since they have no end.
        everywhere: usize,
        /// Entries of all lists.
        entries: usize,
        /// Entries of the longest list.
        longest: usize,
    },
    /// All lights are looked at.
    All(LookedAtAll),
}

/// Why all lights are looked at everywhere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LookedAtAll {
    /// It was asked for, or there are no lights to be found.
    #[default]
    Asked,
    /// So few lights have an end that lists take longer.
    Few(usize),
    /// Lists would hold too much.
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

/// The lists of a view's lights, if they are found by lists, and what became of them.
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
