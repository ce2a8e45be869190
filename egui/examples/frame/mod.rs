//! A frame to look at: shadows, a G-buffer, lighting, bloom and tone mapping.

use framegraph::{
    Caps, ClearValue, DeclareError, Entry, Exit, Extent, Format, Graph, Intent, Options, Plan, Scratch, TextureDesc,
    compile,
};

/// Compiles the frame for a tile-based device.
pub fn plan(shadows: bool) -> Result<Plan, Box<dyn std::error::Error>> {
    let mut graph = Graph::new();
    declare(&mut graph, shadows)?;
    let mut plan = Plan::new();
    compile(&graph, &Caps::tiler(), &Options::for_frame(1920, 1080), &mut Scratch::new(), &mut plan)?;
    Ok(plan)
}

fn declare(graph: &mut Graph, shadows: bool) -> Result<(), DeclareError> {
    let desc = |format| TextureDesc::new(Extent::FRAME, format);
    let screen = graph.import_texture("screen", desc(Format::Rgba8UnormSrgb), Entry::Undefined, Exit::Keep);
    let map = TextureDesc::new(Extent::absolute(2048, 2048), Format::Depth32Float);
    let map = graph.add_fn("shadows", |pass| {
        let map = pass.texture("shadow map", map);
        pass.depth(map, Intent::Clear(ClearValue::FAR_REVERSED))
    })?;
    let surfaces = graph.add_fn("g-buffer", |pass| {
        let [color, normal] = ["albedo", "normal"].map(|name| pass.texture(name, desc(Format::Rgba8Unorm)));
        let depth = pass.texture("depth", desc(Format::Depth32Float));
        let clear = Intent::Clear(ClearValue::BLACK);
        Ok([
            pass.color(color, clear)?,
            pass.color(normal, clear)?,
            pass.depth(depth, Intent::Clear(ClearValue::FAR_REVERSED))?,
        ])
    })?;
    let lit = graph.add_fn("lighting", |pass| {
        for surface in surfaces {
            pass.same_pixel(surface)?;
        }
        if shadows {
            pass.sampled(map)?;
        }
        let lit = pass.texture("lit", desc(Format::Rgba16Float));
        pass.color(lit, Intent::Overwrite)
    })?;
    let bloom = graph.add_fn("bloom", |pass| {
        pass.sampled(lit)?;
        let half = TextureDesc::new(Extent::fraction(2), Format::Rgba16Float);
        let bloom = pass.texture("bloom", half);
        pass.color(bloom, Intent::Overwrite)
    })?;
    graph.add_fn("tone mapping", |pass| {
        pass.sampled(lit)?;
        pass.sampled(bloom)?;
        pass.color(screen, Intent::Overwrite).map(drop)
    })
}
