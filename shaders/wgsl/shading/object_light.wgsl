// Light channels and shadow receiving of an object. These are overrides, so they cost nothing in
// scenes whose objects receive all light.

/// Light channels of the object in bits 0 to 7. Bit 8: it receives no shadows.
override OBJECT_LIGHT: u32 = 1u;
/// Light channels of the sun.
override SUN_CHANNELS: u32 = 255u;
/// True if some punctual light and some object share no channel.
override CHANNELS_DIFFER: bool = false;

/// Returns true if the object receives shadows.
fn receives_shadows() -> bool {
    return (OBJECT_LIGHT & 256u) == 0u;
}

/// Returns true if the sun lights the object.
fn takes_sun() -> bool {
    return (OBJECT_LIGHT & SUN_CHANNELS & 255u) != 0u;
}

/// Returns true if a punctual light with these channels lights the object.
fn takes_light(channels: u32) -> bool {
    return !CHANNELS_DIFFER || (OBJECT_LIGHT & channels & 255u) != 0u;
}
