//! Passes that plugins declare: slots bound by name, results taken back.

use super::declare::{Declaring, Handles, not_made};
use super::error::{FileError, FileReason};
use super::form::PluginForm;
use super::plugin::{Binding, Call, Handle, Host, PluginError, PluginSlot, Registry, Takes};
use super::select::{PassRow, Wanted};
use super::spot::Spot;
use super::suggest::nearest;

impl<'f> Declaring<'_, 'f> {
    /// Declares one entry through its plugin.
    pub(super) fn plugin<H: Host + ?Sized>(
        &self,
        row: &PassRow<'f>,
        form: &'f PluginForm,
        handles: &mut Handles,
        registry: &Registry<'_, H>,
        host: &mut H,
    ) -> Result<(), FileError> {
        let kind = form.kind.value.as_str();
        // Kinds that are not known were reported before anything was declared.
        let Some(plugin) = registry.get(kind) else {
            return Ok(());
        };
        let mut bindings = Vec::with_capacity(row.touches.len());
        for touch in &row.touches {
            let (slot, _) = &form.slots.0[touch.index];
            let Some(slot) = plugin.slots().iter().find(|s| s.name == slot.value) else {
                continue;
            };
            let previous = self.previous(touch, handles, host.graph())?;
            let handle = previous.or(handles[touch.resource]);
            let fits = match (slot.takes, handle) {
                (Takes::Texture, Some(Handle::Texture(_) | Handle::ReadOnly(_)))
                | (Takes::Buffer, Some(Handle::Buffer(_)))
                | (Takes::Target, Some(Handle::Texture(_)) | None)
                | (Takes::TargetBuffer, Some(Handle::Buffer(_)) | None) => Ok(()),
                (_, None) => Err(not_made()),
                (takes, Some(_)) => Err(wrong_type(slot, takes)),
            };
            fits.map_err(|reason| FileError {
                pass: row.id.into(),
                resource: self.selected.resources[touch.resource].id.into(),
                ..self.source.error(touch.spot, reason)
            })?;
            debug_assert!(touch.version != Wanted::Previous(0));
            let name = self.selected.resources[touch.resource].id;
            bindings.push(Binding { slot: *slot, name, handle, given: None });
        }
        let mut call = Call { source: self.source, name: &form.name.value, params: form.params.as_ref(), bindings };
        if let Err(error) = plugin.declare(host, &mut call) {
            return Err(self.refused(row, kind, error));
        }
        for (touch, binding) in row.touches.iter().zip(&call.bindings) {
            match (touch.writes, binding.given) {
                (true, None) => {
                    let reason = FileReason::Plugin {
                        plugin: kind.into(),
                        message: format!("it did not write its slot `{}`", binding.slot.name),
                        hint: "leave the slot unbound, or mend the plugin (`Call::give`)".into(),
                    };
                    return Err(self.source.error(touch.spot, reason));
                }
                (true, given) => handles[touch.resource] = given,
                (false, _) => {}
            }
        }
        Ok(())
    }

    fn refused(&self, row: &PassRow<'f>, kind: &str, error: PluginError) -> FileError {
        let (resource, reason) = match error {
            PluginError::Params(error) => {
                return FileError { pass: row.id.into(), ..error };
            }
            PluginError::Declare(error) => (error.resource, FileReason::Declare(error.reason)),
            PluginError::Custom { message, hint } => {
                (String::new(), FileReason::Plugin { plugin: kind.into(), message, hint })
            }
        };
        FileError { pass: row.id.into(), resource, ..self.source.error(row.spot, reason) }
    }

    /// Kinds that nothing has, slots that the kind has not, and slots that are missing.
    pub(super) fn check<H: ?Sized>(
        &self,
        row: &PassRow<'f>,
        form: &PluginForm,
        registry: &Registry<'_, H>,
        errors: &mut Vec<FileError>,
    ) {
        let mut refuse = |spot: &Spot<String>, reason| {
            errors.push(FileError { pass: row.id.into(), ..self.source.error(spot, reason) });
        };
        let kind = form.kind.value.as_str();
        let Some(plugin) = registry.get(kind) else {
            let reason = FileReason::Unknown {
                what: "plugin",
                name: kind.into(),
                near: nearest(kind, registry.kinds()).map(str::to_owned),
                known: registry.kinds().take(9).map(str::to_owned).collect(),
            };
            return refuse(&form.kind, reason);
        };
        let slots = plugin.slots();
        for (bound, _) in &form.slots.0 {
            if !slots.iter().any(|s| s.name == bound.value) {
                let names = || slots.iter().map(|s| s.name);
                let reason = FileReason::Unknown {
                    what: "slot",
                    name: bound.value.clone(),
                    near: nearest(&bound.value, names()).map(str::to_owned),
                    known: names().take(9).map(str::to_owned).collect(),
                };
                refuse(bound, reason);
            }
        }
        for slot in slots.iter().filter(|s| !s.optional) {
            if !form.slots.0.iter().any(|(bound, _)| bound.value == slot.name) {
                let (plugin, slot) = (kind.to_owned(), slot.name.to_owned());
                refuse(row.spot, FileReason::Unbound { plugin, slot });
            }
        }
    }
}

fn wrong_type(slot: &PluginSlot, takes: Takes) -> FileReason {
    let wanted = match takes {
        Takes::Texture => "a texture to read",
        Takes::Buffer => "a buffer to read",
        Takes::Target => "a texture to write",
        Takes::TargetBuffer => "a buffer to write",
    };
    FileReason::Value {
        detail: format!("slot `{}` takes {wanted}", slot.name),
        hint: "bind a resource of that type".into(),
    }
}
