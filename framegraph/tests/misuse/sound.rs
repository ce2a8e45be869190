//! The valid version of every other file, which so fails only for its own error.

use framegraph::{
    AccessKind, Buffer, ClearValue, DeclareError, Entry, Exit, Extent, Format, Graph, Intent, LoadOp, Pass,
    PassBuilder, PassId, Plan, StepId, StoreOp, Texture, TextureDesc,
};

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

fn declare(graph: &mut Graph) -> Result<Texture, DeclareError> {
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba16Float);
    let screen = graph.import_texture("screen", desc, Entry::Undefined, Exit::Keep);
    let lights: Buffer = graph.import_buffer("lights", 64, Entry::Defined, Exit::Discard);
    let accumulated = graph.history("accumulated", desc, 1);
    let last_frame = graph.previous(accumulated, 1)?;
    let hdr = graph.add_fn("scene", |pass| {
        pass.read_buffer(lights, AccessKind::Uniform)?;
        let samples = pass.texture("samples", desc.samples(4));
        let samples = pass.color(samples, Intent::Clear(ClearValue::BLACK))?;
        let hdr = pass.texture("hdr", desc);
        pass.resolve(samples, hdr)
    })?;
    graph.add_fn("accumulate", |pass| {
        pass.sampled(last_frame)?;
        pass.sampled(hdr.read_only())?;
        pass.storage_write(accumulated, Intent::Overwrite)
    })?;
    let hdr = graph.add_fn("blend", |pass| pass.color(hdr, Intent::Modify))?;
    graph.add("tonemap", &Tonemap { hdr, into: screen })
}

fn report(plan: &Plan, pass: PassId, step: StepId) -> bool {
    let dropped = plan.attachments().iter().any(|a| a.load == LoadOp::DontCare && a.store == StoreOp::Discard);
    dropped || plan.is_culled(pass) || plan.passes_of(step).is_empty()
}

/// Declares everything.
pub fn main() {
    let mut graph = Graph::new();
    declare(&mut graph).expect("the declarations are valid");
    let _ = report;
}
