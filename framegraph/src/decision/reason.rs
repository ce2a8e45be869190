//! The list of reasons: each stands here once, with its word in JSON, its sentence and its hint. The enumeration, what it
//! names, and the list that mutation walks follow from the row.
//!
//! A macro, since no function can make the variants of an enumeration.

use crate::graph::Graph;
use crate::id::{PassId, ResourceId, StepId};
use crate::plain::plain;

/// What a reason names; none of what it does not.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Names {
    pub(crate) pass: Option<PassId>,
    pub(crate) resource: Option<ResourceId>,
    #[cfg_attr(not(feature = "testing"), expect(dead_code, reason = "the oracle alone reads it"))]
    pub(crate) step: Option<StepId>,
    pub(crate) refusal: Option<Refusal>,
    pub(crate) need: Option<MemoryNeed>,
}

/// One row of the list.
struct Row {
    word: &'static str,
    /// With `{pass}`, `{resource}` and `{why}` in the place of what is named.
    sentence: &'static str,
    hint: &'static str,
    names: Names,
}

/// Makes [`Reason`] of rows `Variant(name: type, …) "word", "sentence", "hint";`. The hint is empty where the reader can
/// want nothing else, and where the refusal or need that is named has its own.
macro_rules! reasons {
    ($($variant:ident $(($($name:ident: $type:ty),+))? $word:literal, $sentence:literal, $hint:literal;)+) => {
        /// Everything that a compile can decide, each with its cause. What a variant holds is what its sentence names.
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

            /// Every reason that `names` has what it takes for.
            #[cfg(feature = "testing")]
            pub(crate) fn all(names: Names) -> Vec<Self> {
                let makers: [fn(&Names) -> Option<Self>; _] = [$(|_given| Some(Self::$variant $(($(_given.$name?),+))?)),+];
                makers.iter().filter_map(|make| make(&names)).collect()
            }
        }
    };
}

/// Makes an enumeration of causes, which reasons hold, of rows `Variant "word", "sentence", "hint";`.
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

            /// Its word in JSON.
            pub const fn word(self) -> &'static str {
                self.row()[0]
            }

            /// Why, as the end of a sentence.
            pub const fn sentence(self) -> &'static str {
                self.row()[1]
            }

            /// What to change to have it otherwise.
            pub const fn hint(self) -> &'static str {
                self.row()[2]
            }
        }
    };
}

