//! Epilogues: point-wise passes that run at the end of another pass's fragment shader.
//!
//! A pass that the plan inlines records nothing. Instead it returns an [`Epilogue`] that describes its effect on a
//! color. The pass that produces the color calls [`Cx::epilogues`](crate::Cx::epilogues), adds the effects to its
//! shader, and binds their resources.

use crate::execute::error::{EffectSetting, RecordError};
use crate::pipelines::bind_groups::Binding;
use framegraph::{AccessKind, Join, PassId, Plan, ResourceId, StepId};
use std::fmt;
use std::hash::{Hash, Hasher};

/// A point-wise function of a color, as a WGSL module. Effects are identified by name: two effects of equal name are
/// the same.
#[derive(Clone, Copy, Debug)]
pub struct Effect {
    /// Name of the WGSL module and of its function `NAME(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32>`.
    pub name: &'static str,
    /// WGSL source of the module.
    pub wgsl: &'static str,
}

impl PartialEq for Effect {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Effect {}

impl Hash for Effect {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.name.hash(state);
    }
}

/// Name of a constant or variable of an effect, with its FNV-1a hash (64 bits). Names are compared by hash. The hash is
/// computed at compile time if the name is a `const`.
#[derive(Clone, Copy)]
pub struct SettingName {
    text: &'static str,
    key: u64,
}

impl SettingName {
    /// Creates a name.
    pub const fn new(text: &'static str) -> Self {
        let (bytes, mut key, mut at) = (text.as_bytes(), 0xCBF2_9CE4_8422_2325, 0);
        while at < bytes.len() {
            key = (key ^ bytes[at] as u64).wrapping_mul(0x0100_0000_01B3);
            at += 1;
        }
        Self { text, key }
    }

    /// Returns the name as in WGSL.
    pub const fn text(self) -> &'static str {
        self.text
    }
}

impl PartialEq for SettingName {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl Eq for SettingName {}

impl fmt::Debug for SettingName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text)
    }
}

/// Effect of a point-wise pass on a color.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Epilogue {
    /// Effects to apply, in order.
    pub effects: Vec<Effect>,
    /// Values of the effects' `override` constants.
    pub constants: Vec<(SettingName, f64)>,
    /// Resources of the effects, by variable name. Binding numbers are known once the shader is assembled.
    pub bindings: Vec<(SettingName, Binding)>,
}

impl Epilogue {
    /// Appends the effects of `next`.
    ///
    /// # Errors
    /// Fails with [`RecordError::EffectConflict`] if both set a constant or binding to different values. An effect that
    /// occurs twice has only one set of values.
    pub fn append(&mut self, next: &Self) -> Result<(), RecordError> {
        for (name, value) in &next.constants {
            match self.constants.iter().find(|(n, _)| n == name) {
                Some((_, own)) if own.to_bits() != value.to_bits() => {
                    return Err(RecordError::EffectConflict(EffectSetting::Constant(name.text)));
                }
                Some(_) => {}
                None => self.constants.push((*name, *value)),
            }
        }
        for (name, binding) in &next.bindings {
            match self.bindings.iter().find(|(n, _)| n == name).map(|(_, binding)| binding) {
                Some(own) if own != binding => {
                    return Err(RecordError::EffectConflict(EffectSetting::Binding(name.text)));
                }
                Some(_) => {}
                None => self.bindings.push((*name, binding.clone())),
            }
        }
        self.effects.extend(&next.effects);
        Ok(())
    }
}

/// A pass that the plan inlined into another pass's fragment shader.
#[derive(Clone, Debug)]
pub(crate) struct Inlined {
    /// Inlined pass.
    pub(crate) pass: PassId,
    /// Color slot that it modifies.
    pub(crate) slot: u8,
    /// Its epilogue; `None` if its recorder returns none.
    pub(crate) epilogue: Option<Epilogue>,
}

