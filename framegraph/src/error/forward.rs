//! Errors of forwarding a texture.

use crate::access::AccessKind;
use crate::error_macros::error_enum;
use crate::format::Format;

error_enum! {
    /// Reason why a texture cannot be forwarded.
    #[derive(Copy)]
    ForwardReason {
        /// The texture is imported, a history, exported, or the target itself.
        NotTransient "only a transient texture that is not exported can be forwarded to another texture",
            "write the target directly, or copy";
        Unwritten "no pass has written the forwarded texture", "forward it after the pass that writes it";
        Parts "a texture of one level and layer can be forwarded to one level of one layer, all others only to a whole \
               texture of the same shape", "select the part: `target.mip(0).layer(0)`";
        /// Passes that draw one slice would leave the others undefined.
        Slices "the target has several slices, the forwarded texture has one",
            "give both textures the same depth, or select a level with one slice";
        TargetLater "the target was declared or written after the first access of the forwarded texture",
            "declare the target before the pass with that access";
        Interleaved "accesses of the target lie between accesses of the forwarded texture",
            "access the target before or after all of them, or copy";
        Format { /** That of the target. */ format: Format, access: AccessKind }
            "a pass uses the forwarded texture as `{access}`, which the target's {format:?} does not support",
            "choose a target format that supports it";
    }
}
