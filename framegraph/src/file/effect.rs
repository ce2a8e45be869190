//! Passes declared by plugins: binds slots by name and takes back results.

use super::declare::{Declaring, Handles};
use super::error::{FileError, FileErrors, FileReason};
use super::form::PluginForm;
use super::plugin::{Binding, Call, Handle, Host, PluginError, Registry};
use super::selected::{PassRow, Wanted};
use super::slot::SlotType;
use super::spanned::Spanned;
use super::value::ValueReason;

impl<'f> Declaring<'_, 'f> {
    /// Declares one entry with its plugin.
    pub(super) fn plugin<H: Host + ?Sized>(
        &self,
        row: &PassRow<'f>,
        form: &'f PluginForm,
        handles: &mut Handles,
        registry: &Registry<'_, H>,
        host: &mut H,
    ) -> Result<(), FileError> {
        let kind = form.kind.value.as_str();
        // Unknown kinds were reported before.
        let Some(plugin) = registry.get(kind) else {
            return Ok(());
        };
        let mut bindings = Vec::with_capacity(row.mentions.len());
        for mention in &row.mentions {
            let (slot, _) = &form.slots.0[mention.index];
            let Some(slot) = plugin.slots().iter().find(|s| s.name == slot.value) else {
                continue;
            };
            let previous = self.previous(mention, handles, host.graph())?;
            let handle = previous.or(handles[mention.resource]);
            let name = self.selected.resources[mention.resource];
            let fault = match (slot.ty, handle) {
                (SlotType::Texture, Some(Handle::Texture(_) | Handle::ReadOnly(_)))
                | (SlotType::Buffer, Some(Handle::Buffer(_)))
                | (SlotType::Target, Some(Handle::Texture(_)) | None)
                | (SlotType::TargetBuffer, Some(Handle::Buffer(_)) | None) => None,
                (_, None) if mention.version == Wanted::Entry => Some(ValueReason::MadeEmpty),
                (_, None) if row.mentions.iter().any(|m| m.writes && m.resource == mention.resource) => {
                    Some(ValueReason::MadeHere)
                }
                (_, None) => Some(ValueReason::MadeLater),
                (ty, Some(_)) => Some(ValueReason::SlotType { slot: slot.name.into(), ty }),
            };
            if let Some(fault) = fault {
                return Err(self.source.value(mention.at, fault).of_pass(&row.id.value).of_resource(name));
            }
            debug_assert!(mention.version != Wanted::Previous(0));
            bindings.push(Binding { slot: *slot, name, handle, given: None });
        }
        let mut call = Call { source: self.source, name: &form.name.value, params: form.params.as_ref(), bindings };
        if let Err(error) = plugin.declare(host, &mut call) {
            return Err(self.refused(row, form, error));
        }
        for (mention, binding) in row.mentions.iter().zip(&call.bindings).filter(|(m, _)| m.writes) {
            if binding.given.is_none() {
                let reason = FileReason::Plugin {
                    plugin: kind.into(),
                    message: format!("slot `{}` was not written", binding.slot.name),
                    hint: "leave the slot unbound, or fix the plugin (`Call::give`)".into(),
                };
                return Err(self.source.error(mention.at, reason));
            }
            handles[mention.resource] = binding.given;
        }
        Ok(())
    }

    fn refused(&self, row: &PassRow<'f>, form: &'f PluginForm, error: PluginError) -> FileError {
        let refused = |reason| self.source.error(row.id, reason);
        let error = match error {
            // Omitted parameters have no position in the file, so the error points at the plugin.
            PluginError::Params(error) if form.params.is_none() => {
                let FileError { line, column, .. } = refused((*error.reason).clone());
                FileError { line, column, ..error }
            }
            PluginError::Params(error) => error,
            PluginError::Declare(error) => {
                let resource = error.resource.map(|r| r.name);
                FileError { resource, ..refused(FileReason::Declare(error.reason)) }
            }
            PluginError::Custom { message, hint } => {
                refused(FileReason::Plugin { plugin: form.kind.value.clone(), message, hint })
            }
        };
        error.of_pass(&row.id.value)
    }

    /// Reports unknown plugin kinds, unknown slots and missing slots.
    pub(super) fn check<H: ?Sized>(
        &self,
        row: &PassRow<'f>,
        form: &PluginForm,
        registry: &Registry<'_, H>,
        errors: &mut FileErrors,
    ) {
        let source = self.source.unless(errors.is_full());
        let mut refuse = |at: &Spanned<String>, reason| {
            errors.push(|| source.error(at, reason).of_pass(&row.id.value));
        };
        let kind = form.kind.value.as_str();
        let Some(plugin) = registry.get(kind) else {
            let kinds: Vec<_> = registry.kinds().collect();
            return refuse(&form.kind, FileReason::unknown("plugin", kind, kinds.into_iter()));
        };
        let slots = plugin.slots();
        let unknown = form.slots.0.iter().filter(|(bound, _)| !slots.iter().any(|s| s.name == bound.value));
        let mut misspelt = false;
        for (bound, _) in unknown {
            refuse(bound, FileReason::unknown("slot", &bound.value, slots.iter().map(|s| s.name)));
            misspelt = true;
        }
        // A missing slot is probably the misspelled one.
        if misspelt {
            return;
        }
        for slot in slots.iter().filter(|s| !s.optional) {
            if !form.slots.0.iter().any(|(bound, _)| bound.value == slot.name) {
                let (plugin, slot) = (kind.to_owned(), slot.name.to_owned());
                refuse(row.id, FileReason::Unbound { plugin, slot });
            }
        }
    }
}
