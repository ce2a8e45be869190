//! Declares a file's resources and passes in the order found by `versions`. Uses the same methods and checks as code.

use super::error::{FileError, FileErrors, FileReason};
use super::features::Features;
use super::form::{ExportForm, ForwardForm, Origin, PassForm, ResourceForm};
use super::plugin::{Handle, Host, Registry};
use super::selected::{Declared, Mention, Selected, Wanted};
use super::shape;
use super::spanned::Source;
use super::value::ValueReason;
use crate::access::Range;
use crate::error::{DeclareError, DeclareReason};
use crate::graph::{Graph, PassKind};
use crate::resource::TextureDesc;

/// Maximum number of subresources of all textures. The compiler tracks each of them; the maximum needs a few hundred
/// megabytes.
const MAX_SUBRESOURCES: u64 = 1 << 24;

/// Handle of the newest version of each resource of the selection.
pub(super) type Handles = Vec<Option<Handle>>;

/// Context of declaring.
#[derive(Clone, Copy)]
pub(super) struct Declaring<'a, 'f> {
    pub(super) source: Source<'f>,
    pub(super) features: &'a Features,
    pub(super) selected: &'a Selected<'f>,
}

/// Declares every enabled and valid entry into `host` and collects errors. Skips entries that depend on an invalid
/// pass.
pub(super) fn all<'f, H: Host + ?Sized>(
    source: Source<'f>,
    features: &Features,
    selected: &mut Selected<'f>,
    order: &[usize],
    registry: &Registry<'_, H>,
    host: &mut H,
    errors: &mut FileErrors,
) {
    let mut handles: Handles = vec![None; selected.resources.len()];
    let mut subresources = 0;
    for index in 0..selected.declared.len() {
        let declaring = Declaring { source: source.unless(errors.is_full()), features, selected };
        let declared = selected.declared[index];
        if let Err(error) = declaring.resource(&declared, &mut handles, host.graph(), &mut subresources) {
            errors.push(|| error);
            if let Declared::Resource(row, _) = declared {
                selected.lost[row] = true;
            }
        }
    }
    for &pass in order {
        let row = &selected.passes[pass];
        if row.failed || row.mentions.iter().any(|m| selected.lost[m.resource]) {
            selected.fail(pass);
            continue;
        }
        let declaring = Declaring { source: source.unless(errors.is_full()), features, selected };
        let outcome = match row.form {
            PassForm::Raster(w) => declaring.work(row, w, PassKind::Raster, &mut handles, host.graph()),
            PassForm::Compute(w) => declaring.work(row, w, PassKind::Compute, &mut handles, host.graph()),
            PassForm::Copy(w) => declaring.work(row, w, PassKind::Copy, &mut handles, host.graph()),
            PassForm::Plugin(p) => declaring.plugin(row, p, &mut handles, registry, host),
        };
        if let Err(error) = outcome {
            errors.push(|| error);
            selected.fail(pass);
        }
    }
    for &(form, of, to) in selected.forwards.iter().filter(|(_, of, to)| !selected.lost[*of] && !selected.lost[*to]) {
        let declaring = Declaring { source: source.unless(errors.is_full()), features, selected };
        if let Err(error) = declaring.forward(form, (of, to), &mut handles, host.graph()) {
            errors.push(|| error);
        }
    }
    for (form, mention) in selected.exports.iter().filter(|(_, m)| !selected.lost[m.resource]) {
        let declaring = Declaring { source: source.unless(errors.is_full()), features, selected };
        if let Err(error) = declaring.export(form, mention, &handles, host.graph()) {
            errors.push(|| error);
        }
    }
}

