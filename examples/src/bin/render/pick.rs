//! Picking of objects at pixels: `--pick`.

use crate::args::Args;
use crate::run::{Failure, Prepared, device};
use framegraph_passes::{Pick, Pickable, Picker, ViewId};

/// Columns and rows of pixels, from the left and the top: `X,Y:…`.
///
/// # Errors
/// One line that says what is needed.
pub fn pixels(text: &str) -> Result<Vec<[u32; 2]>, String> {
    let pixel = |own: &str| own.split_once(',').and_then(|(x, y)| Some([x.parse().ok()?, y.parse().ok()?]));
    let parsed: Option<_> = text.split(':').map(pixel).collect();
    parsed.ok_or_else(|| format!("--pick {text}: X,Y in pixels from the left and the top are needed"))
}

/// Refuses pixels that are not in the picture.
///
/// # Errors
/// One line that names the first.
pub fn check(args: &Args) -> Result<(), String> {
    let [width, height] = args.size_px;
    match args.debug.picks.iter().find(|[x, y]| *x >= width || *y >= height) {
        Some([x, y]) => Err(format!("--pick {x},{y}: the picture has {width}x{height} pixels")),
        None => Ok(()),
    }
}

/// Returns a line for each picked pixel: the object there with its number, depth and position.
///
/// # Errors
/// One line that says what the device refused.
pub fn lines(args: &Args, prepared: &Prepared) -> Result<Vec<String>, Failure> {
    let mut picker = Picker::new(&prepared.gpu);
    let drawn = prepared.settings.drawn_px(args.size_px);
    let line = |pixel: &[u32; 2]| {
        let scaled = |axis: usize| {
            let at = u64::from(pixel[axis]) * u64::from(drawn[axis]) / u64::from(args.size_px[axis].max(1));
            at as u32
        };
        let picked = picker.pick(&prepared.world, ViewId::MAIN, [scaled(0), scaled(1)], Pickable::Opaque);
        let at = format!("pick {},{}: ", pixel[0], pixel[1]);
        Ok(at
            + &match picked.map_err(device)? {
                None => "nothing".into(),
                Some(Pick { instance, depth, position }) => {
                    let name = prepared.loaded.scene.instances.get(instance).map_or("", |own| own.name.as_str());
                    let [x, y, z] = position.to_array();
                    format!("object {instance} {name:?}, depth {depth:.6}, at {x:.4},{y:.4},{z:.4} m")
                }
            })
    };
    args.debug.picks.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::pixels;

    #[test]
    fn pixels_are_two_numbers() {
        assert_eq!(pixels("12,0"), Ok(vec![[12, 0]]));
        assert_eq!(pixels("12,0:3,4"), Ok(vec![[12, 0], [3, 4]]));
        for wrong in ["", "1", "1,2,3", "-1,2", "1.5,2", "x,y", "1,2:"] {
            assert!(pixels(wrong).is_err_and(|told| told.starts_with(&format!("--pick {wrong}: "))), "{wrong}");
        }
    }
}
