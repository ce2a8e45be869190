//! Conversion of load and store operations to wgpu.
//!
//! Contains an unsafe call: wgpu's token for `LoadOp::DontCare`.

use crate::execute::clear::Values;
use framegraph::{Aspect, Attachment, ClearValue, Format, LoadOp, Role, StoreOp};
use wgpu::{Color, Operations};

/// Returns the load operation for undefined contents.
fn dont_care<V>() -> wgpu::LoadOp<V> {
    #[allow(unsafe_code, reason = "the token of LoadOp::DontCare has no safe constructor")]
    // SAFETY: wgpu requires that every texel is written before it is read or stored. The plan uses `DontCare` only for
    // attachments whose first pass declares `Intent::Overwrite`, which promises this, and which no pass reads before.
    // Blended attachments start from a clear. A pass that breaks the promise leaves texels undefined, but they only
    // contain memory of this device.
    let token = unsafe { wgpu::LoadOpDontCare::enabled() };
    wgpu::LoadOp::DontCare(token)
}

fn load<V>(op: LoadOp, clear: V) -> wgpu::LoadOp<V> {
    match op {
        LoadOp::Load => wgpu::LoadOp::Load,
        LoadOp::Clear => wgpu::LoadOp::Clear(clear),
        LoadOp::DontCare => dont_care(),
    }
}

/// Converts a store operation. wgpu has no `StoreOp::None` for writable attachments; storing the unchanged contents is
/// equivalent.
const fn store(op: StoreOp) -> wgpu::StoreOp {
    match op {
        StoreOp::Store | StoreOp::None => wgpu::StoreOp::Store,
        StoreOp::Discard => wgpu::StoreOp::Discard,
    }
}

/// Returns the operations of a color attachment.
pub(crate) fn color_ops(attachment: &Attachment, clear: ClearValue) -> Operations<Color> {
    Operations { load: load(attachment.load, Values::from(clear).color), store: store(attachment.store) }
}

/// Returns the operations of depth and stencil; `None` for a plane that is read-only or does not exist.
///
/// If one plane is stored, the other is stored too, since wgpu clears a plane that is discarded alone.
pub(crate) fn depth_ops(
    attachment: &Attachment,
    format: Format,
    clear: ClearValue,
) -> (Option<Operations<f32>>, Option<Operations<u32>>) {
    let values = Values::from(clear);
    let both_discarded = [Aspect::Depth, Aspect::Stencil]
        .into_iter()
        .filter_map(|aspect| attachment.ops(format, aspect))
        .all(|(_, store)| store == StoreOp::Discard);
    let read_only = attachment.role == Role::DepthReadOnly;
    let plane = |aspect| {
        let (load_op, store_op) = attachment.ops(format, aspect)?;
        let kept = match store_op {
            StoreOp::None => return None,
            StoreOp::Discard if read_only && !both_discarded => return None,
            StoreOp::Discard if !both_discarded => wgpu::StoreOp::Store,
            other => store(other),
        };
        Some((load_op, kept))
    };
    let depth = plane(Aspect::Depth).map(|(l, store)| Operations { load: load(l, values.depth), store });
    let stencil = plane(Aspect::Stencil).map(|(l, store)| Operations { load: load(l, values.stencil), store });
    (depth, stencil)
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::ResourceId;

    fn attachment(role: Role, depth: (LoadOp, StoreOp), stencil: (LoadOp, StoreOp)) -> Attachment {
        Attachment {
            resource: ResourceId::NONE,
            mip: 0,
            layer: 0,
            layers: 1,
            view: None,
            role,
            load: depth.0,
            store: depth.1,
            stencil_load: stencil.0,
            stencil_store: stencil.1,
            clear: 0,
        }
    }

    const BOTH: Format = Format::Depth32FloatStencil8;
    const CLEAR: ClearValue = ClearValue::DepthStencil(0.25, 7);

    #[test]
    fn color_operations_follow_the_plan() {
        let ops = |load, store| {
            let of_color = attachment(Role::Color(0), (load, store), (load, store));
            color_ops(&of_color, ClearValue::Color([0.0, 0.5, 1.0, 1.0]))
        };
        let cleared = Color { r: 0.0, g: 0.5, b: 1.0, a: 1.0 };
        assert_eq!(ops(LoadOp::Clear, StoreOp::Store).load, wgpu::LoadOp::Clear(cleared));
        assert_eq!(ops(LoadOp::Load, StoreOp::Discard).store, wgpu::StoreOp::Discard);
        assert!(matches!(ops(LoadOp::DontCare, StoreOp::Store).load, wgpu::LoadOp::DontCare(_)));
    }

    #[test]
    fn planes_of_a_cleared_and_discarded_depth_buffer() {
        let plane = (LoadOp::Clear, StoreOp::Discard);
        let (depth, stencil) = depth_ops(&attachment(Role::Depth, plane, plane), BOTH, CLEAR);
        let store = wgpu::StoreOp::Discard;
        assert_eq!(depth, Some(Operations { load: wgpu::LoadOp::Clear(0.25), store }));
        assert_eq!(stencil, Some(Operations { load: wgpu::LoadOp::Clear(7), store }));
        let alone = depth_ops(&attachment(Role::Depth, plane, plane), Format::Depth32Float, CLEAR);
        assert_eq!(alone.1, None, "there is no stencil plane");
    }

    #[test]
    fn a_plane_is_stored_if_the_other_is() {
        let (stored, dropped) = ((LoadOp::Clear, StoreOp::Store), (LoadOp::Clear, StoreOp::Discard));
        let (depth, stencil) = depth_ops(&attachment(Role::Depth, stored, dropped), BOTH, CLEAR);
        let stores = [depth.map(|o| o.store), stencil.map(|o| o.store)];
        assert_eq!(stores, [Some(wgpu::StoreOp::Store); 2]);
    }

    #[test]
    fn read_only_planes_have_no_operations() {
        let kept = (LoadOp::Load, StoreOp::None);
        assert_eq!(depth_ops(&attachment(Role::DepthReadOnly, kept, kept), BOTH, CLEAR), (None, None));
        let last = (LoadOp::Load, StoreOp::Discard);
        let dropped = depth_ops(&attachment(Role::DepthReadOnly, last, last), BOTH, CLEAR);
        assert_eq!(dropped.0.map(|o| o.store), Some(wgpu::StoreOp::Discard));
        let one = depth_ops(&attachment(Role::DepthReadOnly, last, kept), BOTH, CLEAR);
        assert_eq!(one, (None, None), "a plane is stored if the other one is");
    }
}
