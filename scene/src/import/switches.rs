//! Switches of nodes, lights and materials without glTF members: the object `framegraph` in their `extras`.
//!
//! Invalid values produce warnings and keep the defaults.

use std::ops::RangeInclusive;

use glam::Vec3;
use serde_json::{Map, Value};

use super::document::{Document, SWITCHES};
use super::source::{Repair, Warnings};
use crate::draw_options::{DrawOptions, MAX_PRIORITY};
use crate::light::{Light, SunHalo};
use crate::material::{
    AlphaMode, Material, Stencil, StencilCompare, StencilFace, StencilOp, Subsurface, TransparencyMode,
};

/// Switches of one object of the file.
pub(super) struct Switches<'a> {
    members: Option<&'a Map<String, Value>>,
    /// Place for messages: `node 3 "name": extras.framegraph`.
    at: String,
    warnings: &'a mut Warnings,
    read: Vec<&'static str>,
}

impl<'a> Switches<'a> {
    /// Returns the switches of the object at `pointer` (RFC 6901), named `at`.
    pub fn of(document: &'a Document, pointer: &str, at: &str, warnings: &'a mut Warnings) -> Self {
        Self::new(document.switches.get(pointer), format!("{at}: extras.{SWITCHES}"), warnings)
    }

    fn new(stated: Option<&'a Value>, at: String, warnings: &'a mut Warnings) -> Self {
        if stated.is_some_and(|stated| !stated.is_object()) {
            warnings.count(Repair::Switches, &at, 1);
        }
        Self { members: stated.and_then(Value::as_object), at, warnings, read: Vec::new() }
    }

    fn wrong(&mut self, member: &str) {
        self.warnings.count(Repair::Switches, &format!("{}.{member}", self.at), 1);
    }

    /// Returns a member if present and accepted by `parse`.
    fn member<T>(&mut self, name: &'static str, parse: impl FnOnce(&Value) -> Option<T>) -> Option<T> {
        self.read.push(name);
        let parsed = parse(self.members?.get(name)?);
        if parsed.is_none() {
            self.wrong(name);
        }
        parsed
    }

    /// Returns an integer in `range`.
    fn whole<T: TryFrom<u64> + PartialOrd>(&mut self, name: &'static str, range: RangeInclusive<T>) -> Option<T> {
        self.member(name, |value| T::try_from(value.as_u64()?).ok().filter(|number| range.contains(number)))
    }

    /// Returns a boolean.
    fn flag(&mut self, name: &'static str) -> Option<bool> {
        self.member(name, Value::as_bool)
    }

    /// Returns a number in `min…max`.
    fn number(&mut self, name: &'static str, [min, max]: [f32; 2]) -> Option<f32> {
        self.member(name, |value| Some(value.as_f64()? as f32).filter(|number| (min..=max).contains(number)))
    }

    /// Returns a color of three channels in 0…1, linear Rec.709.
    fn color(&mut self, name: &'static str) -> Option<Vec3> {
        self.member(name, |value| {
            let [r, g, b] = value.as_array()?.as_slice() else { return None };
            let color = Vec3::new(r.as_f64()? as f32, g.as_f64()? as f32, b.as_f64()? as f32);
            (color.min_element() >= 0.0 && color.max_element() <= 1.0).then_some(color)
        })
    }

    /// Returns the value of one of these words.
    fn word<T: Copy>(&mut self, name: &'static str, words: &[(&str, T)]) -> Option<T> {
        self.member(name, |value| words.iter().find(|(word, _)| value.as_str() == Some(word)).map(|(_, own)| *own))
    }

