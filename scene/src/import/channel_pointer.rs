//! JSON pointers of animation channels (KHR_animation_pointer), as written in a document.

use std::collections::BTreeSet;

use serde_json::Value;

/// Returns the pointer of a channel, by the indices of animation and channel, if it has one.
pub(super) fn of_channel(json: &Value, animation: usize, channel: usize) -> Option<&str> {
    pointer_of(json.get("animations")?.get(animation)?.get("channels")?.get(channel)?)
}

/// Returns the material extensions that animation pointers refer to: `material 3: KHR_materials_sheen`.
pub(super) fn animated_extensions(json: &Value) -> BTreeSet<String> {
    let animations = json.get("animations").and_then(Value::as_array).into_iter().flatten();
    let place = |pointer: &str| {
        let (material, rest) = pointer.strip_prefix("/materials/")?.split_once("/extensions/")?;
        let index: usize = material.parse().ok()?;
        Some(format!("material {index}: {}", rest.split_once('/')?.0))
    };
    animations.flat_map(pointers).filter_map(place).collect()
}

/// Returns the pointers of an animation's channels.
pub(super) fn pointers(animation: &Value) -> impl Iterator<Item = &str> {
    let channels = animation.get("channels").and_then(Value::as_array).into_iter().flatten();
    channels.filter_map(pointer_of)
}

/// Returns the pointer of a channel, if it has one.
fn pointer_of(channel: &Value) -> Option<&str> {
    channel.get("target")?.get("extensions")?.get("KHR_animation_pointer")?.get("pointer")?.as_str()
}
