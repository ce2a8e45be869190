// Which light an object takes: its channels, and whether shadows fall on it. Constants of
// pipelines, so that a scene whose objects take all light has nothing of it in its shaders.

/// Light channels of the object in bits 0 to 7. Bit 8: it receives no shadows.
override OBJECT_LIGHT: u32 = 1u;
/// Light channels of the sun.
override SUN_CHANNELS: u32 = 255u;
/// Whether some punctual light and some object share no channel.
override CHANNELS_DIFFER: bool = false;

/// Whether shadows fall on the object.
fn receives_shadows() -> bool {
    return (OBJECT_LIGHT & 256u) == 0u;
}

/// Whether the sun lights the object.
fn takes_sun() -> bool {
    return (OBJECT_LIGHT & SUN_CHANNELS & 255u) != 0u;
}

/// Whether a punctual light of these channels lights the object.
fn takes_light(channels: u32) -> bool {
    return !CHANNELS_DIFFER || (OBJECT_LIGHT & channels & 255u) != 0u;
}
