//! Factors of frames and scenes, whose combinations are tested.

use super::cover::{Level, Space};
use super::scene::Part;

/// A choice, of which every case has one level.
#[derive(Debug)]
pub struct Factor {
    /// Name in lists of combinations.
    pub name: &'static str,
    /// The levels. The first goes with everything.
    pub levels: &'static [Choice],
}

/// A level of a factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// Nothing added.
    None,
    /// A part of the scene.
    Part(Part),
    /// Options of `render`, separated by spaces.
    Options(&'static str),
}

use Choice::{None, Options as O, Part as P};

const fn factor(name: &'static str, levels: &'static [Choice]) -> Factor {
    Factor { name, levels }
}

/// All factors.
pub const FACTORS: [Factor; 47] = [
    // The scene.
    factor("punctual lights", &[None, P(Part::TwoLights), P(Part::EightLights)]),
    factor("glass", &[None, P(Part::Glass), P(Part::GlassBehindGlass)]),
    factor("blending", &[None, P(Part::Blend)]),
    factor("cut-out", &[None, P(Part::Mask)]),
    factor("skin", &[None, P(Part::Skin)]),
    factor("morph target", &[None, P(Part::Morph)]),
    factor("lines", &[None, P(Part::Lines)]),
    factor("lobes", &[None, P(Part::Lobes)]),
    factor("unlit", &[None, P(Part::Unlit)]),
    // Light.
    factor("time", &[None, O("--time 0.4")]),
    factor("sun", &[None, O("--sun off"), O("--sun 1,2,1:60000:4")]),
    factor("environment", &[None, O("--environment uniform:400,500,600")]),
    factor("background", &[None, O("--background 50,20,10"), O("--background sky")]),
    factor("light lists", &[None, O("--lights froxels"), O("--lights all")]),
    // Shading.
    factor("quality", &[None, O("--quality low"), O("--quality ultra")]),
    factor(
        "shading",
        &[
            None,
            O("--shade aa=off,compensation=off,specular-occlusion=off,multi-bounce=off"),
            O(
                "--shade visibility=exact,compensation=punctual,micro-shadows=on,multi-bounce=on,fast-coat=on,irradiance=cube",
            ),
        ],
    ),
    factor("precision", &[None, O("--precision f16")]),
    // Shadows.
    factor(
        "shadows",
        &[None, O("--shadows dpcf"), O("--shadows pcss"), O("--shadows vsm"), O("--shadows evsm"), O("--shadows off")],
    ),
    factor("cascades", &[None, O("--cascades 2"), O("--cascades 4")]),
    factor(
        "shadow maps",
        &[
            None,
            O("--shadow texels=256,fit=tight,far=6"),
            O("--shadow texels=128,fit=stable,contact=on"),
            O("--shadow texels=256,contact=on,keep=on,samples=4,blur=2"),
        ],
    ),
    factor("cascade tint", &[None, O("--show-cascades")]),
    // Effects.
    factor(
        "occlusion",
        &[
            None,
            O("--ao sao"),
            O("--ao gtao:resolution=half"),
            O("--ao gtao:bent-normals=on,cone=on"),
            O("--ao sao:resolution=half,normals=coarse,cone=on,blur=off"),
        ],
    ),
    factor("reflections", &[None, O("--ssr on")]),
    factor("fog", &[None, O("--fog on"), O("--fog on:color=100:50:20,glow=4,cut-off=50,start=1")]),
    factor(
        "transparency",
        &[
            None,
            O("--transparency two-passes"),
            O("--transparency weighted"),
            O("--transparency moments"),
            O("--transparency peeled:layers=3"),
        ],
    ),
    factor("glass layers", &[None, O("--glass-layers 2"), O("--glass-layers 4")]),
    factor("bloom", &[None, O("--bloom on"), O("--bloom on:flare=on,quality=high,levels=3,blend=interpolate")]),
    factor("depth of field", &[None, O("--dof on"), O("--dof on:resolution=full,focus=2,median=off")]),
    factor("temporal", &[None, O("--taa on"), O("--taa on:converge=on,sharpness=0.5,filter-history=off")]),
    factor(
        "upscaling",
        &[None, O("--scale 0.5"), O("--scale 0.6 --upscale bilinear --sharpness 0"), O("--scale 0.25 --upscale fsr")],
    ),
    factor("detail", &[None, O("--lod 1")]),
    factor("samples", &[None, O("--msaa 1")]),
    factor("resolve", &[None, O("--resolve tone")]),
    factor("edges", &[None, O("--no-fxaa"), O("--enable fxaa")]),
    factor("facts", &[None, O("--force-effects")]),
    factor("prepass", &[None, O("--disable prepass"), O("--enable prepass")]),
    factor("sky", &[None, O("--disable sky")]),
    // Post-processing.
    factor(
        "tone mapping",
        &[None, O("--tone-map aces"), O("--tone-map agx"), O("--tone-map gt7"), O("--tone-map generic")],
    ),
    factor(
        "grading",
        &[
            None,
            O("--grade exposure=1,contrast=1.2,saturation=1.5,night=0.5"),
            O("--grade shadow-gamma=1.2:1:0.9,luminance-scaling=on,gamut-mapping=on,temperature=0.3"),
        ],
    ),
    factor("grading table", &[None, O("--grade-by table"), O("--grade-by table:16:rgb10")]),
    factor("vignette", &[None, O("--vignette 1")]),
    factor("edge fade", &[None, O("--edge-fade middle=0.3")]),
    factor("dither", &[None, O("--dither 0")]),
    // The plan.
    factor("post-processing", &[None, O("--split-post"), O("--inline off"), O("--round-hdr")]),
    factor("aliasing", &[None, O("--alias pool"), O("--alias none")]),
    factor("debug", &[None, O("--debug poison"), O("--debug immediate"), O("--debug no-merge,no-cull")]),
    factor("exposure", &[None, O("--ev100 2"), O("--ev100 20")]),
];

