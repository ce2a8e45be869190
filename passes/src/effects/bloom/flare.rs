//! Passes that make lens flare.

use super::settings::{FlareSettings, FlareSpan};
use crate::effects::color::surface::HDR_FORMAT;
use crate::effects::occlusion::Axis;
use crate::gpu_scene::view::{ViewId, Views};
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{DeclareError, Extent, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_shaders::layout::FlareUniforms;
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Record, RecordError, SamplerDesc};
use glam::Vec3;

static SHADER: Module<'static> = library::pass("pass/flare.wgsl").unwrap();

static INTERFACE: Interface = Interface { groups: &[&["flare", "glow", "glow_sampler"]], constants: &[] };

/// Makes ghosts and a halo from the glow, at half its size. Uses [`Programs`] of the world.
#[derive(Clone, Copy, Debug)]
pub struct Flare {
    /// The glow; its first level is read.
    pub glow: Texture,
    /// Size of the first level in texels.
    pub size: [u32; 2],
    /// Settings.
    pub settings: FlareSettings,
    /// Transform to the coordinates in which the flare is centered.
    pub span: FlareSpan,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct FlareIo {
    glow: View,
    /// The flare before the blur.
    pub flare: Texture,
}

impl Pass for Flare {
    type Io = FlareIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<FlareIo, DeclareError> {
        let glow = pass.sampled(self.glow.mip(0))?;
        let [width, height] = self.size.map(|side| (side / 2).max(1));
        let flare = pass.texture("flare", TextureDesc::new(Extent::absolute(width, height), HDR_FORMAT));
        Ok(FlareIo { glow, flare: pass.color(flare, Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for Flare {
    fn record(&self, io: &FlareIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let own = self.settings;
        let [width, height] = self.size.map(|side| side as f32);
        let uniforms = FlareUniforms {
            aspect: width / height * self.span.scale[1] / self.span.scale[0],
            aberration: own.aberration,
            ghosts: own.ghosts.into(),
            ghost_spacing: own.ghost_spacing,
            ghost_threshold: own.ghost_threshold,
            halo_radius: own.halo_radius,
            halo_thickness: own.halo_thickness,
            halo_threshold: own.halo_threshold,
            span_scale: self.span.scale,
            span_offset: self.span.offset,
            ..FlareUniforms::default()
        };
        draw("fs_flare", uniforms, io.glow, world.as_ref(), cx)
    }
}

/// Blurs the flare along an axis. Uses [`Programs`] and the camera of the view of the world.
#[derive(Clone, Copy, Debug)]
pub struct FlareBlur {
    /// View of the picture.
    pub view: ViewId,
    /// The flare.
    pub flare: Texture,
    /// Axis of the blur.
    pub axis: Axis,
    /// Starburst: keeps only rays around the center.
    pub rays: bool,
    /// Transform to the coordinates in which the flare is centered.
    pub span: FlareSpan,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct FlareBlurIo {
    flare: View,
    /// The blurred flare.
    pub blurred: Texture,
}

impl Pass for FlareBlur {
    type Io = FlareBlurIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<FlareBlurIo, DeclareError> {
        let TextureDesc { extent, format, .. } = pass.desc(self.flare)?;
        let flare = pass.sampled(self.flare)?;
        let blurred = pass.texture("flare_blurred", TextureDesc::new(extent, format));
        Ok(FlareBlurIo { flare, blurred: pass.color(blurred, Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + AsRef<Views> + ?Sized> Record<W> for FlareBlur {
    fn record(&self, io: &FlareBlurIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let views: &Views = world.as_ref();
        let world_from_view = views.get(self.view)?.view.frame.world_from_view;
        // Components of the camera's axes along z; they change smoothly as the camera turns.
        let turn = world_from_view.transpose().col(2).truncate().dot(Vec3::ONE);
        let uniforms = FlareUniforms {
            axis: match self.axis {
                Axis::Across => [1.0, 0.0],
                Axis::Down => [0.0, 1.0],
            },
            turn,
            rays: f32::from(u8::from(self.rays)),
            span_scale: self.span.scale,
            span_offset: self.span.offset,
            ..FlareUniforms::default()
        };
        draw("fs_blur", uniforms, io.flare, world.as_ref(), cx)
    }
}

fn draw(
    fragment: &'static str,
    uniforms: FlareUniforms,
    source: View,
    programs: &Programs,
    cx: &mut Cx<'_>,
) -> Result<(), RecordError> {
    let sampler = cx.sampler(SamplerDesc::LINEAR).into();
    let provided = [cx.uniform(&uniforms), cx.view(source)?.into(), sampler].map(Some);
    let program = ProgramDesc { fragment: Some(fragment), ..ProgramDesc::new(&SHADER, &INTERFACE) };
    FullScreen::new(program, &[&provided]).draw(programs, cx)
}
