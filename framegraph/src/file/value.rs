//! Errors of values: out of range, or in conflict with another value.

use super::slot::SlotType;
use crate::error_macros::error_enum;

error_enum! {
    /// Reason why a value is invalid. `what` is the counted item, `max` the maximum.
    ValueReason {
        FeatureName(name: String) "`{name}` is not a valid feature name",
            "use letters, digits, `_`, `-` and `.`; `else` is reserved";
        Condition(text: String) "`{text}` is not a condition",
            "combine features with `!`, `&&` and `||`";
        EmptyFrame "the frame has 0 texels", "set width and height, for example `frame: (1920, 1080)`";
        Alignment(bytes: u64) "alignment of {bytes} bytes", "use a power of two from 1 to 2^32";
        MaxSamples(samples: u8) "maximum of {samples} samples", "use 1, 2, 4, 8 or 16";
        MaxColors(colors: u8) "maximum of {colors} color attachments", "use a number from 1 to 8";
        MaxSide(side: u32) "maximum of {side} texels or layers", "use a number from 1 to 2^20";
        PreviousAbove "the history is listed later", "list it before its previous images";
        AliasAbove "an import is listed later", "list `MayAlias` after both imports";
        NotAHistory { id: String } "`{id}` is not a history", "declare it with `kind: History(frames: 1)`";
        Subresources { max: u64 } "more than {max} subresources (level, layer and plane) in total",
            "use fewer levels or layers";
        EmptyHistory "the history has 0 frames", "use 1 or more";
        /// A resource created by a plugin is used before that plugin runs.
        MadeLater "the plugin that creates it is listed later", "list the plugin first, or select the version with `name@plugin`";
        /// A plugin reads a resource that it creates.
        MadeHere "the plugin reads what it creates itself", "let an earlier entry create it, or read it in a later entry";
        MadeEmpty "its initial contents are undefined, because a plugin creates it", "remove `@entry`";
        ForwardsTextures "only a texture can be forwarded, once, to another texture", "use textures that passes write";
        Path(path: String) "`{path}` is outside of the folder of this file",
            "use a file in this folder or below, with `/` as separator";
        /// The message of the system.
        Unreadable(message: String) "the file cannot be included: {message}", "use a readable file";
        Number { text: String, max: u32 } "`{text}` is not a number from 0 to {max}",
            "use a number, or in a loop or template an expression in braces: `\"{{i-1}}\"`";
        Parameter(name: String) "the template requires the parameter `{name}`", "add `\"{name}\": \"…\"` to its `with`";
        TemplateInTemplate "a template uses another template", "insert the entries of the other template here";
        Entries { max: u64 } "loops, templates or includes create more than {max} entries",
            "use fewer repetitions, or split the frame";
        SlotType { slot: String, ty: SlotType } "slot `{slot}` requires a {wanted}", "bind a resource of that type",
            wanted = match ty {
                SlotType::Texture => "texture to read",
                SlotType::Buffer => "buffer to read",
                SlotType::Target => "texture to write",
                SlotType::TargetBuffer => "buffer to write",
            };
        WritesEarlierFrame "history images of earlier frames cannot be written", "write the history by its plain name";
        ExportsEarlierFrame "history images of earlier frames cannot be exported",
            "export the history itself";
        Id(id: String) "`{id}` is not a valid id", "add an `id` that is not empty and contains no `@`";
        BufferHistory "a buffer cannot be a history", "import two buffers and swap them each frame";
        BufferRange "a buffer has no levels, layers, aspects or views", "use `bytes: (offset, size)`, or the whole buffer";
        TextureBytes "a texture cannot be accessed by bytes", "use levels and layers, or the whole texture";
        All { what: &'static str } "{what} cannot be \"all\"", "use a number";
        /// No condition of a choice holds.
        NoChoice { what: &'static str } "no condition for {what} holds", "add `\"else\": 1` as the last one";
        Count { what: &'static str, value: u64, max: u64, /** `"all"` is allowed too. */ all: bool } "{value} {what}",
            "use a number from 1 to {max}{or_all}", or_all = if *all { ", or \"all\"" } else { "" };
        /// A zero in a size, as described.
        Zero(what: &'static str) "{what}", "use 1 or more";
    }
}
