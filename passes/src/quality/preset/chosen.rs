//! Options of the presets, chosen from docs/measurements/accuracy.json; renewed by
//! `cargo run -p tests --bin accuracy -- --out docs/measurements --presets passes/src/quality/preset/chosen.rs`.

/// Each group with its option in low, medium, high and ultra.
#[rustfmt::skip]
pub const CHOSEN: [(&str, [&str; 4]); 8] = [
    ("edges", ["FXAA", "FXAA", "4 samples", "4 samples"]),
    ("sun-shadows", ["1 map of 1024², PCF", "1 map of 2048², PCF", "3 maps of 2048², PCF", "4 maps of 2048², PCSS, contact"]),
    ("occlusion", ["none", "SAO of 7 taps, half size", "GTAO", "GTAO"]),
    ("shading", ["low", "ultra", "ultra", "ultra"]),
    ("precision", ["f32", "f32", "f32", "f32"]),
    ("radiance", ["Rgba16Float", "Rgba16Float", "Rgba16Float", "Rgba16Float"]),
    ("reflections", ["none", "none", "none", "of the picture"]),
    ("glass-layers", ["1", "3", "3", "3"]),
];