/// Pairs of options that `render` refuses in one command line, since one leaves the other nothing to do, or contradicts it. No
/// case contains them.
const REFUSED: [[&str; 2]; 10] = [
    ["--shadows off", "--cascades 2"],
    ["--shadows off", "--cascades 4"],
    ["--shadows off", "--show-cascades"],
    ["--shadows off", "--shadow texels=256,fit=tight,far=6"],
    ["--shadows off", "--shadow texels=128,fit=stable,contact=on"],
    ["--shadows off", "--shadow texels=256,contact=on,keep=on,samples=4,blur=2"],
    ["--debug immediate", "--inline off"],
    ["--debug immediate", "--round-hdr"],
    ["--debug immediate", "--alias pool"],
    ["--debug immediate", "--alias none"],
];

/// Returns all combinations of the factors.
#[must_use]
pub fn space() -> Space {
    let excluded = REFUSED.iter().filter_map(|[a, b]| Some([level(a)?, level(b)?])).collect();
    Space { levels: FACTORS.iter().map(|factor| factor.levels.len()).collect(), excluded }
}

/// Returns the level with these options.
fn level(options: &str) -> Option<Level> {
    let is_it = |level: &Choice| matches!(level, O(own) if *own == options);
    let found = |factor: &Factor| factor.levels.iter().position(is_it);
    FACTORS.iter().enumerate().find_map(|(at, factor)| Some((at, found(factor)?)))
}

/// Returns the parts of a case's scene, and the options of its command line.
#[must_use]
pub fn parts_and_options(case: &[usize]) -> (Vec<Part>, Vec<&'static str>) {
    let chosen = || FACTORS.iter().zip(case).map(|(factor, level)| factor.levels[*level]);
    let parts = chosen().filter_map(|choice| if let P(part) = choice { Some(part) } else { Option::None });
    let options = chosen().filter_map(|choice| if let O(options) = choice { Some(options) } else { Option::None });
    (parts.collect(), options.flat_map(|options| options.split(' ')).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::combinations::cover::cover;

    #[test]
    fn refused_options_are_among_the_factors() {
        for option in REFUSED.iter().flatten() {
            let (_, level) = level(option).unwrap_or_else(|| panic!("{option}: no factor has it"));
            assert!(level > 0, "{option}: the first level goes with everything");
        }
    }

    /// The pairs are counted here without the construction's numbering.
    #[test]
    fn every_pair_is_in_a_case_unless_it_is_refused() {
        let space = space();
        let cases = cover(&space, 2);
        assert!(cases.len() < 60, "{} cases", cases.len());
        // A level that is in a case for no pair costs as much as one that is.
        let added = cases.iter().flatten().filter(|level| **level > 0).count();
        assert!(added < 900, "{added} levels beside the first");
        let (mut pairs, mut refused) = (0, 0);
        for (i, a) in FACTORS.iter().enumerate() {
            for (j, b) in FACTORS.iter().enumerate().skip(i + 1) {
                for (k, l) in (0..a.levels.len()).flat_map(|k| (0..b.levels.len()).map(move |l| (k, l))) {
                    let is_there = cases.iter().any(|case| (case[i], case[j]) == (k, l));
                    assert_eq!(is_there, space.allows((i, k), (j, l)), "{} {k} with {} {l}", a.name, b.name);
                    (pairs, refused) = (pairs + u32::from(is_there), refused + u32::from(!is_there));
                }
            }
        }
        assert_eq!(refused, REFUSED.len() as u32);
        assert!(pairs > 6000, "{pairs} pairs");
    }
}
