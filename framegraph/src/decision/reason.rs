//! The list of reasons. Each row defines a variant of [`Reason`], its name in JSON, its sentence and its hint.
//!
//! A macro is needed because a function cannot define the variants of an enumeration.

use crate::graph::Graph;
use crate::id::{PassId, ResourceId, StepId};
use crate::sanitize::escape_controls;

/// Ids and causes that a reason contains.
#[derive(Clone, Copy, Debug, Default)]
pub struct Names {
    /// The named pass.
    pub pass: Option<PassId>,
    /// The named resource.
    pub resource: Option<ResourceId>,
    /// The named step.
    pub step: Option<StepId>,
    /// The cause of a split or of an epilogue that is not inlined.
    pub refusal: Option<Refusal>,
    /// The cause of memory for an attachment.
    pub need: Option<MemoryNeed>,
}

/// One row of the list.
struct Row {
    word: &'static str,
    /// Sentence with the placeholders `{pass}`, `{resource}` and `{why}`.
    sentence: &'static str,
    hint: &'static str,
    names: Names,
}

/// Defines [`Reason`] from rows of the form `Variant(name: type, …) "word", "sentence", "hint";`.
///
/// The hint is empty if there is no alternative, or if the contained refusal or memory need has a hint.
macro_rules! reasons {
    ($($variant:ident $(($($name:ident: $type:ty),+))? $word:literal, $sentence:literal, $hint:literal;)+) => {
        /// A decision together with its cause. The fields of a variant appear in its sentence.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[non_exhaustive]
        pub enum Reason {
            $(#[doc = $sentence] $variant $(($($type),+))?,)+
        }

        impl Reason {
            const fn row(self) -> Row {
                let none = Names { pass: None, resource: None, step: None, refusal: None, need: None };
                match self {
                    $(Self::$variant $(($($name),+))? => {
                        let names = Names { $($($name: Some($name),)+)? ..none };
                        Row { word: $word, sentence: $sentence, hint: $hint, names }
                    })+
                }
            }

            /// Returns every reason whose fields are present in `names`.
            #[cfg(feature = "internals")]
            pub(crate) fn all(names: Names) -> Vec<Self> {
                let makers: [fn(&Names) -> Option<Self>; _] = [$(|_given| Some(Self::$variant $(($(_given.$name?),+))?)),+];
                makers.iter().filter_map(|make| make(&names)).collect()
            }
        }
    };
}

/// Defines an enumeration of causes from rows of the form `Variant "word", "sentence", "hint";`.
macro_rules! causes {
    ($(#[$doc:meta])* $name:ident $($(#[$more:meta])* $variant:ident $word:literal, $sentence:literal, $hint:literal;)+) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum $name {
            $(#[doc = $sentence] $(#[$more])* $variant,)+
        }

        impl $name {
            /// Every cause.
            pub const ALL: &[Self] = &[$(Self::$variant),+];

            const fn row(self) -> [&'static str; 3] {
                match self {
                    $(Self::$variant => [$word, $sentence, $hint],)+
                }
            }

            /// Name of the cause in JSON.
            pub const fn word(self) -> &'static str {
                self.row()[0]
            }

            /// The cause as the end of a sentence.
            pub const fn sentence(self) -> &'static str {
                self.row()[1]
            }

            /// Returns how to avoid the cause.
            pub const fn hint(self) -> &'static str {
                self.row()[2]
            }
        }
    };
}

