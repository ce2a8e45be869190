//! Plugins: passes and effects that files refer to by kind.

use super::error::FileError;
use super::params::Params;
use super::slot::PluginSlot;
use super::spanned::Source;
use crate::error::DeclareError;
use crate::error_macros::error_enum;
use crate::graph::Graph;
use crate::handle::{Buffer, ReadOnly, Target, Texture};
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;

/// Destination of the passes of a file: a graph, or a back end's frame that contains one.
pub trait Host {
    /// Returns the contained graph.
    fn graph(&mut self) -> &mut Graph;
}

impl Host for Graph {
    fn graph(&mut self) -> &mut Graph {
        self
    }
}

/// A pass, or an effect of several passes, that a file can use.
///
/// `H` is the type that it declares into: [`Graph`] for planning only, or a back end's frame that also stores
/// recorders.
pub trait Plugin<H: ?Sized> {
    /// Slots that a file can bind.
    fn slots(&self) -> &[PluginSlot];

    /// Declares the passes of one entry of a file.
    ///
    /// Passes must be named `call.name()`, or `call.name()/…` if there are several.
    ///
    /// # Errors
    /// Returns an error for an invalid declaration, invalid parameters, or a custom reason ([`PluginError::Custom`]).
    fn declare(&self, host: &mut H, call: &mut Call<'_>) -> Result<(), PluginError>;
}

/// The plugins available to files, by kind.
pub struct Registry<'p, H: ?Sized> {
    kinds: BTreeMap<String, Box<dyn Plugin<H> + 'p>>,
}

impl<'p, H: ?Sized> Registry<'p, H> {
    /// Creates an empty registry.
    pub fn new() -> Self {
        Self { kinds: BTreeMap::new() }
    }

    /// Registers `plugin` as `kind`. Returns `true` if it replaced another plugin.
    pub fn insert(&mut self, kind: &str, plugin: impl Plugin<H> + 'p) -> bool {
        self.kinds.insert(kind.into(), Box::new(plugin)).is_some()
    }

    /// The registered kinds, in alphabetical order.
    pub fn kinds(&self) -> impl Iterator<Item = &str> {
        self.kinds.keys().map(String::as_str)
    }

    /// The slots of a kind, in the order of its plugin; `None` for an unknown kind.
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

error_enum! {
    /// Reason why a plugin declared nothing.
    PluginError {
        /// The graph rejected a declaration.
        Declare(error: DeclareError) => (error.to_string(), String::new());
        /// The parameters are invalid; the error contains the position.
        Params(error: FileError) => (error.to_string(), String::new());
        /// Custom error of the plugin, with a hint:
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

/// A handle that a slot is bound to, or that a plugin returned.
#[derive(Clone, Copy, Debug)]
pub(super) enum Handle {
    Texture(Texture),
    Buffer(Buffer),
    ReadOnly(ReadOnly),
}

/// A slot that the file binds.
#[derive(Debug)]
pub(super) struct Binding<'f> {
    pub(super) slot: PluginSlot,
    /// The name in the file.
    pub(super) name: &'f str,
    /// The bound resource; `None` for a target that the plugin creates.
    pub(super) handle: Option<Handle>,
    /// The result that the plugin returned.
    pub(super) given: Option<Handle>,
}

/// One entry of a file, as passed to its plugin.
#[derive(Debug)]
pub struct Call<'f> {
    pub(super) source: Source<'f>,
    pub(super) name: &'f str,
    pub(super) params: Option<&'f Params>,
    pub(super) bindings: Vec<Binding<'f>>,
}

impl Call<'_> {
    /// Name of the entry, to be used for its passes.
    pub fn name(&self) -> &str {
        self.name
    }

    /// Returns `true` if the file sets parameters.
    pub fn has_params(&self) -> bool {
        self.params.is_some()
    }

    /// Parses the parameters. Parameters that the file does not set have `T`'s defaults.
    ///
    /// # Errors
    /// Returns an error with its position in the file if a field is unknown, missing or invalid.
    pub fn params<T: DeserializeOwned>(&self) -> Result<T, FileError> {
        match self.params {
            Some(params) => params.parse(self.source),
            None => super::syntax::options().from_str("()").map_err(|error| self.source.refused(&error)),
        }
    }

    /// Returns the texture bound to a slot, for reading; `None` if the slot is unbound.
    pub fn texture(&self, slot: &str) -> Option<ReadOnly> {
        match self.binding(slot)?.handle? {
            Handle::Texture(texture) => Some(texture.read_only()),
            Handle::ReadOnly(texture) => Some(texture),
            Handle::Buffer(_) => None,
        }
    }

    /// Returns the texture bound to a slot, as a writable handle. `None` if the slot is unbound or bound to an earlier
    /// history image.
    pub fn current(&self, slot: &str) -> Option<Texture> {
        match self.binding(slot)?.handle? {
            Handle::Texture(texture) => Some(texture),
            Handle::ReadOnly(_) | Handle::Buffer(_) => None,
        }
    }

    /// Returns the buffer bound to a slot; `None` if the slot is unbound, or if the plugin creates the buffer.
    pub fn buffer(&self, slot: &str) -> Option<Buffer> {
        match self.binding(slot)?.handle? {
            Handle::Buffer(buffer) => Some(buffer),
            Handle::Texture(_) | Handle::ReadOnly(_) => None,
        }
    }

    /// Returns the destination of a target slot, and the name of a texture that the plugin creates for it.
    pub fn target(&self, slot: &str) -> (Target, Option<&str>) {
        let into = self.current(slot).map_or(Target::New, |texture| Target::Into(texture.into()));
        (into, self.bound(slot))
    }

    /// Returns the name that the file binds to a slot; `None` if the slot is unbound.
    pub fn bound(&self, slot: &str) -> Option<&str> {
        self.binding(slot).map(|b| b.name)
    }

    /// Returns the result of a target slot to the file. Required for every bound target.
    pub fn give(&mut self, slot: &str, texture: Texture) {
        self.put(slot, Handle::Texture(texture));
    }

    /// Returns the result of a target slot, a buffer, to the file. Required for every bound target.
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
