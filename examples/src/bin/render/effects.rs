//! Options of effects: ambient occlusion, reflections, glass layers, fog, bloom, depth of field, temporal anti-aliasing,
//! levels of detail, transparency and visible layers.

use crate::parse::{field, number};
use framegraph_passes::frame::tables::{Section, sections};
use framegraph_passes::{FrameSettings, Upscale};
use program::clap::Arg;
use program::cli::{Item, option};
use std::path::PathBuf;

/// Declares the options of this module.
pub fn options() -> Vec<Arg> {
    let others = vec![
        option("dirt", "FILE", "PNG or JPEG picture of lens dirt, stretched over the frame; requires bloom"),
        option(
            "resolve",
            "linear|tone",
            "MSAA resolve of radiance, or of tone-mapped values, which keeps edges smooth in front of bright areas \
             when bloom, --dof or --taa read the radiance (linear)",
        ),
        option(
            "scale",
            "X",
            "Render at X times the width and height, 0.25 to 1, and upscale (1); --linear-out has the rendered size",
        ),
        option("upscale", "bilinear|fsr", "Upscaling filter (fsr)"),
        option("sharpness", "X", "Sharpening after upscaling, 0 to 1 (0.9)"),
        option(
            "dynamic-resolution",
            "MS[:MIN]",
            "In --turntable and --sequence, scale each frame so that it takes MS milliseconds, but not below MIN \
             percent of the sides, 25 to 100 (50)",
        ),
        option(
            "lod",
            "PX",
            "Draw simplified meshes while the geometric error is at most PX pixels, or shadow-map texels, 0 to 16; 0 \
             draws all triangles (0)",
        ),
        option("glass-layers", "N", "Layers of glass visible through glass, 1 to 4; 1 shows only opaque surfaces (1)"),
        option(
            "layers",
            "MASK",
            "Visible layers of the scene, one bit each, such as 3, 0x03 or 0b11; objects in none of them are not drawn \
             and cast no shadows (1)",
        ),
    ];
    keyed().chain(others).map(|option| option.help_heading("Effects")).collect()
}

/// Declares the options of effects that have a table of settings and no other options.
fn keyed() -> impl Iterator<Item = Arg> {
    let own = |section: &&Section| !section.methods.is_empty() && !OTHERS.contains(&section.option);
    sections().iter().filter(own).map(|section| {
        let Section { option: name, about, .. } = section;
        let named = METHODS.iter().find(|(option, _)| option == name).map(|(_, methods)| (*methods).to_owned());
        let methods = named.unwrap_or_else(|| match section.is_optional {
            true => format!("off (default) or {}", section.methods.join(", ")),
            false => section.methods.join(", "),
        });
        option(name, "METHOD[:KEY=X,...]", format!("{about}: {methods}. `--{name} help` lists the keys"))
    })
}

/// Sections whose options other modules declare, and those without an option.
const OTHERS: [&str; 3] = ["", "shadow", "lights"];

/// Descriptions of methods whose names do not suffice.
const METHODS: [(&str, &str); 4] = [
    ("ao", "off (default), or a METHOD: sao (taps on a spiral) or gtao (horizons, more accurate)"),
    ("ssr", "off (default), or on: needs several frames"),
    ("taa", "off (default) or on, over --frames frames"),
    (
        "transparency",
        "sorted (by object, default), two-passes (also back faces before front faces of double-sided surfaces), weighted \
         (weighted average), moments (weighted by moments of absorbance) or peeled (layer by layer, exact)",
    ),
];

/// Options of effects beside the settings of the frame.
#[derive(Clone, Debug, Default)]
pub struct Effects {
    /// Picture of lens dirt.
    pub dirt: Option<PathBuf>,
    /// Dynamic resolution: frame time in ms, and the minimum scale in percent of width and height.
    pub dynamic: Option<[f64; 2]>,
}

/// Returns the upscaling for a frame rendered at `percent` of the sides; `None` at 100 %.
pub fn enlarging(upscale: Option<Upscale>, percent: f64) -> Option<Upscale> {
    let smaller = Upscale { percent: percent.round() as u16, ..upscale.unwrap_or_default() };
    (smaller.percent < 100).then_some(smaller)
}

impl Effects {
    /// Parses the value of an option of this module into `frame` or `self`; returns false for other options.
    ///
    /// # Errors
    /// One line that names the option and the expected value.
    pub fn take(&mut self, frame: &mut FrameSettings, item: &Item) -> Result<bool, String> {
        let settings = &mut frame.settings;
        match item.name() {
            "dirt" => self.dirt = Some(item.raw().into()),
            "scale" => settings.upscale = enlarging(settings.upscale, f64::from(100.0 * number(item, 0.25..=1.0)?)),
            "upscale" | "sharpness" => field(item, settings.upscale.get_or_insert_default())?,
            "lod" => field(item, frame)?,
            "resolve" | "glass-layers" => field(item, settings)?,
            "dynamic-resolution" => {
                let expected =
                    "milliseconds above 0, with an optional minimum scale of 25 to 100 percent after a colon";
                self.dynamic = Some(item.parse(expected, dynamic)?);
            }
            "layers" => frame.visible_layers = item.parse("a mask of eight layers, such as 3, 0x03 or 0b11", mask)?,
            name => {
                let Some(section) = sections().iter().find(|section| section.option == name) else { return Ok(false) };
                section.take(frame, &item.text()?).map_err(|error| format!("--{name} {error}"))?;
            }
        }
        Ok(true)
    }
}

/// Parses eight bits from a decimal, hexadecimal or binary number.
fn mask(text: &str) -> Option<u8> {
    let radix =
        [("0x", 16), ("0b", 2)].into_iter().find_map(|(prefix, radix)| Some((text.strip_prefix(prefix)?, radix)));
    let (digits, radix) = radix.unwrap_or((text, 10));
    u8::from_str_radix(digits, radix).ok().filter(|_| !digits.starts_with('+'))
}

/// Parses a frame time in milliseconds, and an optional minimum scale in percent after a colon.
fn dynamic(text: &str) -> Option<[f64; 2]> {
    let (target, min) = text.split_once(':').unwrap_or((text, "50"));
    let of = |part: &str, max: f64| part.parse::<f64>().ok().filter(|x| *x > 0.0 && *x <= max);
    Some([of(target, 1e6)?, of(min, 100.0).filter(|min| *min >= 25.0)?])
}