reasons! {
    KeptSideEffect "kept_side_effect", "kept because it declares a side effect", "";
    KeptExport(resource: ResourceId) "kept_export", "kept because it writes `{resource}`, which is exported", "";
    KeptImport(resource: ResourceId) "kept_import", "kept because it writes `{resource}`, which is imported with `Exit::Keep`", "";
    KeptHistory(resource: ResourceId) "kept_history", "kept because it writes history `{resource}`", "";
    KeptReadBy(resource: ResourceId, pass: PassId) "kept_read_by", "kept because `{pass}` reads `{resource}`", "";
    KeptCullingOff "kept_culling_off", "kept because culling is disabled", "enable culling";
    CulledUnread(resource: ResourceId) "culled_unread", "culled because no pass reads `{resource}`",
        "read it, export it, or declare a side effect if it matters";
    CulledReaderCulled(resource: ResourceId, pass: PassId) "culled_reader_culled",
        "culled because only `{pass}` reads `{resource}`, and that pass is culled",
        "read it, export it, or declare a side effect if it matters";
    CulledOverwritten(resource: ResourceId, pass: PassId) "culled_overwritten",
        "culled because `{pass}` overwrites `{resource}` before any pass reads it",
        "use `Modify` in the later pass if the contents matter";
    CulledNoOutput "culled_no_output", "culled because it writes nothing and declares no side effect",
        "declare a side effect if it has one";
    ResolveDropped(resource: ResourceId) "resolve_dropped", "does not resolve into `{resource}` because no pass reads it",
        "read it, export it, or remove the resolve";
    ResolvePass(resource: ResourceId) "resolve_pass",
        "resolves into `{resource}` with a full-screen pass because the device cannot resolve it while storing",
        "use a resolve mode that the device supports, or a single sample";
    OrderMerge(pass: PassId) "order_merge", "moved after `{pass}` to share its step", "";
    OrderBytes(pass: PassId) "order_bytes",
        "runs after `{pass}` because the frame needs fewer steps or bytes in this order", "";
    MergedAttachments(pass: PassId) "merged_attachments", "merged with `{pass}`: same attachments", "";
    MergedSamePixel(pass: PassId) "merged_same_pixel", "merged with `{pass}`: its reads stay in the tile", "";
    MergedInline(pass: PassId) "merged_inline", "inlined into the shader of `{pass}`", "";
    Split(pass: PassId, refusal: Refusal) "split", "not merged with `{pass}`: {why}", "";
    NotInlined(pass: PassId, refusal: Refusal) "not_inlined", "not inlined into `{pass}`: {why}", "";
    LoadClear "load_clear", "cleared", "";
    ClearUnneeded "clear_unneeded", "cleared because neither the previous nor the new contents are needed",
        "read it, export it, or remove it from the pass";
    LoadOverwritten "load_overwritten", "don't care: every texel is written", "";
    LoadWritten(pass: PassId) "load_written", "loaded because contents written by `{pass}` are needed",
        "clear or overwrite it, or let the pass share the step of the writer";
    LoadEntry "load_entry", "loaded because its contents at the start of the frame are needed",
        "clear or overwrite it, or import it with undefined contents";
    StoreReadBy(pass: PassId) "store_read_by", "stored because `{pass}` reads it",
        "to keep it in the tile, read it at the same pixel if the reader needs only its own texel, or let the reader \
         share the step";
    StoreResolved(pass: PassId) "store_resolved", "stored because the full-screen resolve of `{pass}` reads it",
        "to keep the samples in the tile, use a mode that the device can resolve while storing";
    StoreExport "store_export", "stored because it is exported", "";
    StoreImport "store_import", "stored because it is imported with `Exit::Keep`", "";
    StoreHistory "store_history", "stored because later frames read it", "";
    DiscardUnread "discard_unread", "discarded because no later pass reads it", "";
    DiscardOverwritten "discard_overwritten", "discarded because it is overwritten before any pass reads it", "";
    DiscardResolved "discard_resolved", "discarded because it was resolved and no pass reads the samples", "";
    StoreUnchanged "store_unchanged", "left unchanged: it was only read", "";
    Memoryless(step: StepId) "memoryless", "needs no memory because it is used in one step only", "";
    NeedsMemory(need: MemoryNeed) "needs_memory", "needs memory because {why}", "";
    Inlined "inlined", "does not exist because its reader was inlined", "";
    SlotFirst "slot_first", "first resource in its slot", "";
    SlotAfter(resource: ResourceId) "slot_after", "reuses the slot of `{resource}`", "";
    Placed "placed", "placed in the heap", "";
    PlacedAfter(resource: ResourceId) "placed_after", "placed in the heap over `{resource}`", "";
    External "external", "owned outside of the graph", "";
    Persistent "persistent", "not shared because its contents outlive the frame", "";
    AliasingOff "aliasing_off", "not shared because aliasing is disabled", "enable aliasing";
    Forwarded(resource: ResourceId) "forwarded", "forwarded to `{resource}`", "";
    Unused "unused", "no kept pass accesses it", "remove it, or the condition that culls its passes";
}