/// Returns the passes of a step that are inlined into `pass`, in order, each with its color slot. Includes passes that
/// read the output of other inlined passes.
pub(crate) fn inlined_after(plan: &Plan, step: StepId, pass: PassId) -> Vec<(PassId, u8)> {
    let graph = plan.graph();
    let drawn = graph.accesses_of(pass).iter();
    let drawn = drawn.filter(|a| matches!(a.kind, AccessKind::Color | AccessKind::Resolve));
    let mut slots: Vec<(ResourceId, u8)> = drawn.map(|a| (a.resource, a.slot)).collect();
    let mut found = Vec::new();
    for member in plan.passes_of(step).iter().filter(|m| m.join == Join::Inlined) {
        let accesses = graph.accesses_of(member.pass);
        let input = accesses.iter().find(|a| a.kind == AccessKind::SamePixel);
        let slot =
            input.and_then(|i| slots.iter().find(|(resource, _)| *resource == i.resource)).map(|(_, slot)| *slot);
        let Some(slot) = slot else { continue };
        found.push((member.pass, slot));
        slots.extend(accesses.iter().filter(|a| a.kind == AccessKind::Color).map(|a| (a.resource, slot)));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const STORE: Effect = Effect { name: "store", wgsl: "" };
    const TONE: Effect = Effect { name: "tone", wgsl: "" };
    use framegraph::{
        Caps, ClearValue, DeclareError, Extent, Format, Graph, Intent, Options, Scratch, Texture, TextureDesc, compile,
    };

    #[test]
    fn conflicting_settings_are_an_error() -> Result<(), RecordError> {
        let (zero, map) = (SettingName::new("RGBA16FLOAT_TOWARD_ZERO"), SettingName::new("TONE_MAP"));
        let store = Epilogue { effects: vec![STORE], constants: vec![(zero, 1.0)], bindings: Vec::new() };
        let tone = |curve| Epilogue { effects: vec![TONE], constants: vec![(map, curve)], bindings: Vec::new() };
        // Names are compared by contents, not by address.
        assert_eq!(map, SettingName::new(Box::leak(String::from("TONE_MAP").into_boxed_str())));
        assert_ne!(map, SettingName::new("TONE_MAQ"));
        let mut all = Epilogue::default();
        for next in [&store, &tone(1.0), &store] {
            all.append(next)?;
        }
        assert_eq!(all.effects, [STORE, TONE, STORE]);
        assert_eq!(all.constants, [(zero, 1.0), (map, 1.0)]);
        let message = all.append(&tone(2.0)).map_err(|e| e.to_string()).err().unwrap_or_default();
        assert!(message.contains("TONE_MAP"), "{message}");
        Ok(())
    }

    /// Declares two color outputs in one step, one with a chain of two inlined passes, the other with one.
    #[test]
    fn chains_are_told_apart_by_slot() -> Result<(), Box<dyn std::error::Error>> {
        let desc = |format| TextureDesc::new(Extent::FRAME, format);
        let mut graph = Graph::new();
        let grade = |graph: &mut Graph, name: &str, from: Texture, format| -> Result<Texture, DeclareError> {
            graph.add_fn(name, |p| {
                p.pointwise();
                p.same_pixel(from)?;
                let to = p.texture(name, desc(format));
                p.color(to, Intent::Overwrite)
            })
        };
        let (a, b) = graph.add_fn("scene", |p| {
            p.takes_epilogue();
            let clear = Intent::Clear(ClearValue::BLACK);
            let (a, b) = (p.texture("a", desc(Format::Rgba16Float)), p.texture("b", desc(Format::Rgba16Float)));
            Ok((p.color(a, clear)?, p.color(b, clear)?))
        })?;
        let b = grade(&mut graph, "b0", b, Format::Rgba8Unorm)?;
        let a = grade(&mut graph, "a0", a, Format::Rgba16Float)?;
        let a = grade(&mut graph, "a1", a, Format::Rgba8Unorm)?;
        graph.export(a)?;
        graph.export(b)?;
        let mut plan = Plan::new();
        compile(&graph, &Caps::wgpu(), &Options::default(), &mut Scratch::new(), &mut plan)?;
        assert_eq!(plan.counts().inlined, 3, "{}", framegraph::dump::text(&plan));
        let step = StepId::new(0).ok_or("a step")?;
        let scene = graph.find_pass("scene").ok_or("the scene")?;
        let found = inlined_after(&plan, step, scene);
        let names: Vec<_> = found.iter().map(|(pass, slot)| (graph.pass_name(*pass), *slot)).collect();
        assert_eq!(names, [("b0", 1), ("a0", 0), ("a1", 0)]);
        let other = graph.find_pass("a0").ok_or("a0")?;
        assert_eq!(inlined_after(&plan, step, other).len(), 1, "only later passes are inlined");
        Ok(())
    }
}