reasons! {
    KeptSideEffect "kept_side_effect", "kept, it declares a side effect", "";
    KeptExport(resource: ResourceId) "kept_export", "kept, it writes `{resource}`, which is exported", "";
    KeptImport(resource: ResourceId) "kept_import", "kept, it writes `{resource}`, which is imported and must survive", "";
    KeptHistory(resource: ResourceId) "kept_history", "kept, it writes `{resource}`, which later frames read", "";
    KeptReadBy(resource: ResourceId, pass: PassId) "kept_read_by", "kept, `{pass}` reads `{resource}`", "";
    KeptCullingOff "kept_culling_off", "kept, culling is switched off", "switch culling on";
    CulledUnread(resource: ResourceId) "culled_unread", "culled, no pass reads `{resource}`",
        "read it, export it, or declare a side effect, if it matters";
    CulledReaderCulled(resource: ResourceId, pass: PassId) "culled_reader_culled",
        "culled, only `{pass}` reads `{resource}`, and it is culled",
        "read it, export it, or declare a side effect, if it matters";
    CulledOverwritten(resource: ResourceId, pass: PassId) "culled_overwritten",
        "culled, `{pass}` writes over `{resource}` before any pass reads it",
        "let the later pass modify it, if the contents matter";
    CulledNoOutput "culled_no_output", "culled, it writes nothing and declares no side effect",
        "declare a side effect, if it does anything";
    ResolveDropped(resource: ResourceId) "resolve_dropped", "does not resolve into `{resource}`, no pass reads it",
        "read it, export it, or leave the resolve out";
    ResolvePass(resource: ResourceId) "resolve_pass",
        "resolves into `{resource}` by a full-screen pass, the device does not do it while it stores",
        "use another mode, if the device has one, or have one sample";
    OrderMerge(pass: PassId) "order_merge", "moved behind `{pass}`, to share its step", "";
    OrderBytes(pass: PassId) "order_bytes",
        "runs behind `{pass}`, the frame takes fewer steps or bytes in this order", "";
    MergedAttachments(pass: PassId) "merged_attachments", "merged with `{pass}`, same attachments", "";
    MergedSamePixel(pass: PassId) "merged_same_pixel", "merged with `{pass}`, its reads stay in the tile", "";
    MergedInline(pass: PassId) "merged_inline", "inlined into the shader of `{pass}`", "";
    Split(pass: PassId, refusal: Refusal) "split", "not merged with `{pass}`: {why}", "";
    NotInlined(pass: PassId, refusal: Refusal) "not_inlined", "not inlined into `{pass}`: {why}", "";
    LoadClear "load_clear", "cleared", "";
    ClearUnneeded "clear_unneeded", "cleared, neither what it held nor what is added is needed",
        "read it, export it, or leave it out of the pass";
    LoadOverwritten "load_overwritten", "don't care, every texel is written", "";
    LoadWritten(pass: PassId) "load_written", "loaded, `{pass}` wrote contents that are needed",
        "clear or overwrite it, or let the pass share the step of its writer";
    LoadEntry "load_entry", "loaded, the contents on entry are needed",
        "clear or overwrite it, or import it without contents";
    StoreReadBy(pass: PassId) "store_read_by", "stored, `{pass}` reads it",
        "read it at the same pixel if the reader needs its own texel alone, or let the reader share the step, to keep it \
         in the tile";
    StoreResolved(pass: PassId) "store_resolved", "stored, the full-screen pass that resolves for `{pass}` reads it",
        "resolve it by a mode that the device has in its store, to keep the samples in the tile";
    StoreExport "store_export", "stored, it is exported", "";
    StoreImport "store_import", "stored, it is imported and must survive", "";
    StoreHistory "store_history", "stored, later frames read it", "";
    DiscardUnread "discard_unread", "discarded, no pass reads it any more", "";
    DiscardOverwritten "discard_overwritten", "discarded, it is written over before any pass reads it", "";
    DiscardResolved "discard_resolved", "discarded, it was resolved and no pass reads the samples", "";
    StoreUnchanged "store_unchanged", "left in memory, it was only read", "";
    Memoryless(step: StepId) "memoryless", "takes no memory, it lives in one step", "";
    NeedsMemory(need: MemoryNeed) "needs_memory", "takes memory, {why}", "";
    Inlined "inlined", "never exists, its reader was inlined", "";
    SlotFirst "slot_first", "first tenant of its slot", "";
    SlotAfter(resource: ResourceId) "slot_after", "takes over the slot of `{resource}`", "";
    Placed "placed", "placed in the heap", "";
    PlacedAfter(resource: ResourceId) "placed_after", "placed over the memory of `{resource}`", "";
    External "external", "owned outside of the graph", "";
    Persistent "persistent", "not shared, its contents outlive the frame", "";
    AliasingOff "aliasing_off", "not shared, sharing is switched off", "switch sharing on";
    Forwarded(resource: ResourceId) "forwarded", "is `{resource}`, to which it was forwarded", "";
    Unused "unused", "no kept pass touches it", "remove it, or the condition that culls its passes";
}

