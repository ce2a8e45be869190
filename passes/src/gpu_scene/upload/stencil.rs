//! Stencil state of materials as pipelines take it.

use framegraph_scene::material::{Stencil, StencilCompare, StencilFace, StencilOp};
use wgpu::{CompareFunction, StencilFaceState, StencilOperation, StencilState};

/// Returns the state of pipelines that draw a material with this stencil.
#[must_use]
pub fn stencil_state(stencil: &Stencil) -> StencilState {
    StencilState {
        front: face(&stencil.front),
        back: face(&stencil.back),
        read_mask: stencil.read_mask.into(),
        write_mask: if stencil.write { stencil.write_mask.into() } else { 0 },
    }
}

fn face(face: &StencilFace) -> StencilFaceState {
    StencilFaceState {
        compare: match face.compare {
            StencilCompare::Always => CompareFunction::Always,
            StencilCompare::Never => CompareFunction::Never,
            StencilCompare::Less => CompareFunction::Less,
            StencilCompare::LessEqual => CompareFunction::LessEqual,
            StencilCompare::Equal => CompareFunction::Equal,
            StencilCompare::NotEqual => CompareFunction::NotEqual,
            StencilCompare::GreaterEqual => CompareFunction::GreaterEqual,
            StencilCompare::Greater => CompareFunction::Greater,
        },
        fail_op: operation(face.stencil_fail),
        depth_fail_op: operation(face.depth_fail),
        pass_op: operation(face.pass),
    }
}

fn operation(op: StencilOp) -> StencilOperation {
    match op {
        StencilOp::Keep => StencilOperation::Keep,
        StencilOp::Zero => StencilOperation::Zero,
        StencilOp::Replace => StencilOperation::Replace,
        StencilOp::Invert => StencilOperation::Invert,
        StencilOp::IncrementClamp => StencilOperation::IncrementClamp,
        StencilOp::DecrementClamp => StencilOperation::DecrementClamp,
        StencilOp::IncrementWrap => StencilOperation::IncrementWrap,
        StencilOp::DecrementWrap => StencilOperation::DecrementWrap,
    }
}
