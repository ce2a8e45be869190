//! Passes and effects that files name by kind: the door between names in data and typed handles in code.

use super::error::FileError;
use super::params::Params;
use super::slot::PluginSlot;
use super::spanned::Source;
use crate::error::DeclareError;
use crate::faults::faults;
use crate::graph::Graph;
use crate::handle::{Buffer, ReadOnly, Target, Texture};
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;

/// What a file's passes are declared into: a graph, or what a back end puts around one.
pub trait Host {
    /// The graph inside.
    fn graph(&mut self) -> &mut Graph;
}

impl Host for Graph {
    fn graph(&mut self) -> &mut Graph {
        self
    }
}

/// A pass, or an effect of several passes, that a file can name.
///
/// `H` is what it declares into: [`Graph`] for planning alone, or a back end's frame, which takes recorders along.
pub trait Plugin<H: ?Sized> {
    /// Its slots. The file may bind no others.
    fn slots(&self) -> &[PluginSlot];

    /// Declares the passes of one entry of a file. Names them `call.name()`, or `call.name()/…` when there are several.
    ///
    /// # Errors
    /// A refused declaration, parameters that do not fit, or a reason of its own ([`PluginError::Custom`]).
    fn declare(&self, host: &mut H, call: &mut Call<'_>) -> Result<(), PluginError>;
}

/// The plugins that files may name, by kind.
pub struct Registry<'p, H: ?Sized> {
    kinds: BTreeMap<String, Box<dyn Plugin<H> + 'p>>,
}

impl<'p, H: ?Sized> Registry<'p, H> {
    /// No plugins.
    pub fn new() -> Self {
        Self { kinds: BTreeMap::new() }
    }

    /// Lets files name `plugin` as `kind`; returns whether that replaced another one.
    pub fn insert(&mut self, kind: &str, plugin: impl Plugin<H> + 'p) -> bool {
        self.kinds.insert(kind.into(), Box::new(plugin)).is_some()
    }

    /// The kinds, in alphabetical order.
    pub fn kinds(&self) -> impl Iterator<Item = &str> {
        self.kinds.keys().map(String::as_str)
    }

    /// The slots of a kind, in the order in which its plugin lists them; none for a kind that nothing has.
    pub fn slots(&self, kind: &str) -> Option<&[PluginSlot]> {
        self.get(kind).map(Plugin::slots)
    }

    pub(super) fn get(&self, kind: &str) -> Option<&(dyn Plugin<H> + 'p)> {
        self.kinds.get(kind).map(|p| &**p)
    }
}

impl<H: ?Sized> Default for Registry<'_, H> {
    fn default() -> Self {
        Self::new()
    }
}

impl<H: ?Sized> std::fmt::Debug for Registry<'_, H> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_set().entries(self.kinds()).finish()
    }
}

faults! {
    /// Why a plugin declared nothing.
    PluginError {
        /// The graph refused a declaration.
        Declare(error: DeclareError) => (error.to_string(), String::new());
        /// The parameters do not fit; the error says where they stand.
        Params(error: FileError) => (error.to_string(), String::new());
        /// A reason of the plugin's own, and what to do:
        Custom { message: String, hint: String } "{message}", "{hint}";
    }
}

impl From<DeclareError> for PluginError {
    fn from(error: DeclareError) -> Self {
        Self::Declare(error)
    }
}

impl From<FileError> for PluginError {
    fn from(error: FileError) -> Self {
        Self::Params(error)
    }
}

/// A handle that a slot is bound to, or that a plugin gave back.
#[derive(Clone, Copy, Debug)]
pub(super) enum Handle {
    Texture(Texture),
    Buffer(Buffer),
    ReadOnly(ReadOnly),
}

/// One slot that the file binds.
#[derive(Debug)]
pub(super) struct Binding<'f> {
    pub(super) slot: PluginSlot,
    /// The name that the file gives.
    pub(super) name: &'f str,
    /// What is there; none for a target that the plugin makes.
    pub(super) handle: Option<Handle>,
    /// What the plugin wrote.
    pub(super) given: Option<Handle>,
}

/// One entry of a file, as its plugin sees it.
#[derive(Debug)]
pub struct Call<'f> {
    pub(super) source: Source<'f>,
    pub(super) name: &'f str,
    pub(super) params: Option<&'f Params>,
    pub(super) bindings: Vec<Binding<'f>>,
}

impl Call<'_> {
    /// The name of the entry: what its passes are to be called.
    pub fn name(&self) -> &str {
        self.name
    }

    /// Whether the file gives parameters.
    pub fn has_params(&self) -> bool {
        self.params.is_some()
    }

    /// The parameters; those that the file leaves out take `T`'s defaults.
    ///
    /// # Errors
    /// Fields that `T` does not have, lacks, or cannot hold, with their place in the file.
    pub fn params<T: DeserializeOwned>(&self) -> Result<T, FileError> {
        match self.params {
            Some(params) => params.parse(self.source),
            None => super::syntax::options().from_str("()").map_err(|error| self.source.refused(&error)),
        }
    }

    /// The texture to read that the slot is bound to; none when it is left unbound.
    pub fn texture(&self, slot: &str) -> Option<ReadOnly> {
        match self.binding(slot)?.handle? {
            Handle::Texture(texture) => Some(texture.read_only()),
            Handle::ReadOnly(texture) => Some(texture),
            Handle::Buffer(_) => None,
        }
    }

    /// As [`Call::texture`], as a handle of the resource's own version: none also for an earlier image of a history.
    pub fn current(&self, slot: &str) -> Option<Texture> {
        match self.binding(slot)?.handle? {
            Handle::Texture(texture) => Some(texture),
            Handle::ReadOnly(_) | Handle::Buffer(_) => None,
        }
    }

    /// The buffer that the slot is bound to, to read or to write; none when it is left unbound, or the plugin makes it.
    pub fn buffer(&self, slot: &str) -> Option<Buffer> {
        match self.binding(slot)?.handle? {
            Handle::Buffer(buffer) => Some(buffer),
            Handle::Texture(_) | Handle::ReadOnly(_) => None,
        }
    }

    /// Where the result of a target slot goes, and what to call it if the plugin makes it.
    pub fn target(&self, slot: &str) -> (Target, Option<&str>) {
        let into = self.current(slot).map_or(Target::New, |texture| Target::Into(texture.into()));
        (into, self.bound(slot))
    }

    /// The name that the file binds to a slot; none when it is left unbound.
    pub fn bound(&self, slot: &str) -> Option<&str> {
        self.binding(slot).map(|b| b.name)
    }

    /// Hands over the texture that a target slot now stands for. Every bound target must be given.
    pub fn give(&mut self, slot: &str, texture: Texture) {
        self.put(slot, Handle::Texture(texture));
    }

    /// Hands over the buffer that a target slot now stands for. Every bound target must be given.
    pub fn give_buffer(&mut self, slot: &str, buffer: Buffer) {
        self.put(slot, Handle::Buffer(buffer));
    }

    fn put(&mut self, slot: &str, handle: Handle) {
        if let Some(binding) = self.bindings.iter_mut().find(|b| b.slot.name == slot) {
            binding.given = Some(handle);
        }
    }

    fn binding(&self, slot: &str) -> Option<&Binding<'_>> {
        self.bindings.iter().find(|b| b.slot.name == slot)
    }
}
