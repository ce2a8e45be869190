//! Switches of nodes, lights and materials that glTF has no members for: the object `framegraph` in their `extras`.
//!
//! Wrong values are warnings, and the defaults stay.

use std::ops::RangeInclusive;

use serde_json::{Map, Value};

use super::document::Document;
use super::source::{Repair, Warnings};
use crate::draw_options::{DEFAULT_MASK, DrawOptions, MAX_PRIORITY};

/// The member of `extras` that is read.
pub(super) const KEY: &str = "framegraph";

/// The switches of one object of the file.
pub(super) struct Switches<'a> {
    members: Option<&'a Map<String, Value>>,
    /// `node 3 "name"`, for messages.
    at: &'a str,
    warnings: &'a mut Warnings,
    read: Vec<&'static str>,
}

impl<'a> Switches<'a> {
    /// Those in `extras` of the object that `pointer` leads to (RFC 6901).
    pub fn of(document: &'a Document, pointer: &str, at: &'a str, warnings: &'a mut Warnings) -> Self {
        let stated = document.switches.get(pointer);
        if stated.is_some_and(|stated| !stated.is_object()) {
            warnings.count(Repair::Switches, &format!("{at}: extras.{KEY}"), 1);
        }
        Self { members: stated.and_then(Value::as_object), at, warnings, read: Vec::new() }
    }

    fn wrong(&mut self, member: &str) {
        self.warnings.count(Repair::Switches, &format!("{}: extras.{KEY}.{member}", self.at), 1);
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
}
