//! Errors of recording a pass.

use crate::grading::GradingError;
use crate::settings::precision::PrecisionError;
use framegraph::Format;
use framegraph_shaders::ShaderError;
use framegraph_shaders::reference::dfg::Visibility;
use framegraph_wgpu::RecordError;

/// Error of recording a pass of this crate.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PassError {
    /// A shader or an effect is invalid.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// A shader uses a variable that its pass does not provide.
    #[error(
        "shader `{shader}` binds `{variable}` in group {group}, which its pass does not provide; add it to the pass's `Interface`"
    )]
    NotProvided {
        /// The shader with its features and effects.
        shader: String,
        /// Name of the variable in WGSL.
        variable: String,
        /// Its `@group`.
        group: u32,
    },
    /// The pass provides the variable, but has nothing to bind in this frame.
    #[error(
        "shader `{shader}` binds `{variable}`, for which the pass has nothing in this frame; declare the pass with its input"
    )]
    Unbound {
        /// The shader with its features and effects.
        shader: String,
        /// Name of the variable in WGSL.
        variable: String,
    },
    /// The world lacks the view of the pass.
    #[error(
        "the pass draws view {view}, but there are {count} views; give the world that view, or declare the pass for another"
    )]
    NoView {
        /// The requested view.
        view: u32,
        /// Number of views.
        count: usize,
    },
    /// The frame's shadow maps do not match the view.
    #[error(
        "the frame declares {declared} layers of shadow maps, and view {view} has {layers}; give `ViewSettings` the \
         `ShadowSettings` that the frame's `Settings` have"
    )]
    ShadowMaps {
        /// Layers that the frame declares.
        declared: u16,
        /// The view.
        view: u32,
        /// Layers of the view's maps.
        layers: u16,
    },
    /// A view reads the shadow maps of another view, and its own would differ.
    #[error(
        "view {view} reads the shadow maps of view {drawn}, which are fitted to another camera; make both views with \
         `CameraView::together`, or let each draw its own maps"
    )]
    ShadowMapsApart {
        /// The view that reads the maps.
        view: u32,
        /// The view for which they are drawn.
        drawn: u32,
    },
    /// A surface is refractive, but the frame has no pass for it.
    #[error(
        "a surface of the scene transmits light, but the frame keeps no picture of what is behind it; declare the frame with \
         `Settings::for_scene`, or set `Settings::scene_levels`"
    )]
    TransmissionUndeclared,
    /// A surface blends, but post-processing is inlined.
    #[error(
        "a surface of the scene blends, but colors are graded before they are blended; declare the frame with \
         `Settings::blended`"
    )]
    BlendingUndeclared,
    /// The DFG table was made for another visibility term than shading uses.
    #[error(
        "`Shading::table` is {wanted:?}, but the DFG table was made for {made:?}; make the `Lighting` with `Shading::light`"
    )]
    OtherTable {
        /// The term that shading uses.
        wanted: Visibility,
        /// The term of the table.
        made: Visibility,
    },
    /// A material needs more textures or samplers than the device binds.
    #[error(
        "material {material:?} combines {}: its shader binds {count} {what}, and the device allows {most}; leave a lobe out",
        .lobes.join(", ")
    )]
    TooManyBindings {
        /// Name of the material.
        material: String,
        /// Names of its lobes.
        lobes: Vec<&'static str>,
        /// Textures or samplers.
        what: &'static str,
        /// Number that the shader binds.
        count: u32,
        /// Limit of the device.
        most: u32,
    },
    /// A look cannot be applied by the requested method.
    #[error(transparent)]
    Grading(#[from] GradingError),
    /// The device lacks the requested precision.
    #[error(transparent)]
    Precision(#[from] PrecisionError),
    /// Multisampled depth cannot be read.
    #[error(
        "depth of several samples needs to be read, which wgpu cannot do through OpenGL; use one sample per texel \
         (`--msaa 1`), or another back end"
    )]
    DepthSamples,
    /// An epilogue cannot round like a texture of this format.
    #[error(
        "how this device rounds when it stores {format:?} is not known; use Rgba16Float or Rg11b10Ufloat, or leave \
         `Settings::stored` out"
    )]
    UnknownRounding {
        /// Format of the texture that inlining removes.
        format: Format,
    },
}

impl std::fmt::Debug for PassError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl From<PassError> for RecordError {
    fn from(error: PassError) -> Self {
        match error {
            PassError::TooManyBindings { .. } | PassError::Grading(_) => Self::content(error),
            _ => Self::custom(error),
        }
    }
}
