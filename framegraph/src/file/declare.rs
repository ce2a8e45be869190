//! From a file to a graph: resources first, then passes in the order that `versions` found, each through the same calls
//! that code makes, and refused by the same checks.

use super::error::{FileError, FileReason};
use super::features::Features;
use super::form::{ExportForm, Origin, PassForm, ResourceForm};
use super::plugin::{Handle, Host, Registry};
use super::select::{Declared, Selected, Touch, Wanted};
use super::shape;
use super::spot::Source;
use crate::graph::{Graph, PassKind};
use crate::resource::TextureDesc;

/// Levels × layers × planes of all textures together: what the compiler follows one by one. Sixteen million take it a few
/// hundred megabytes.
const MOST_SUBRESOURCES: u64 = 1 << 24;

/// Resources by row of the selection: the handle of the newest version.
pub(super) type Handles = Vec<Option<Handle>>;

/// What the functions here share.
pub(super) struct Declaring<'a, 'f> {
    pub(super) source: Source<'f>,
    pub(super) features: &'a Features,
    pub(super) selected: &'a Selected<'f>,
}

impl<'f> Declaring<'_, 'f> {
    /// Declares everything that is switched on into `host`; what is refused goes to `errors`.
    pub(super) fn all<H: Host + ?Sized>(
        &self,
        order: &[usize],
        registry: &Registry<'_, H>,
        host: &mut H,
        errors: &mut Vec<FileError>,
    ) {
        let mut handles: Handles = vec![None; self.selected.resources.len()];
        let mut subresources = 0;
        for declared in &self.selected.declared {
            let outcome = self.resource(declared, &mut handles, host.graph(), &mut subresources);
            errors.extend(outcome.err());
        }
        if !errors.is_empty() {
            return;
        }
        for &pass in order {
            let row = &self.selected.passes[pass];
            let outcome = match row.form {
                PassForm::Raster(w) => self.work(row, w, PassKind::Raster, &mut handles, host.graph()),
                PassForm::Compute(w) => self.work(row, w, PassKind::Compute, &mut handles, host.graph()),
                PassForm::Copy(w) => self.work(row, w, PassKind::Copy, &mut handles, host.graph()),
                PassForm::Plugin(p) => self.plugin(row, p, &mut handles, registry, host),
            };
            errors.extend(outcome.err());
        }
        if errors.is_empty() {
            for (form, touch) in &self.selected.exports {
                errors.extend(self.export(form, touch, &handles, host.graph()).err());
            }
        }
    }

    fn resource(
        &self,
        declared: &Declared<'f>,
        handles: &mut Handles,
        graph: &mut Graph,
        subresources: &mut u64,
    ) -> Result<(), FileError> {
        match *declared {
            Declared::Previous(history, age, spot) => {
                let Some(Handle::Texture(texture)) = handles[history] else {
                    let reason = FileReason::Value {
                        detail: "the resource is no history, or stands further down".into(),
                        hint: "list the history before its previous images".into(),
                    };
                    return Err(self.source.error(spot, reason));
                };
                let found = graph.previous(texture, age).map(drop);
                found.map_err(|e| self.source.error(spot, FileReason::Declare(e.reason)))
            }
            Declared::Resource(row, ResourceForm::Texture(form)) => {
                let desc = shape::texture(self.source, self.features, form)?;
                let levels = if desc.mips == TextureDesc::ALL_MIPS { 16 } else { u64::from(desc.mips) };
                let planes = u64::from(desc.format.planes());
                *subresources += levels * u64::from(desc.tracked_layers()) * planes;
                if *subresources > MOST_SUBRESOURCES {
                    let reason = FileReason::Value {
                        detail: format!("more than {MOST_SUBRESOURCES} levels, layers and planes together"),
                        hint: "give the textures fewer levels or layers".into(),
                    };
                    return Err(self.source.error(&form.name, reason));
                }
                let name = &form.name.value;
                let texture = match form.kind {
                    Origin::Transient => graph.texture(name, desc),
                    Origin::Import { entry, exit } => graph.import_texture(name, desc, entry, exit),
                    Origin::History { frames: 0 } => {
                        let reason = FileReason::Value {
                            detail: "a history of 0 frames".into(),
                            hint: "write 1 or more".into(),
                        };
                        return Err(self.source.error(&form.name, reason));
                    }
                    Origin::History { frames } => graph.history(name, desc, frames),
                };
                handles[row] = Some(Handle::Texture(texture));
                Ok(())
            }
            Declared::Resource(row, ResourceForm::Buffer(form)) => {
                let bytes = shape::buffer(self.source, self.features, form)?;
                let buffer = match form.kind {
                    Origin::Import { entry, exit } => graph.import_buffer(&form.name.value, bytes, entry, exit),
                    Origin::Transient | Origin::History { .. } => graph.buffer(&form.name.value, bytes),
                };
                handles[row] = Some(Handle::Buffer(buffer));
                Ok(())
            }
            Declared::Resource(_, ResourceForm::Previous(_)) => Ok(()),
        }
    }

    /// The image of a history that a mention means; none when it means the resource itself.
    pub(super) fn previous(
        &self,
        touch: &Touch<'f>,
        handles: &Handles,
        graph: &mut Graph,
    ) -> Result<Option<Handle>, FileError> {
        let Wanted::Previous(age) = touch.version else {
            return Ok(None);
        };
        let id = self.selected.resources[touch.resource].id;
        let Some(Handle::Texture(history)) = handles[touch.resource] else {
            let reason = FileReason::Value {
                detail: format!("`{id}` is no history"),
                hint: "declare it with `kind: History(frames: 1)`".into(),
            };
            return Err(self.source.error(touch.spot, reason));
        };
        match graph.previous(history, age) {
            Ok(previous) => Ok(Some(Handle::ReadOnly(previous.into()))),
            Err(error) => Err(FileError {
                resource: id.into(),
                ..self.source.error(touch.spot, FileReason::Declare(error.reason))
            }),
        }
    }

    fn export(
        &self,
        form: &ExportForm,
        touch: &Touch<'f>,
        handles: &Handles,
        graph: &mut Graph,
    ) -> Result<(), FileError> {
        match (form, handles[touch.resource]) {
            (ExportForm::Keep(_), Some(Handle::Texture(t))) => graph.export(t),
            (ExportForm::Readback(_), Some(Handle::Texture(t))) => graph.readback(t),
            (ExportForm::Keep(_), Some(Handle::Buffer(b))) => graph.export_buffer(b),
            (ExportForm::Readback(_), Some(Handle::Buffer(b))) => graph.readback_buffer(b),
            (_, Some(Handle::ReadOnly(_)) | None) => {
                return Err(self.source.error(touch.spot, not_made()));
            }
        }
        Ok(())
    }
}

/// A name that a plugin makes is used before that plugin ran.
pub(super) fn not_made() -> FileReason {
    FileReason::Value {
        detail: "the plugin that makes it is listed later".into(),
        hint: "list it first, or name the version: `name@plugin`".into(),
    }
}