causes! {
    /// Why two passes do not share a step.
    Refusal
    Disabled "disabled", "merging is switched off, or the device has none",
        "switch merging on, on a device that merges";
    NotRaster "not_raster", "one of them is no raster pass", "";
    ComputeBetween "compute_between", "a compute or copy pass runs between them",
        "declare the compute or copy pass before or after both, where what it touches allows that";
    Extent "extent", "their attachments differ in size", "give both the same shape";
    Samples "samples", "their attachments differ in samples", "give both the same shape";
    Layers "layers", "their attachments differ in layers", "give both the same shape";
    /// They share none, or the later pass draws another one in the slot of one of them.
    ColorsDiffer "colors_differ", "their color attachments differ",
        "attach the same textures, or read at the same pixel where the device keeps that in the tile";
    /// A shader's outputs have their slots compiled in.
    SlotsDiffer "slots_differ", "the later one draws an attachment of the step in another slot, which the device cannot map",
        "attach it in the same slot, with `color_at`";
    DepthDiffers "depth_differs", "their depth attachments differ", "attach the same depth";
    TooManyAttachments "too_many_attachments", "together they have too many color attachments",
        "pack outputs into fewer or smaller attachments";
    TileMemory "tile_memory", "together they need more tile memory than there is",
        "pack outputs into fewer or smaller attachments";
    SampledElsewhere "sampled_elsewhere", "the later one samples what the step writes",
        "declare the read `same_pixel` if it reads only its own texel";
    SamePixelUnsupported "same_pixel_unsupported", "the device cannot keep a same-pixel read in the tile",
        "declare the pass point-wise if it is, so that it can be inlined";
    ClearBetween "clear_between", "the later one clears or overwrites what the step wrote",
        "use another texture for the later pass";
    ResolveBetween "resolve_between", "the step resolves an attachment that the later one changes",
        "resolve in the last pass that writes the attachment";
    NeverMerge "never_merge", "one of them asks to stay alone", "remove `never_merge`";
    StorageHazard "storage_hazard", "one of them writes storage that the other touches",
        "use another buffer, or an attachment";
    NeededAsTexture "needed_as_texture", "the intermediate is needed as a texture",
        "let the point-wise pass be the only reader";
    /// Its output is final only at the end of the pass.
    Blends "blends", "the producer blends", "blend after the point-wise pass, or accept the full-screen pass";
    NotPointwise "not_pointwise", "the consumer does more than read one texture at the same pixel and write one color",
        "give it one same-pixel read and one color attachment, and put the rest into another pass";
    DrawnElsewhere "drawn_elsewhere", "its input is not drawn in the step before it",
        "declare it right behind the passes that draw its input";
    NoEpilogue "no_epilogue", "the producer's shader takes no epilogue",
        "declare `takes_epilogue` and assemble the shader from its parts";
    TargetShape "target_shape", "the two targets differ in more than the format",
        "give both one level, layer and sample and the same size, and see neither through another format";
    BuildsOnContents "builds_on_contents", "one of them adds to what was there before",
        "clear or overwrite both targets";
    /// In memory the same-pixel read costs no more than what a step with the later pass saves.
    RoomForLater "room_for_later", "a later pass shares its step, and would not fit into that of the earlier ones",
        "run the later pass first, or give it attachments that fit";
    /// Graded samples have the average of the graded picture nearly; no other sample of it.
    ResolveMode "resolve_mode", "its input is resolved otherwise than by the average, or not in the store",
        "resolve by the average, or accept the full-screen pass";
    /// An epilogue records nothing, so the side effect would be lost.
    SideEffect "side_effect", "the consumer has a side effect", "move the side effect to a pass of its own";
}

causes! {
    /// Why an attachment of one step takes memory all the same.
    MemoryNeed
    /// Or memoryless attachments are switched off.
    Unsupported "unsupported", "the device has no memoryless attachments",
        "ask a device that has them, or switch them on";
    /// It is written to memory at the end of its step.
    ResolveTarget "resolve_target", "it is a resolve target",
        "let its only reader be point-wise, so that it can be inlined";
    /// In the same step: another layer of it is written as storage, say.
    OtherUse "other_use", "it is used as something other than an attachment", "use it as an attachment only";
    /// Several layers are no obstacle where the device has memoryless layers.
    SeveralParts "several_parts", "it has several levels or layers", "split it into textures of one level and layer";
    LoadedOrStored "loaded_or_stored", "its contents are loaded or stored",
        "clear or overwrite it, and let no pass read it after the step";
}

impl Reason {
    /// Its word in JSON.
    pub const fn word(self) -> &'static str {
        self.row().word
    }

    /// What to change to have it otherwise, whatever the graph; empty where there is nothing to want.
    /// [`Plan::hint`](crate::Plan::hint) knows the plan.
    pub const fn hint(self) -> &'static str {
        let Row { hint, names, .. } = self.row();
        match names {
            Names { refusal: Some(refusal), .. } => refusal.hint(),
            Names { need: Some(need), .. } => need.hint(),
            _ => hint,
        }
    }

    /// The passes, resources, steps and causes that it holds.
    pub(crate) const fn names(self) -> Names {
        self.row().names
    }

    /// What was decided and why, with names.
    pub fn sentence(self, graph: &Graph) -> String {
        let Row { sentence, names: Names { pass, resource, refusal, need, .. }, .. } = self.row();
        let mut out = String::new();
        for piece in sentence.split_inclusive('}') {
            let (text, name) = piece.split_once('{').unwrap_or((piece, ""));
            out += text;
            out += match name {
                "pass}" => plain(pass.map_or("", |p| graph.pass_name(p))),
                "resource}" => plain(resource.map_or("", |r| graph.resource_name(r))),
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
            assert_eq!(reason.word(), word, "a tool that read the name in snake case reads it still");
        }
        assert!(Reason::all(Names::default()).iter().all(|r| r.names().pass.is_none()));
    }
}
