//! What the color pass makes of ambient occlusion that is handed to it.

use super::TestResult;
use crate::stage::{Set, Shot, gpu};
use framegraph::{ClearValue, Extent, Format, Intent, Target, TextureDesc};
use framegraph_passes::stages::{Handles, Slot, Stage};
use framegraph_passes::view::Background;
use framegraph_passes::{Settings, StageError, World, stages};
use framegraph_wgpu::Frame;

/// A frame whose ambient occlusion is the same everywhere, of that format.
fn frame(
    settings: &Settings,
    given: Option<(Format, [f64; 4])>,
) -> Result<(Frame<World>, framegraph::Texture), StageError> {
    let mut frame = Frame::new();
    let mut stages = stages::<World>(settings);
    if let Some((format, value)) = given {
        let given = move |frame: &mut Frame<World>, handles: &mut Handles| {
            let texture = frame.graph_mut().texture("given", TextureDesc::new(Extent::FRAME, format));
            let clear = Intent::Clear(ClearValue::Color(value));
            let given = frame.add_fn("given", |pass| pass.color(texture, clear), |_, _, _| Ok(()))?;
            handles.set(Slot::OCCLUSION, given);
            Ok(())
        };
        stages.insert_before("color", Stage::new("given", given))?;
    }
    let handles = stages.declare(&mut frame, Handles::default(), Target::New)?;
    let picture = handles.get(Slot::PICTURE)?;
    frame.graph_mut().readback(picture)?;
    Ok((frame, picture))
}

/// Visibility 1 changes no bit, less of it darkens, and none leaves only the sun's light. Bent normals that point along a
/// surface take its reflections and leave its diffuse light.
#[test]
fn handed_on_occlusion_is_shaded() -> TestResult {
    let Some(gpu) = gpu("handed_on_occlusion_is_shaded") else { return Ok(()) };
    // At this size the filter of normals makes every sphere rough, and rough lobes see up and down alike.
    let shading = framegraph_passes::Shading { specular_aa: None, ..Settings::DEFAULT.shading };
    let settings = Settings { shading, shadows: None, fxaa: false, ..Settings::DEFAULT };
    let shot = Shot::small(settings);
    let set = Set::new(&gpu, "spheres", &shot, &Background::None)?;
    let picture = |given| {
        let (frame, picture) = frame(&settings, given)?;
        Ok::<_, Box<dyn std::error::Error>>(set.render(&gpu, &frame, picture, &shot.options)?.0)
    };
    let sum = |texels: &[u8]| texels.iter().map(|code| u64::from(*code)).sum::<u64>();
    let single = |value| Some((Format::R16Float, [value, 0.0, 0.0, 1.0]));
    let [none, open, half, closed] = [None, single(1.0), single(0.5), single(0.0)].map(picture);
    let (none, open, half, closed) = (none?, open?, half?, closed?);
    assert!(none == open, "visibility 1 changes nothing");
    assert!(sum(&none) > sum(&half) && sum(&half) > sum(&closed), "less visibility is darker");
    // Half open: up into the sky, where reflections come from, or down into the ground.
    let bent = |y: f64| Some((Format::Rgba16Float, [0.5, 0.0, y, 0.0]));
    let (up, down) = (picture(bent(1.0))?, picture(bent(-1.0))?);
    assert!(sum(&up) > sum(&down), "reflections of what is open are seen, and of what is closed not");
    Ok(())
}
