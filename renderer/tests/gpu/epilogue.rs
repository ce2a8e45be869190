//! Epilogues: requests, errors, and the rounding of the device.

use crate::bench::{Bench, TestResult, fill_full, on_adapter, on_every_device};
use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc};
use framegraph_wgpu::{Cx, Epilogue, Gpu, RecordError, Rounding, SettingName, StoreRounding};
use framegraph_wgpu::{Frame, Record};

const CLEAR: Intent = Intent::Clear(ClearValue::BLACK);

fn desc(format: Format) -> TextureDesc {
    TextureDesc::new(Extent::FRAME, format)
}

/// Sets a constant and does nothing else.
struct Grade {
    from: Texture,
    value: f64,
}

impl Pass for Grade {
    type Io = Texture;
    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
        pass.pointwise();
        pass.same_pixel(self.from)?;
        let to = pass.texture("graded", desc(Format::Rgba8Unorm));
        pass.color(to, Intent::Overwrite)
    }
}

impl<W: ?Sized> Record<W> for Grade {
    fn record(&self, _: &Texture, _: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        fill_full(cx, [0.0, self.value as f32, 0.0, 1.0])
    }

    fn epilogue(&self, to: &Texture, _: &W, cx: &mut Cx<'_>) -> Result<Option<Epilogue>, RecordError> {
        if cx.format_of(*to)? != Format::Rgba8Unorm || cx.pass_name() != "grade" {
            return Err(RecordError::custom("the context is that of another pass"));
        }
        Ok(Some(Epilogue { constants: vec![(SettingName::new("VALUE"), self.value)], ..Epilogue::default() }))
    }
}

/// Declares a producer that runs `record`, and a pass that is inlined into it.
fn declare(
    frame: &mut Frame,
    record: fn(&mut Cx<'_>) -> Result<(), RecordError>,
    graded: bool,
) -> Result<Texture, DeclareError> {
    let scene = frame.add_fn(
        "scene",
        |p| {
            p.takes_epilogue();
            let hdr = p.texture("hdr", desc(Format::Rgba16Float));
            p.color(hdr, CLEAR)
        },
        move |_, (), cx| record(cx),
    )?;
    let target = if graded {
        frame.add("grade", Grade { from: scene, value: 0.5 })?
    } else {
        let declare = |p: &mut PassBuilder<'_>| Grade { from: scene, value: 0.5 }.declare(p);
        frame.add_fn("grade", declare, |_, (), cx| fill_full(cx, [0.0, 0.5, 0.0, 1.0]))?
    };
    frame.graph_mut().readback(target)?;
    Ok(target)
}

#[test]
fn a_producer_receives_its_epilogues() -> TestResult {
    on_every_device("a_producer_receives_its_epilogues", |gpu, drawn| {
        let record = |cx: &mut Cx<'_>| {
            let message = cx.epilogues()?;
            let [(0, Epilogue { constants, .. })] = message.as_slice() else {
                return Err(RecordError::custom(format!("{message:?}")));
            };
            let value = constants.iter().find(|(name, _)| name.text() == "VALUE").map_or(0.0, |(_, value)| *value);
            fill_full(cx, [1.0, value as f32, 0.0, 1.0])
        };
        let mut bench = Bench::new(gpu, 4, 4);
        let target = bench.run(|frame| declare(frame, record, true))?;
        let counts = bench.executor.executed();
        assert_eq!((counts.inlined, counts.steps, counts.passes), (1, 1, 2));
        if drawn {
            assert_eq!(bench.pixels(target)?.at(1, 2), Some([255, 128, 0, 255].as_slice()), "the producer drew");
        }
        Ok(())
    })
}

#[test]
fn missing_epilogues_name_the_pass() -> TestResult {
    let gpu = Gpu::noop()?;
    let message = |record, graded| -> Result<String, Box<dyn std::error::Error>> {
        let mut bench = Bench::new(&gpu, 4, 4);
        let run = bench.run(|frame| declare(frame, record, graded));
        Ok(run.map(|_| String::new()).unwrap_or_else(|error| error.to_string()))
    };
    let silent = message(|_| Ok(()), true)?;
    assert!(silent.contains("`scene`") && silent.contains("Cx::epilogues"), "{silent}");
    let unsaid = message(|cx| cx.epilogues().map(drop), false)?;
    assert!(
        unsaid.contains("`scene`") && unsaid.contains("`grade`") && unsaid.contains("Record::epilogue"),
        "{unsaid}"
    );
    // A producer may use the list of passes instead of their epilogues.
    let asked = |cx: &mut Cx<'_>| {
        drop(cx.inlined());
        Ok(())
    };
    assert_eq!(message(asked, false)?, "");
    Ok(())
}

/// The measured rounding of three values also holds for others.
#[test]
fn the_measured_rounding_equals_that_of_a_pass() -> TestResult {
    on_adapter("the_measured_rounding_equals_that_of_a_pass", |gpu| {
        let StoreRounding { rgba16float, .. } = StoreRounding::measure(gpu)?;
        let values = [0.1_f32, 0.7, 1234.567, 3.0e-5];
        let mut bench = Bench::new(gpu, 2, 2);
        let target = bench.run(|frame| {
            let declare = |p: &mut PassBuilder<'_>| {
                let color = p.texture("color", desc(Format::Rgba16Float));
                p.color(color, CLEAR)
            };
            let target = frame.add_fn("fill", declare, move |_, (), cx| fill_full(cx, values))?;
            frame.graph_mut().readback(target)?;
            Ok(target)
        })?;
        let kept = bench.pixels(target)?.rgba()[0];
        for (value, kept) in values.into_iter().zip(kept) {
            let nearest = half::f16::from_f32(value).to_f32();
            let below = if nearest > value {
                half::f16::from_bits(half::f16::from_f32(value).to_bits() - 1).to_f32()
            } else {
                nearest
            };
            let expected = if rgba16float == Rounding::Nearest { nearest } else { below };
            assert_eq!(kept, expected, "{value} under {rgba16float:?}");
        }
        Ok(())
    })
}