causes! {
    /// Reason why two passes do not share a step.
    Refusal
    Disabled "disabled", "merging is disabled or not supported by the device",
        "enable merging on a device that supports it";
    NotRaster "not_raster", "one of them is not a raster pass", "";
    ComputeBetween "compute_between", "a compute or copy pass runs between them",
        "declare the compute or copy pass before or after both if its accesses allow that";
    Extent "extent", "their attachments differ in size", "give both the same size";
    Samples "samples", "their attachments differ in sample count", "give both the same sample count";
    Layers "layers", "their attachments differ in layer count", "give both the same layer count";
    /// They share no attachment, or the later pass uses another one in the same slot.
    ColorsDiffer "colors_differ", "their color attachments differ",
        "attach the same textures, or use same-pixel reads if the device keeps them in the tile";
    /// Shader outputs have fixed slots.
    SlotsDiffer "slots_differ", "the later one uses an attachment of the step in another slot, which the device cannot remap",
        "attach it in the same slot with `color_at`";
    DepthDiffers "depth_differs", "their depth attachments differ", "attach the same depth texture";
    TooManyAttachments "too_many_attachments", "together they exceed the color attachment limit",
        "pack outputs into fewer or smaller attachments";
    TileMemory "tile_memory", "together they exceed the tile memory",
        "pack outputs into fewer or smaller attachments";
    SampledElsewhere "sampled_elsewhere", "the later one samples a texture that the step writes",
        "declare a `same_pixel` read if it reads only its own texel";
    SamePixelUnsupported "same_pixel_unsupported", "the device cannot keep same-pixel reads in the tile",
        "declare the pass as point-wise if it is, so that it can be inlined";
    ClearBetween "clear_between", "the later one clears or overwrites a texture that the step wrote",
        "use another texture in the later pass";
    ResolveBetween "resolve_between", "the step resolves an attachment that the later one changes",
        "resolve in the last pass that writes the attachment";
    NeverMerge "never_merge", "one of them is declared `never_merge`", "remove `never_merge`";
    StorageHazard "storage_hazard", "one of them writes a storage resource that the other accesses",
        "use another resource, or an attachment";
    NeededAsTexture "needed_as_texture", "the intermediate texture has other uses",
        "make the point-wise pass its only reader";
    /// The output of blending is final only at the end of the pass.
    Blends "blends", "the producer blends", "blend after the point-wise pass, or keep the full-screen pass";
    NotPointwise "not_pointwise", "the consumer does not read exactly one texture at the same pixel and write exactly one color",
        "reduce it to one same-pixel read and one color attachment, and move the rest to another pass";
    DrawnElsewhere "drawn_elsewhere", "its input is not drawn in the preceding step",
        "declare it directly after the passes that draw its input";
    NoEpilogue "no_epilogue", "the producer's shader does not accept an epilogue",
        "declare `takes_epilogue` and assemble the shader with the epilogue";
    TargetShape "target_shape", "the two targets differ in more than their format",
        "give both the same size and one level, layer and sample, and use views in their own formats";
    BuildsOnContents "builds_on_contents", "one of them modifies previous contents",
        "clear or overwrite both targets";
    /// Reading from memory costs no more than the step saved by merging with the later pass.
    RoomForLater "room_for_later", "a later pass shares its step and would not fit into the earlier one",
        "run the later pass first, or use attachments that fit";
    /// A point-wise effect on the samples approximates the effect on their average, but not on other resolves.
    ResolveMode "resolve_mode", "its input is not averaged while storing",
        "resolve with the average, or keep the full-screen pass";
    /// An epilogue records no commands, so the side effect would be lost.
    SideEffect "side_effect", "the consumer has a side effect", "move the side effect to another pass";
    /// The epilogue is part of the producer's shader.
    TooManyBindings "too_many_bindings", "together they exceed the bindings of a shader stage",
        "combine textures as layers of one texture, or keep the full-screen pass";
}

