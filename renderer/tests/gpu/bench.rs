//! Shared parts of the tests: devices, a frame that is declared, compiled and executed, and small passes.

use framegraph::{DeclareError, Options, Plan, Scratch, Texture, View};
use framegraph_wgpu::Frame;
use framegraph_wgpu::{
    AdapterRequest, Binding, Cx, Executor, Gpu, Imports, OpenError, Pixels, Raster, RecordError, Shader, read_texture,
};

pub type TestResult = Result<(), Box<dyn std::error::Error>>;

/// Runs `test` on the noop device and on the available adapter. The argument is true if pixels are drawn.
pub fn on_every_device(name: &str, test: impl Fn(&Gpu, bool) -> TestResult) -> TestResult {
    test(&Gpu::noop()?, false)?;
    on_adapter(name, |gpu| test(gpu, true))
}

/// Runs `test` on the available adapter, or reports that it was skipped.
pub fn on_adapter(name: &str, test: impl FnOnce(&Gpu) -> TestResult) -> TestResult {
    match Gpu::open(&AdapterRequest::from_env()) {
        Ok(gpu) => {
            test_report::adapter(&gpu.describe());
            test(&gpu)
        }
        Err(why @ OpenError::NoAdapter { .. }) => skip(name, &why.to_string()),
        Err(other) => Err(other.into()),
    }
}

/// Reports that a test was skipped, and why.
pub fn skip(name: &str, why: &str) -> TestResult {
    test_report::skip(name, why);
    Ok(())
}

/// A frame with its plan, executor and imports.
pub struct Bench {
    pub gpu: Gpu,
    pub executor: Executor,
    pub frame: Frame,
    pub plan: Plan,
    pub options: Options,
    pub imports: Imports,
    scratch: Scratch,
}

impl Bench {
    /// Creates a frame of `width` × `height` texels.
    pub fn new(gpu: &Gpu, width: u32, height: u32) -> Self {
        Self {
            gpu: gpu.clone(),
            executor: Executor::new(gpu),
            frame: Frame::new(),
            plan: Plan::new(),
            options: Options::for_frame(width, height),
            imports: Imports::new(),
            scratch: Scratch::new(),
        }
    }

    /// Declares the frame again and compiles it.
    pub fn declare<T>(
        &mut self,
        declare: impl FnOnce(&mut Frame) -> Result<T, DeclareError>,
    ) -> Result<T, Box<dyn std::error::Error>> {
        self.frame.reset();
        let out = declare(&mut self.frame)?;
        let caps = self.gpu.caps();
        framegraph::recompile(self.frame.graph(), &caps, &self.options, &mut self.scratch, &mut self.plan)?;
        Ok(out)
    }

    /// Executes the frame, and compares executed with planned operations.
    pub fn execute(&mut self) -> TestResult {
        self.executor.execute(&self.plan, &self.frame, &(), &self.imports)?;
        assert_eq!(self.executor.executed(), self.plan.counts(), "executed and planned counts differ");
        Ok(())
    }

    /// Declares and executes the frame.
    pub fn run<T>(
        &mut self,
        declare: impl FnOnce(&mut Frame) -> Result<T, DeclareError>,
    ) -> Result<T, Box<dyn std::error::Error>> {
        let out = self.declare(declare)?;
        self.execute()?;
        Ok(out)
    }

    /// Returns the pixels of an exported texture.
    pub fn pixels(&self, texture: Texture) -> Result<Pixels, Box<dyn std::error::Error>> {
        let physical = self.executor.texture(&self.plan, texture).ok_or("the texture has no memory")?;
        Ok(read_texture(&self.gpu, physical)?)
    }
}

/// Fills the lower left half of the target (`corner`) or all of it (`full`), at depth `depth`.
pub const FILL: Shader<'static> = Shader::new(
    "fill",
    "struct Fill { color: vec4f, depth: f32 }
     @group(0) @binding(0) var<uniform> fill: Fill;
     @vertex fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
       return vec4f(f32(i & 1) * 2.0 - 1.0, f32(i >> 1) * 2.0 - 1.0, fill.depth, 1.0);
     }
     @vertex fn full(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
       return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, fill.depth, 1.0);
     }
     @fragment fn fs_main() -> @location(0) vec4f { return fill.color; }",
);

/// Shows the texel of an image at the fragment's position, for any size.
pub const SHOW: Shader<'static> = Shader::new(
    "show",
    "@group(0) @binding(0) var image: texture_2d<f32>;
     @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
       return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.5, 1.0);
     }
     @fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
       return textureLoad(image, min(vec2u(at.xy), textureDimensions(image) - 1), 0);
     }",
);

/// Shows the depth at the fragment's position, drawn at depth 0.5.
pub const SHOW_DEPTH: Shader<'static> = Shader::new(
    "show depth",
    "@group(0) @binding(0) var depth: texture_depth_2d;
     @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
       return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.5, 1.0);
     }
     @fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
       return vec4f(textureLoad(depth, vec2u(at.xy), 0));
     }",
);

/// Draws one triangle with bindings of group 0.
pub fn draw(cx: &mut Cx<'_>, raster: &Raster<'_>, bindings: &[(u32, Binding)]) -> Result<(), RecordError> {
    let pipeline = cx.raster_pipeline(raster)?;
    let group = (!bindings.is_empty()).then(|| cx.bind_group(pipeline.group(0), bindings));
    let pass = cx.render_pass()?;
    pass.set_pipeline(&pipeline);
    if let Some(group) = &group {
        pass.set_bind_group(0, group, &[]);
    }
    pass.draw(0..3, 0..1);
    Ok(())
}

/// Draws one triangle that reads a texture at binding 0.
pub fn draw_of(cx: &mut Cx<'_>, raster: &Raster<'_>, view: View) -> Result<(), RecordError> {
    let view = cx.view(view)?.into();
    draw(cx, raster, &[(0, view)])
}

/// Draws one triangle of `FILL`.
pub fn fill(cx: &mut Cx<'_>, raster: &Raster<'_>, color: [f32; 4], depth: f32) -> Result<(), RecordError> {
    let constants = cx.uniform(&[color[0], color[1], color[2], color[3], depth, 0.0, 0.0, 0.0]);
    draw(cx, raster, &[(0, constants)])
}

/// Fills the whole target with one color.
pub fn fill_full(cx: &mut Cx<'_>, color: [f32; 4]) -> Result<(), RecordError> {
    fill(cx, &Raster { vertex: "full", ..Raster::new(FILL) }, color, 0.0)
}

/// Fills the lower left half of the target with one color.
pub fn fill_corner(cx: &mut Cx<'_>, color: [f32; 4]) -> Result<(), RecordError> {
    fill(cx, &Raster { vertex: "corner", ..Raster::new(FILL) }, color, 0.0)
}

pub const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
pub const GREEN: [f32; 4] = [0.0, 1.0, 0.0, 1.0];
