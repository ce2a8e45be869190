//! Shadow maps in a frame, with the view that they are drawn for.

use super::view::ViewShadows;
use crate::gpu_scene::view::ViewId;
use framegraph::Texture;

/// The texture of all shadow maps of a view, and that view. Other views may read them if their maps are fitted together
/// ([`CameraView::together`](crate::CameraView::together)).
#[derive(Clone, Copy, Debug)]
pub struct ShadowMaps {
    /// Texture with a layer for each cascade, and layers shared by punctual lights.
    pub texture: Texture,
    /// View whose maps are drawn.
    pub view: ViewId,
}

impl ViewShadows {
    /// Returns true if both views have the same maps: equal transforms and places.
    pub(crate) fn fits(&self, other: &Self) -> bool {
        self.maps
            .iter()
            .map(|map| (map.clip_from_world, map.place))
            .eq(other.maps.iter().map(|map| (map.clip_from_world, map.place)))
    }
}