causes! {
    /// Reason why an attachment of a single step needs memory.
    MemoryNeed
    /// Also used if memoryless attachments are disabled.
    Unsupported "unsupported", "the device does not support memoryless attachments",
        "use a device that supports them, or enable them";
    /// The target is written to memory at the end of its step.
    ResolveTarget "resolve_target", "it is a resolve target",
        "make its only reader point-wise, so that it can be inlined";
    /// For example, another layer of it is written as storage in the same step.
    OtherUse "other_use", "it is not only used as an attachment", "use it only as an attachment";
    /// Several layers are allowed if the device supports memoryless layers.
    SeveralParts "several_parts", "it has several levels or layers", "split it into textures with one level and layer";
    /// The view has the sRGB twin of the texture's format, or the texture that of a view.
    View "view", "it is viewed in another format, which the device does not support for memoryless attachments",
        "declare it in the format of the view";
    /// Only with a heap, whose memory later resources can use.
    NotSaved "not_saved", "memoryless attachments save no memory on the device, and others can share its memory",
        "use a device where they save memory";
    LoadedOrStored "loaded_or_stored", "its contents are loaded or stored",
        "clear or overwrite it, and do not read it after the step";
}

impl Reason {
    /// Name of the reason in JSON.
    pub const fn word(self) -> &'static str {
        self.row().word
    }

    /// Returns how to avoid this decision, independent of the graph; empty if there is no alternative.
    /// [`Plan::hint`](crate::Plan::hint) also takes the plan into account.
    pub const fn hint(self) -> &'static str {
        let Row { hint, names, .. } = self.row();
        match names {
            Names { refusal: Some(refusal), .. } => refusal.hint(),
            Names { need: Some(need), .. } => need.hint(),
            _ => hint,
        }
    }

    /// Returns the passes, resources, steps and causes of the reason.
    pub const fn names(self) -> Names {
        self.row().names
    }

    /// Returns decision and reason as a sentence with names.
    pub fn sentence(self, graph: &Graph) -> String {
        let Row { sentence, names: Names { pass, resource, refusal, need, .. }, .. } = self.row();
        let mut out = String::new();
        for piece in sentence.split_inclusive('}') {
            let (text, name) = piece.split_once('{').unwrap_or((piece, ""));
            out += text;
            out += match name {
                "pass}" => escape_controls(pass.map_or("", |p| graph.pass_name(p))),
                "resource}" => escape_controls(resource.map_or("", |r| graph.resource_name(r))),
                "why}" => refusal.map(Refusal::sentence).or(need.map(MemoryNeed::sentence)).unwrap_or_default().into(),
                _ => "".into(),
            }
            .as_ref();
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn words_are_told_apart_and_sentences_name_what_the_reason_holds() {
        let (pass, resource, step) = (Some(PassId::at(0)), Some(ResourceId::at(0)), Some(StepId::at(0)));
        let (refusal, need) = (Some(Refusal::Extent), Some(MemoryNeed::ResolveTarget));
        let all = Reason::all(Names { pass, resource, step, refusal, need });
        assert_eq!(all.iter().map(|r| r.word()).collect::<HashSet<_>>().len(), all.len());
        for reason in all {
            let Row { sentence, names, .. } = reason.row();
            assert_eq!(sentence.contains("{pass}"), names.pass.is_some(), "{reason:?}");
            assert_eq!(sentence.contains("{resource}"), names.resource.is_some(), "{reason:?}");
            assert_eq!(sentence.contains("{why}"), names.refusal.is_some() || names.need.is_some(), "{reason:?}");
            let word = format!("{reason:?}").chars().take_while(|c| *c != '(').fold(String::new(), |mut word, c| {
                word.extend((c.is_uppercase() && !word.is_empty()).then_some('_'));
                word + &c.to_lowercase().to_string()
            });
            assert_eq!(reason.word(), word, "the word is the variant's name in snake case");
        }
        assert!(Reason::all(Names::default()).iter().all(|r| r.names().pass.is_none()));
    }
}
