//! A pass without one of the handles that it reads.

use framegraph::{DeclareError, Graph, Intent, Pass, PassBuilder, Texture};

struct Tonemap {
    hdr: Texture,
    into: Texture,
}

impl Pass for Tonemap {
    type Io = Texture;
    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
        pass.same_pixel(self.hdr)?;
        pass.color(self.into, Intent::Overwrite)
    }
}

fn declare(graph: &mut Graph, screen: Texture) {
    let _ = graph.add("tonemap", &Tonemap { into: screen });
}

fn main() {}
