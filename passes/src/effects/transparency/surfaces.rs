//! Shared code of passes over blended surfaces.

use crate::effects::color::surface::{SurfaceBindings, SurfaceInputs, SurfaceWorld};
use crate::effects::fog::FogSettings;
use crate::effects::shadow::ShadowInput;
use crate::gpu_scene::draw::{SurfaceDraw, SurfaceVariant};
use crate::gpu_scene::indirect::DrawList;
use crate::gpu_scene::shadow_views::ShadowMaps;
use crate::gpu_scene::view::ViewId;
use crate::light::shading::{AlphaUse, Shading};
use framegraph::{DeclareError, PassBuilder, Texture, View};
use framegraph_scene::Lobes;
use framegraph_wgpu::{Cx, Depth, Epilogue, Output, RecordError};
use wgpu::{BlendComponent, BlendFactor, BlendOperation, BlendState};

/// Blended surfaces of a view, and their shading.
#[derive(Clone, Copy, Debug)]
pub struct BlendedSurfaces {
    /// View to draw.
    pub view: ViewId,
    /// Shadow maps of the view; `None` for no shadows.
    pub shadow: Option<ShadowMaps>,
    /// Radiance behind transmissive surfaces, with all levels written; required if one of them blends.
    pub scene: Option<Texture>,
    /// Shading options.
    pub shading: Shading,
    /// Fog; `None` for no fog.
    pub fog: Option<FogSettings>,
}

/// Inputs of shading.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BlendedInputs {
    shadow: Option<ShadowInput>,
    scene: Option<View>,
}

/// State of a draw of blended surfaces.
pub(super) struct BlendedDraw<'a> {
    /// Fragment entry point of `pass/color.wgsl`.
    pub fragment: &'static str,
    /// Depth test.
    pub depth: Depth,
    /// Blending of each color slot.
    pub colors: &'a [Output],
    /// Inputs of shading; `None` for passes that need alpha only.
    pub inputs: Option<BlendedInputs>,
    /// Sums of absorbance and of its moments, with bias and overestimation.
    pub moments: Option<([View; 2], [f32; 2])>,
}

impl BlendedSurfaces {
    /// Declares the inputs of shading.
    pub(super) fn inputs(&self, pass: &mut PassBuilder<'_>) -> Result<BlendedInputs, DeclareError> {
        let shadow = ShadowInput::declare(self.shadow, pass)?;
        Ok(BlendedInputs { shadow, scene: self.scene.map(|scene| pass.sampled(scene)).transpose()? })
    }

    /// Draws a list of blended surfaces.
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

/// Adds the fragment to the target.
pub(super) const ADDED: Output = {
    let add =
        BlendComponent { src_factor: BlendFactor::One, dst_factor: BlendFactor::One, operation: BlendOperation::Add };
    Output { blend: Some(BlendState { color: add, alpha: add }), ..Output::REPLACE }
};

/// Multiplies the target by the fragment.
pub(super) const MULTIPLIED: Output = {
    let through =
        BlendComponent { src_factor: BlendFactor::Dst, dst_factor: BlendFactor::Zero, operation: BlendOperation::Add };
    Output { blend: Some(BlendState { color: through, alpha: through }), ..Output::REPLACE }
};

/// Composites the fragment behind the target, whose alpha is its transmittance.
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

/// Tests depth without writing it: opaque surfaces hide blended ones.
pub(super) const TESTED: Depth = Depth { write: false, ..Depth::NEARER };
