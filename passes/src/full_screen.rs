//! A draw that covers the whole target: what passes over pictures record.

use crate::program::{Program, ProgramDesc, Programs};
use framegraph_wgpu::{Binding, Constants, Cx, Depth, Raster, RecordError};

/// One triangle over the whole target.
#[derive(Clone, Debug)]
pub struct FullScreen<'a> {
    /// The program; its vertex entry point makes the triangle from three vertex indices.
    pub program: ProgramDesc<'a>,
    /// Values of its constants, in the order of [`Program::constants`](crate::program::Program::constants).
    pub constants: &'a [f64],
    /// By bind group: what the pass provides, in the order of the interface's group; in group 0 followed by the bindings of
    /// the program's epilogue. None is for what this draw's shader does not reach.
    pub groups: &'a [&'a [Option<Binding>]],
    /// Depth test; by default none.
    pub depth: Depth,
}

impl<'a> FullScreen<'a> {
    /// Without constants or a depth test.
    pub const fn new(program: ProgramDesc<'a>, groups: &'a [&'a [Option<Binding>]]) -> Self {
        Self { program, constants: &[], groups, depth: Depth::NONE }
    }

    /// Records the draw into the open render pass.
    ///
    /// # Errors
    /// What the shader or the device refuses.
    pub fn draw(self, programs: &Programs, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        draw(&*programs.get(&self.program)?, self.constants, self.groups, self.depth, cx)
    }
}

/// Records one triangle over the whole target with `program`; the other arguments are as in [`FullScreen`].
///
/// # Errors
/// What the shader or the device refuses.
pub fn draw(
    program: &Program,
    constants: &[f64],
    groups: &[&[Option<Binding>]],
    depth: Depth,
    cx: &mut Cx<'_>,
) -> Result<(), RecordError> {
    let pipeline = cx.raster_pipeline(&Raster {
        vertex: program.vertex,
        fragment: program.fragment,
        constants: Constants(&program.constants(constants)),
        depth,
        ..Raster::new(program.shader())
    })?;
    let groups = groups.iter().enumerate().filter(|(index, _)| program.has_group(*index));
    let groups = groups.map(|(index, bindings)| {
        let group = program.bind(cx, &pipeline, index, |slot| bindings.get(slot).cloned().flatten())?;
        Ok((index as u32, group))
    });
    let groups = groups.collect::<Result<Vec<_>, RecordError>>()?;
    let pass = cx.render_pass()?;
    pass.set_pipeline(&pipeline);
    for (index, group) in &groups {
        pass.set_bind_group(*index, group, &[]);
    }
    pass.draw(0..3, 0..1);
    Ok(())
}
