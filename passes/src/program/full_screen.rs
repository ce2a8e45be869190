//! Draw of a full-screen triangle.

use crate::program::{Program, ProgramDesc, Programs};
use framegraph_wgpu::{Binding, Constants, Cx, Depth, Raster, RecordError};

/// One triangle that covers the target.
#[derive(Clone, Debug)]
pub struct FullScreen<'a> {
    /// The program; its vertex entry point makes the triangle from three vertex indices.
    pub program: ProgramDesc<'a>,
    /// Values of its constants, in the order of [`Program::constants`](crate::program::Program::constants).
    pub constants: &'a [f64],
    /// Bindings by group, in the order of the interface's group; in group 0 followed by the bindings of the epilogue.
    /// `None` for variables that the shader does not use.
    pub groups: &'a [&'a [Option<Binding>]],
    /// Depth test; off by default.
    pub depth: Depth,
}

impl<'a> FullScreen<'a> {
    /// Creates a draw without constants and depth test.
    pub const fn new(program: ProgramDesc<'a>, groups: &'a [&'a [Option<Binding>]]) -> Self {
        Self { program, constants: &[], groups, depth: Depth::NONE }
    }

    /// Records the draw into the open render pass.
    ///
    /// # Errors
    /// Returns an error of the shader or the device.
    pub fn draw(self, programs: &Programs, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        draw(&*programs.get(&self.program)?, self.constants, self.groups, self.depth, cx)
    }
}

/// Records one full-screen triangle with `program`; the other arguments are as in [`FullScreen`].
///
/// # Errors
/// Returns an error of the shader or the device.
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
