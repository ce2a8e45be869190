//! Pictures without a window.

use crate::args::Args;
use crate::args::GRAPH;
use crate::{Failure, first, has_extension, opened, selected};
use program::outputs::Outputs;
use std::path::Path;
use viewer::app::{Session, Viewer};
use viewer::drawing::svg;
use viewer::offscreen::{Offscreen, own_size_px};

/// Default size of the whole application in pixels.
const WHOLE: [u32; 2] = [1280, 720];

/// Writes the picture.
///
/// # Errors
/// Invalid input or output, or no device for a PNG.
pub fn run(args: &Args, out: &Path) -> Result<(), Failure> {
    let input = |error: &dyn std::fmt::Display| Failure::Input(error.to_string());
    let (is_svg, is_png) = (has_extension(out, "svg"), has_extension(out, "png"));
    if !is_svg && !is_png {
        return Err(Failure::Input(format!("--out {}: the file must end in .png or .svg", out.display())));
    }
    if is_svg && (args.whole || args.picture.is_some()) {
        return Err(Failure::Input("--whole, --picture: require a PNG output".into()));
    }
    let mut outputs = Outputs::default();
    let settings = args.standard.as_ref().filter(|which| which.ends_with(".ron")).map(Path::new);
    let files = [&args.file, &args.against, &args.trace].into_iter().filter_map(|path| path.as_deref());
    for path in files.chain(settings) {
        outputs.reads(path).map_err(|e| input(&e))?;
    }
    outputs.add(out).map_err(|e| input(&e))?;
    let mut session = Session::new(first(args)?, || {});
    opened(args, &mut session)?;
    session.selected = args.select.as_ref().map(|name| selected(name, &session)).transpose()?;
    let bytes = if is_svg { of_view(args, &session).into_bytes() } else { png(args, session)? };
    outputs.write(out, |file| file.write_all(&bytes)).map_err(|e| input(&e))?;
    outputs.commit().map(drop).map_err(|e| input(&e))
}

/// Returns the drawing of the requested view.
fn picture(args: &Args, session: &Session) -> viewer::drawing::Drawing {
    args.view.unwrap_or(GRAPH).drawing(session).unwrap_or_default()
}

fn of_view(args: &Args, session: &Session) -> String {
    svg(&picture(args, session), args.theme.unwrap_or_default())
}

fn png(args: &Args, session: Session) -> Result<Vec<u8>, Failure> {
    let mut screen = Offscreen::open().map_err(Failure::Device)?;
    let theme = args.theme.unwrap_or_default();
    let (size, rgba) = if args.whole {
        let size = args.picture.unwrap_or(WHOLE);
        let mut viewer = Viewer::new(session);
        viewer.turn_to(args.view.unwrap_or(GRAPH));
        let item = viewer.session.selected;
        let rgba = screen.picture(size, args.scale, theme, |ui| {
            viewer.show(ui);
            viewer.select(item);
        });
        (size, rgba)
    } else {
        let drawing = picture(args, &session);
        let size = args.picture.unwrap_or_else(|| own_size_px(&drawing, args.scale));
        (size, screen.drawing(&drawing, size, args.scale, theme, &session.data().lit()))
    };
    let mut bytes = Vec::new();
    framegraph_scene::picture::encode_png(&mut bytes, size, &rgba.map_err(Failure::Device)?)
        .map_err(|e| Failure::Input(e.to_string()))?;
    Ok(bytes)
}
