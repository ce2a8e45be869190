//! Values that stand in a file and cannot be: outside of their range, or not together with another.

use super::slot::Takes;
use crate::faults::faults;

faults! {
    /// What is wrong with a value. `what` is what is counted, `max` the most there may be.
    ValueFault {
        FeatureName(name: String) "`{name}` cannot be the name of a feature",
            "use letters, digits, `_`, `-` and `.`, and another word than `else`";
        Condition(text: String) "`{text}` is no condition",
            "write features joined by `&&` and `||`, with `!` in front of those that must be off";
        EmptyFrame "a frame of 0 texels", "write width and height, `frame: (1920, 1080)`";
        Alignment(bytes: u64) "an alignment of {bytes} bytes", "write a power of two from 1 to 2^32";
        MaxSamples(samples: u8) "{samples} samples at most", "write 1, 2, 4, 8 or 16";
        MaxColors(colors: u8) "{colors} color attachments at most", "write a number from 1 to 8";
        MaxSide(side: u32) "{side} texels or layers at most", "write a number from 1 to 2^20";
        PreviousAbove "the history stands further down", "list it before its previous images";
        NotAHistory { id: String } "`{id}` is no history", "declare it with `kind: History(frames: 1)`";
        Subresources { max: u64 } "more than {max} levels, layers and planes together",
            "give the textures fewer levels or layers";
        EmptyHistory "a history of 0 frames", "write 1 or more";
        /// A name that a plugin makes is used before that plugin ran.
        MadeLater "the plugin that makes it is listed later", "list it first, or name the version: `name@plugin`";
        MadeEmpty "the plugin that makes it writes it first: it holds nothing on entry", "leave `@entry` out";
        ForwardsTextures "only a texture can be forwarded, once, to a texture", "name textures that passes write";
        Path(path: String) "`{path}` leads out of the folder of this file",
            "name a file in this folder or below, with `/` between the parts";
        /// What the system says of it.
        Unreadable(message: String) "the file cannot be included: {message}", "name a file that can be read";
        Number { text: String, max: u32 } "`{text}` is no number from 0 to {max}",
            "write one, in a loop or template one in braces: `\"{{i-1}}\"`";
        Parameter(name: String) "the template needs the parameter `{name}`", "add `\"{name}\": \"…\"` to its `with`";
        TemplateInTemplate "a template uses a template", "write its entries out here";
        Entries { max: u64 } "loops, templates or includes make more than {max} entries",
            "repeat less, or split the frame";
        SlotType { slot: String, takes: Takes } "slot `{slot}` takes a {wanted}", "bind a resource of that type",
            wanted = match takes {
                Takes::Texture => "texture to read",
                Takes::Buffer => "buffer to read",
                Takes::Target => "texture to write",
                Takes::TargetBuffer => "buffer to write",
            };
        WritesEarlierFrame "an earlier frame's image cannot be written", "write the history by its plain name";
        ExportsEarlierFrame "an earlier frame's image cannot be exported",
            "the history keeps it; export the history itself";
        Id(id: String) "`{id}` cannot be named by passes", "give it an `id` that is not empty and has no `@`";
        BufferHistory "a buffer cannot be a history", "import two buffers and swap them";
        BufferRange "a buffer has no levels, layers, aspects or views", "name `bytes: (offset, size)`, or all of it";
        TextureBytes "a texture is not accessed by bytes", "name levels and layers in their place, or all of it";
        All { what: &'static str } "{what} cannot be \"all\"", "write a number";
        /// A choice by features of which no condition holds.
        NoChoice { what: &'static str } "no choice of {what} applies", "add `\"else\": 1` as the last one";
        Count { what: &'static str, value: u64, max: u64, /** Whether `"all"` would do. */ all: bool } "{value} {what}",
            "write a number from 1 to {max}{or_all}", or_all = if *all { ", or \"all\"" } else { "" };
        /// A zero in a size; the words say where.
        Zero(what: &'static str) "{what}", "write 1 or more";
    }
}