    /// Returns the switches in a member, if present.
    fn nested(&mut self, name: &'static str) -> Option<Switches<'_>> {
        self.read.push(name);
        let stated = self.members?.get(name)?;
        let nested = Switches::new(Some(stated), format!("{}.{name}", self.at), self.warnings);
        nested.members.is_some().then_some(nested)
    }

    /// Warns about unknown members.
    fn finish(mut self) {
        let all = self.members.into_iter().flatten().map(|(name, _)| name.as_str());
        let unknown: Vec<&str> = all.filter(|name| !self.read.contains(name)).collect();
        unknown.into_iter().for_each(|name| self.wrong(name));
    }

    /// Returns the draw options of a node's instances.
    pub fn draw_options(mut self) -> DrawOptions {
        let default = DrawOptions::default();
        let options = DrawOptions {
            layers: self.whole("layers", 0..=u8::MAX).unwrap_or(default.layers),
            light_channels: self.whole("lightChannels", 0..=u8::MAX).unwrap_or(default.light_channels),
            priority: self.whole("priority", 0..=MAX_PRIORITY).unwrap_or(default.priority),
            blend_order: self.whole("blendOrder", 0..=u16::MAX).unwrap_or(default.blend_order),
            global_blend_order: self.flag("globalBlendOrder").unwrap_or(default.global_blend_order),
            casts_shadows: self.flag("castShadows").unwrap_or(default.casts_shadows),
            receives_shadows: self.flag("receiveShadows").unwrap_or(default.receives_shadows),
        };
        self.finish();
        options
    }

    /// Reads the switches of a light.
    pub fn light(mut self, light: &mut Light) {
        light.channels = self.whole("lightChannels", 0..=u8::MAX).unwrap_or(light.channels);
        light.shadow_strength = self.number("shadowStrength", [0.0, 1.0]).unwrap_or(light.shadow_strength);
        light.halo = self.nested("sunHalo").map(|mut stated| {
            let default = SunHalo::FILAMENT;
            let halo = SunHalo {
                size: stated.number("size", SunHalo::SIZES).unwrap_or(default.size),
                falloff: stated.number("falloff", SunHalo::FALLOFFS).unwrap_or(default.falloff),
            };
            stated.finish();
            halo
        });
        self.finish();
    }

    /// Reads the switches of a material.
    pub fn material(mut self, material: &mut Material) {
        material.stencil = self.stencil();
        let changes = self.flag("clearCoatIorChange");
        if let (Some(coat), Some(changes)) = (&mut material.clear_coat, changes) {
            coat.keeps_base_f0 = !changes;
        }
        material.subsurface = self.nested("subsurface").map(|mut stated| {
            let default = Subsurface::default();
            let subsurface = Subsurface {
                color: stated.color("color").unwrap_or(default.color),
                power: stated.number("power", [0.0, Subsurface::MAX_POWER]).unwrap_or(default.power),
                thickness: stated.number("thickness", [0.0, 1.0]).unwrap_or(default.thickness),
            };
            stated.finish();
            subsurface
        });
        let transparency = self.word("transparency", &TransparencyMode::NAMES);
        material.transparency = transparency.unwrap_or(material.transparency);
        material.cloth_subsurface = self.color("clothSubsurface");
        if let Some(strength) = self.number("shadowCatcher", [0.0, 1.0]) {
            (material.shadow_catcher, material.unlit, material.alpha) = (Some(strength), true, AlphaMode::Blend);
        }
        self.finish();
    }

    /// Returns the stencil state of a material, if present.
    fn stencil(&mut self) -> Option<Box<Stencil>> {
        self.nested("stencil").map(|mut stated| {
            let default = Stencil::default();
            let front = stated.stencil_face(default.front);
            let back = stated.nested("back").map(|mut back| {
                let face = back.stencil_face(front);
                back.finish();
                face
            });
            let stencil = Stencil {
                write: stated.flag("write").unwrap_or(default.write),
                reference: stated.whole("reference", 0..=u8::MAX).unwrap_or(default.reference),
                read_mask: stated.whole("readMask", 0..=u8::MAX).unwrap_or(default.read_mask),
                write_mask: stated.whole("writeMask", 0..=u8::MAX).unwrap_or(default.write_mask),
                front,
                back: back.unwrap_or(front),
            };
            stated.finish();
            Box::new(stencil)
        })
    }

    /// Returns test and operations of a face; missing members are those of `default`.
    fn stencil_face(&mut self, default: StencilFace) -> StencilFace {
        StencilFace {
            compare: self.word("compare", &StencilCompare::NAMES).unwrap_or(default.compare),
            stencil_fail: self.word("stencilFail", &StencilOp::NAMES).unwrap_or(default.stencil_fail),
            depth_fail: self.word("depthFail", &StencilOp::NAMES).unwrap_or(default.depth_fail),
            pass: self.word("pass", &StencilOp::NAMES).unwrap_or(default.pass),
        }
    }
}
