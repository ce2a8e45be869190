//! What can be wrong with forwarding a texture.

use crate::access::AccessKind;
use crate::faults::faults;
use crate::format::Format;

faults! {
    /// Why a texture cannot be forwarded.
    #[derive(Copy)]
    ForwardFault {
        /// It is imported, a history, exported, or the target itself.
        NotTransient "only a transient texture that is not exported can be forwarded, to another one",
            "let the passes write the target itself, or copy";
        Unwritten "no pass wrote what is forwarded", "forward it behind the pass that writes it";
        Parts "a texture of one level and layer can be forwarded to one level of one layer, any other to a whole texture of \
               as many", "name the part: `target.mip(0).layer(0)`";
        /// Passes that drew one slice would leave the others as they were.
        Slices "the target has several slices in the place of one",
            "give both textures of three dimensions the same depth, or name a level of one slice";
        TargetLater "the target was declared or written after the first pass that touches what is forwarded",
            "declare the target before that pass";
        Touched "passes touched the target while others touched what is forwarded",
            "let them use the target before or behind all of these, or copy";
        Format { /** That of the target. */ format: Format, access: AccessKind }
            "a pass uses what is forwarded as `{access}`, which {format:?} of the target does not allow",
            "give the target a format that allows it";
    }
}
