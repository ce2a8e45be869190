//! Random graphs with a given number of resources, for measuring memory. Many resources live at the same time.

use framegraph::{DeclareError, Entry, Exit, Extent, Format, Graph, Intent, PassBuilder, Texture, TextureDesc};
use framegraph_check::generate::Entropy;

/// Frame size, in texels.
pub const FRAME: [u32; 2] = [1920, 1080];

/// Shape of a random graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Raster and compute passes over textures of a few sizes and formats. Passes mostly read recently written
    /// textures.
    Frame,
    /// Compute passes that each write two textures of 64 KiB to 16 MiB and read three of the last 64. Compile times of
    /// peers are measured on this shape.
    Dag,
}

impl Shape {
    /// Every shape.
    pub const ALL: [Self; 2] = [Self::Frame, Self::Dag];

    /// Name of the shape in tables.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Frame => "frames",
            Self::Dag => "dags",
        }
    }
}

/// Creates a graph of `resources` textures in addition to the screen. All of them are read, so nothing is culled.
///
/// # Errors
/// Only on a bug in this function.
pub fn graph(shape: Shape, seed: u64, resources: usize) -> Result<Graph, DeclareError> {
    let mut entropy = Entropy::seeded(seed);
    let mut graph = Graph::new();
    let screen = TextureDesc::new(Extent::FRAME, Format::Bgra8UnormSrgb);
    let screen = graph.import_texture("screen", screen, Entry::Undefined, Exit::Keep);
    let mut made: Vec<(Texture, bool)> = Vec::new();
    while made.len() < resources {
        let reads = match shape {
            Shape::Frame => recent(&mut entropy, made.len()),
            Shape::Dag => {
                (0..made.len().min(3)).map(|_| made.len() - 1 - below(&mut entropy, made.len().min(64))).collect()
            }
        };
        let written = graph.add_fn("pass", |pass| {
            let mut seen: Vec<usize> = Vec::new();
            for &read in &reads {
                if !seen.contains(&read) {
                    pass.sampled(made[read].0)?;
                    seen.push(read);
                }
            }
            write(shape, &mut entropy, resources - made.len(), pass)
        })?;
        for read in reads {
            made[read].1 = true;
        }
        made.extend(written.into_iter().map(|texture| (texture, false)));
    }
    graph.add_fn("present", |pass| {
        for (texture, _) in made.iter().filter(|(_, read)| !read) {
            pass.sampled(*texture)?;
        }
        pass.color(screen, Intent::Overwrite)
    })?;
    Ok(graph)
}

fn below(entropy: &mut Entropy<'_>, bound: usize) -> usize {
    entropy.below(bound as u32) as usize
}

/// Picks one to four of `count` textures: the last four with a probability of 3/4, otherwise any.
fn recent(entropy: &mut Entropy<'_>, count: usize) -> Vec<usize> {
    if count == 0 {
        return Vec::new();
    }
    let reads = 1 + below(entropy, 4);
    let one = |_| {
        let window = if entropy.one_in(4) { count } else { count.min(4) };
        count - 1 - below(entropy, window)
    };
    (0..reads).map(one).collect()
}

/// Declares the outputs of one pass, at most `left`.
fn write(
    shape: Shape,
    entropy: &mut Entropy<'_>,
    left: usize,
    pass: &mut PassBuilder<'_>,
) -> Result<Vec<Texture>, DeclareError> {
    if shape == Shape::Dag {
        let two = (0..left.min(2)).map(|_| {
            // 1 to 256 times 64 KiB, in four steps per octave.
            let size = entropy.below(33);
            let extent = Extent::absolute(1024, [16, 19, 23, 27][size as usize % 4] << (size / 4));
            let texture = pass.texture("t", TextureDesc::new(extent, Format::Rgba8Unorm));
            pass.storage_write(texture, Intent::Overwrite)
        });
        return two.collect();
    }
    let divisor = entropy.pick(&[1, 1, 1, 2, 2, 4, 8]);
    let extent = if entropy.one_in(8) { Extent::absolute(2048, 2048) } else { Extent::fraction(divisor) };
    let count = left.min(1 + below(entropy, 3));
    let compute = entropy.one_in(4);
    let mut written = Vec::new();
    for index in 0..count {
        let formats = [Format::Rgba8Unorm, Format::Rgba16Float, Format::R8Unorm, Format::R32Float, Format::Rg16Float];
        let depth = !compute && index > 0 && entropy.one_in(2);
        if depth {
            let texture = pass.texture("depth", TextureDesc::new(extent, Format::Depth32Float));
            written.push(pass.depth(texture, Intent::Clear(framegraph::ClearValue::FAR_REVERSED))?);
            break;
        }
        let texture = pass.texture("t", TextureDesc::new(extent, entropy.pick(&formats)));
        let write = if compute {
            pass.storage_write(texture, Intent::Overwrite)
        } else {
            pass.color(texture, Intent::Overwrite)
        };
        written.push(write?);
    }
    Ok(written)
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::{Caps, Options, Plan, Scratch, compile};
    use framegraph_check::check;
    use framegraph_check::generate;

    #[test]
    fn graphs_have_as_many_resources_as_wanted_and_all_of_them_are_needed() {
        for (shape, seed) in Shape::ALL.into_iter().flat_map(|shape| (0..20).map(move |seed| (shape, seed))) {
            let wanted = 10 + seed as usize * 2;
            let graph = graph(shape, seed, wanted).expect("the generator is sound");
            assert_eq!(graph.resources().len(), wanted + 1);
            let mut plan = Plan::new();
            let options = Options::for_frame(FRAME[0], FRAME[1]);
            compile(&graph, &generate::capable(Caps::tiler()), &options, &mut Scratch::new(), &mut plan)
                .expect("it is valid");
            assert_eq!(plan.counts().culled, 0);
            assert_eq!(check(&plan), Ok(()));
        }
    }
}
