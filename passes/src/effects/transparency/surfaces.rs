//! What all passes over blended surfaces have in common.

use crate::effects::color::surface::{SurfaceBindings, SurfaceInputs, SurfaceWorld};
use crate::effects::fog::FogSettings;
use crate::effects::shadow::ShadowInput;
use crate::gpu_scene::draw::{SurfaceDraw, SurfaceVariant};
use crate::gpu_scene::indirect::DrawList;
use crate::gpu_scene::view::ViewId;
use crate::light::shading::{AlphaUse, Shading};
use framegraph::{DeclareError, PassBuilder, Texture, View};
use framegraph_scene::Lobes;
use framegraph_wgpu::{Cx, Depth, Epilogue, Output, RecordError};
use wgpu::{BlendComponent, BlendFactor, BlendOperation, BlendState};

/// Blended surfaces of a view, and how they are shaded.
#[derive(Clone, Copy, Debug)]
pub struct BlendedSurfaces {
    /// The view that is drawn.
    pub view: ViewId,
    /// The shadow maps of the view.
    pub shadow: Option<Texture>,
    /// The picture of what is behind transmissive surfaces, all levels written; needed where one of them blends.
    pub scene: Option<Texture>,
    /// How surfaces are shaded.
    pub shading: Shading,
    /// Fog before all that is drawn.
    pub fog: Option<FogSettings>,
}

/// What shading them reads.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BlendedInputs {
    shadow: Option<ShadowInput>,
    scene: Option<View>,
}

/// How a pass draws them.
pub(super) struct BlendedDraw<'a> {
    /// The fragment entry point of `pass/color.wgsl`.
    pub fragment: &'static str,
    /// The depth test.
    pub depth: Depth,
    /// Blending, by color slot.
    pub colors: &'a [Output],
    /// What shading reads; none for a pass that needs alpha alone.
    pub inputs: Option<BlendedInputs>,
    /// Sums of absorbance and of its moments, with bias and overestimation.
    pub moments: Option<([View; 2], [f32; 2])>,
}

impl BlendedSurfaces {
    /// Declares what shading reads.
    pub(super) fn inputs(&self, pass: &mut PassBuilder<'_>) -> Result<BlendedInputs, DeclareError> {
        let shadow = ShadowInput::declare(self.shadow, pass)?;
        Ok(BlendedInputs { shadow, scene: self.scene.map(|scene| pass.sampled(scene)).transpose()? })
    }

    /// Draws a list of them.
    pub(super) fn draw(
        &self,
        list: &DrawList,
        world: &SurfaceWorld<'_>,
        own: BlendedDraw<'_>,
        cx: &mut Cx<'_>,
    ) -> Result<(), RecordError> {
        let BlendedDraw { fragment, depth, colors, inputs, moments } = own;
        let lobes = |own: Lobes| if inputs.is_some() { own } else { Lobes::NONE };
        let BlendedInputs { shadow, scene } = inputs.unwrap_or_default();
        let inputs = SurfaceInputs { fog: self.fog, scene, moments, ..SurfaceInputs::shadowed(shadow) };
        let bindings = SurfaceBindings::new(inputs, &self.shading, world, Epilogue::default(), cx)?;
        let program = |variant: SurfaceVariant| {
            let variant = SurfaceVariant { lobes: lobes(variant.lobes), ..variant };
            bindings.program_with(world.programs, variant, fragment)
        };
        let constants = bindings.constants(AlphaUse::Blend);
        SurfaceDraw { program: &program, frame: &bindings.frame, constants: &constants, depth, colors }.draw(
            list,
            world.instances(),
            cx,
        )
    }
}

/// Fragments are added to what is there.
pub(super) const ADDED: Output = {
    let add =
        BlendComponent { src_factor: BlendFactor::One, dst_factor: BlendFactor::One, operation: BlendOperation::Add };
    Output { blend: Some(BlendState { color: add, alpha: add }), ..Output::REPLACE }
};

/// What is there is multiplied by the fragment.
pub(super) const MULTIPLIED: Output = {
    let through =
        BlendComponent { src_factor: BlendFactor::Dst, dst_factor: BlendFactor::Zero, operation: BlendOperation::Add };
    Output { blend: Some(BlendState { color: through, alpha: through }), ..Output::REPLACE }
};

/// Fragments lie behind what is there, whose alpha is what it lets through.
pub(super) const BEHIND: Output = {
    let color = BlendComponent {
        src_factor: BlendFactor::DstAlpha,
        dst_factor: BlendFactor::One,
        operation: BlendOperation::Add,
    };
    let alpha = BlendComponent {
        src_factor: BlendFactor::Zero,
        dst_factor: BlendFactor::OneMinusSrcAlpha,
        operation: BlendOperation::Add,
    };
    Output { blend: Some(BlendState { color, alpha }), ..Output::REPLACE }
};

/// A surface hidden by what is opaque is not drawn, and hides nothing.
pub(super) const TESTED: Depth = Depth { write: false, ..Depth::NEARER };