impl<'f> Declaring<'_, 'f> {
    fn resource(
        &self,
        declared: &Declared<'f>,
        handles: &mut Handles,
        graph: &mut Graph,
        subresources: &mut u64,
    ) -> Result<(), FileError> {
        match *declared {
            Declared::Previous(history, age, at) => {
                let texture = match handles[history] {
                    Some(Handle::Texture(texture)) => texture,
                    _ if self.selected.lost[history] => return Ok(()),
                    Some(_) => return Err(self.source.value(at, ValueReason::NotAHistory { id: at.value.clone() })),
                    None => {
                        let listed = |d: &Declared<'_>| matches!(d, Declared::Resource(row, _) if *row == history);
                        let below = self.selected.declared.iter().any(listed);
                        let other = ValueReason::NotAHistory { id: at.value.clone() };
                        return Err(self.source.value(at, if below { ValueReason::PreviousAbove } else { other }));
                    }
                };
                let found = graph.previous(texture, age).map(drop);
                found.map_err(|e| self.source.error(at, FileReason::Declare(e.reason)))
            }
            Declared::Alias(pair, form) => {
                let aliased = match pair.map(|row| handles[row]) {
                    [Some(Handle::Texture(a)), Some(Handle::Texture(b))] => graph.may_alias(a, b).map_err(|e| e.reason),
                    [Some(Handle::Buffer(a)), Some(Handle::Buffer(b))] => {
                        graph.may_alias_buffer(a, b).map_err(|e| e.reason)
                    }
                    _ if pair.iter().any(|row| self.selected.lost[*row]) => Ok(()),
                    [Some(_), Some(_)] => Err(DeclareReason::NoAlias),
                    _ => return Err(self.source.value(&form.of, ValueReason::AliasAbove)),
                };
                aliased.map_err(|reason| self.source.error(&form.of, FileReason::Declare(reason)))
            }
            Declared::Resource(row, ResourceForm::Texture(form)) => {
                let desc = shape::texture(self.source, self.features, form)?;
                let levels = if desc.mips == TextureDesc::ALL_MIPS { 16 } else { u64::from(desc.mips) };
                let planes = u64::from(desc.format.planes());
                *subresources += levels * u64::from(desc.tracked_layers()) * planes;
                if *subresources > MAX_SUBRESOURCES {
                    let fault = ValueReason::Subresources { max: MAX_SUBRESOURCES };
                    return Err(self.source.value(&form.name, fault));
                }
                let name = &form.name.value;
                let texture = match form.kind {
                    Origin::Transient => graph.texture(name, desc),
                    Origin::Import { entry, exit } => graph.import_texture(name, desc, entry, exit),
                    Origin::History { frames: 0 } => {
                        return Err(self.source.value(&form.name, ValueReason::EmptyHistory));
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
            Declared::Resource(_, ResourceForm::Previous(_) | ResourceForm::MayAlias(_)) => Ok(()),
        }
    }

    /// Returns the history image that a mention refers to; `None` if it refers to the resource itself.
    pub(super) fn previous(
        &self,
        mention: &Mention<'f>,
        handles: &Handles,
        graph: &mut Graph,
    ) -> Result<Option<Handle>, FileError> {
        let Wanted::Previous(age) = mention.version else {
            return Ok(None);
        };
        let id = self.selected.resources[mention.resource];
        let Some(Handle::Texture(history)) = handles[mention.resource] else {
            return Err(self.source.value(mention.at, ValueReason::NotAHistory { id: id.into() }));
        };
        let refused = |e: DeclareError| self.source.error(mention.at, FileReason::Declare(e.reason)).of_resource(id);
        graph.previous(history, age).map(|previous| Some(Handle::ReadOnly(previous.into()))).map_err(refused)
    }

    fn forward(
        &self,
        form: &ForwardForm,
        (of, to): (usize, usize),
        handles: &mut Handles,
        graph: &mut Graph,
    ) -> Result<(), FileError> {
        let (Some(Handle::Texture(texture)), Some(Handle::Texture(into))) = (handles[of], handles[to]) else {
            return Err(self.source.value(&form.of, ValueReason::ForwardsTextures));
        };
        let mut range = Range::ALL;
        if let Some(mip) = form.mip.number() {
            (range.mip, range.mips) = (mip, 1);
        }
        if let Some(layer) = form.layer.number() {
            (range.layer, range.layers) = (layer, 1);
        }
        let name = self.selected.resources[of];
        let refused = |e: DeclareError| self.source.error(&form.of, FileReason::Declare(e.reason)).of_resource(name);
        handles[to] = Some(Handle::Texture(graph.forward(texture, into.range(range)).map_err(refused)?));
        handles[of] = None;
        Ok(())
    }

    fn export(
        &self,
        form: &ExportForm,
        mention: &Mention<'f>,
        handles: &Handles,
        graph: &mut Graph,
    ) -> Result<(), FileError> {
        let exported = match (form, handles[mention.resource]) {
            (ExportForm::Keep(_), Some(Handle::Texture(t))) => graph.export(t),
            (ExportForm::Readback(_), Some(Handle::Texture(t))) => graph.readback(t),
            (ExportForm::Keep(_), Some(Handle::Buffer(b))) => graph.export_buffer(b),
            (ExportForm::Readback(_), Some(Handle::Buffer(b))) => graph.readback_buffer(b),
            (ExportForm::Forward(_), _) | (_, Some(Handle::ReadOnly(_)) | None) => {
                return Err(self.source.value(mention.at, ValueReason::MadeLater));
            }
        };
        exported.map_err(|e| self.source.error(mention.at, FileReason::Declare(e.reason)))
    }
}
