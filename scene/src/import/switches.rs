//! Switches of nodes, lights and materials that glTF has no members for: the object `framegraph` in their `extras`.
//!
//! Wrong values are warnings, and the defaults stay.

use std::ops::RangeInclusive;

use serde_json::{Map, Value};

use super::document::{Document, SWITCHES};
use super::source::{Repair, Warnings};
use crate::draw_options::{DEFAULT_MASK, DrawOptions, MAX_PRIORITY};
use crate::material::{Stencil, StencilCompare, StencilFace, StencilOp};

/// The switches of one object of the file.
pub(super) struct Switches<'a> {
    members: Option<&'a Map<String, Value>>,
    /// `node 3 "name": extras.framegraph`, for messages.
    at: String,
    warnings: &'a mut Warnings,
    read: Vec<&'static str>,
}

impl<'a> Switches<'a> {
    /// Those in `extras` of the object that `pointer` leads to (RFC 6901), which is named `at`.
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

    /// A member, if it is stated and `parse` makes something of it.
    fn member<T>(&mut self, name: &'static str, parse: impl FnOnce(&Value) -> Option<T>) -> Option<T> {
        self.read.push(name);
        let parsed = parse(self.members?.get(name)?);
        if parsed.is_none() {
            self.wrong(name);
        }
        parsed
    }

    /// A whole number in `range`.
    fn whole<T: TryFrom<u64> + PartialOrd>(&mut self, name: &'static str, range: RangeInclusive<T>) -> Option<T> {
        self.member(name, |value| T::try_from(value.as_u64()?).ok().filter(|number| range.contains(number)))
    }

    /// `true` or `false`.
    fn flag(&mut self, name: &'static str) -> Option<bool> {
        self.member(name, Value::as_bool)
    }

    /// One of some words.
    fn word<T: Copy>(&mut self, name: &'static str, words: &[(&str, T)]) -> Option<T> {
        self.member(name, |value| words.iter().find(|(word, _)| value.as_str() == Some(word)).map(|(_, own)| *own))
    }

    /// The switches in a member, if it is stated.
    fn nested(&mut self, name: &'static str) -> Option<Switches<'_>> {
        self.read.push(name);
        let stated = self.members?.get(name)?;
        Some(Switches::new(Some(stated), format!("{}.{name}", self.at), self.warnings))
    }

    /// Warns of members that were not read.
    fn finish(mut self) {
        let all = self.members.into_iter().flatten().map(|(name, _)| name.as_str());
        let unknown: Vec<&str> = all.filter(|name| !self.read.contains(name)).collect();
        unknown.into_iter().for_each(|name| self.wrong(name));
    }

    /// Those of a node, for its instances.
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

    /// The channels of a light.
    pub fn light_channels(mut self) -> u8 {
        let channels = self.whole("lightChannels", 0..=u8::MAX).unwrap_or(DEFAULT_MASK);
        self.finish();
        channels
    }

    /// The stencil state of a material, if it states any.
    pub fn stencil(mut self) -> Option<Box<Stencil>> {
        let stencil = self.nested("stencil").map(|mut stated| {
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
        });
        self.finish();
        stencil
    }

    /// Test and operations of a face; members that are not stated are those of `default`.
    fn stencil_face(&mut self, default: StencilFace) -> StencilFace {
        StencilFace {
            compare: self.word("compare", &StencilCompare::NAMES).unwrap_or(default.compare),
            stencil_fail: self.word("stencilFail", &StencilOp::NAMES).unwrap_or(default.stencil_fail),
            depth_fail: self.word("depthFail", &StencilOp::NAMES).unwrap_or(default.depth_fail),
            pass: self.word("pass", &StencilOp::NAMES).unwrap_or(default.pass),
        }
    }
}
