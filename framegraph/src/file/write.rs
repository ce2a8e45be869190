//! Writes a graph as a file that declares it again, for example to save, edit and compare a frame.

use super::form::Flag;
use super::selected::ENTRY;
use super::version::GRAPH_VERSION;
use crate::access::{Access, AccessKind, ByteRange, ClearValue, Mode, Range};
use crate::format::Aspect;
use crate::graph::{ExportKind, Graph, PassKind};
use crate::id::{PassId, ResourceId};
use crate::resolve::ResolveMode;
use crate::resource::{BufferSize, Desc, Dimension, Entry, Extent, Kind, TextureDesc};
use std::collections::HashSet;

/// Returns `graph` in file form, with a name and a frame size in texels.
///
/// Loading the text declares an equal graph: the same passes, resources, accesses and exports in the same order. Notes
/// and deferred errors are not included.
pub fn to_ron(graph: &Graph, name: &str, frame: [u32; 2]) -> String {
    let ids = ids(graph);
    let mut out = format!("(\n    version: {GRAPH_VERSION},\n");
    if !name.is_empty() {
        out += &format!("    name: {},\n", quoted(name));
    }
    if frame[0] != 0 && frame[1] != 0 {
        out += &format!("    frame: ({}, {}),\n", frame[0], frame[1]);
    }
    out += "    resources: [\n";
    for resource in graph.resource_ids() {
        out += &resource_line(graph, resource, &ids);
    }
    for (of, with) in graph.aliases.iter().map(|(a, b)| (&ids.resources[a.index()], &ids.resources[b.index()])) {
        out += &format!("        MayAlias(of: {}, with: {}),\n", quoted(of), quoted(with));
    }
    out += "    ],\n    passes: [\n";
    for pass in graph.pass_ids() {
        write_pass(graph, pass, &ids, &mut out);
    }
    out += "    ],\n    exports: [\n";
    for export in graph.exports() {
        let kind = match export.kind {
            ExportKind::Keep => "Keep",
            ExportKind::Readback => "Readback",
        };
        let of = quoted(&ids.resources[export.resource.index()]);
        out += &format!("        {kind}(of: {of}),\n");
    }
    out += "    ],\n)\n";
    out
}

/// Ids of resources and passes in references: their names if those are unique.
struct Ids {
    resources: Vec<String>,
    passes: Vec<String>,
}

fn ids(graph: &Graph) -> Ids {
    let names = graph.resource_ids().map(|r| match graph.resources()[r.index()].kind {
        // Referred to by its history and age.
        Kind::HistoryPrevious { .. } => "",
        _ => graph.resource_name(r),
    });
    let mut resources = unique(names);
    for (index, row) in graph.resources().iter().enumerate() {
        if let Kind::HistoryPrevious { current, age } = row.kind {
            resources[index] = format!("{}@-{age}", resources[current.index()]);
        }
    }
    let passes = unique(graph.pass_ids().map(|p| graph.pass_name(p)));
    Ids { resources, passes }
}

/// Makes names unique: appends a number to names that are duplicate, empty or contain `@`.
fn unique<'n>(names: impl Iterator<Item = &'n str>) -> Vec<String> {
    let names: Vec<_> = names.collect();
    let mut taken: HashSet<String> = HashSet::new();
    let all: HashSet<&str> = names.iter().copied().collect();
    let mut next = 2u64;
    let mut choose = |name: &str| {
        let plain = name.replace('@', "_");
        if plain == name && !name.is_empty() && name != ENTRY && taken.insert(plain.clone()) {
            return plain;
        }
        loop {
            let id = format!("{plain}#{next}");
            next += 1;
            if !all.contains(id.as_str()) && taken.insert(id.clone()) {
                return id;
            }
        }
    };
    names.iter().map(|name| choose(name)).collect()
}

fn resource_line(graph: &Graph, resource: ResourceId, ids: &Ids) -> String {
    let row = &graph.resources()[resource.index()];
    if let Kind::HistoryPrevious { current, age } = row.kind {
        let of = quoted(&ids.resources[current.index()]);
        return format!("        Previous(of: {of}, age: {age}),\n");
    }
    let name = graph.resource_name(resource);
    let mut fields = vec![format!("name: {}", quoted(name))];
    let id = &ids.resources[resource.index()];
    if id != name {
        fields.push(format!("id: {}", quoted(id)));
    }
    let kind = match &row.desc {
        Desc::Texture(t) => {
            texture_fields(t, &mut fields);
            "Texture"
        }
        Desc::Buffer(b) => {
            match b.size {
                BufferSize::Bytes(bytes) => fields.push(format!("bytes: {bytes}")),
                BufferSize::PerTexel { bytes, extent } => {
                    fields.push(format!("bytes: {bytes}, per_texel_of: {}", size(extent)));
                }
            }
            "Buffer"
        }
    };
    match row.kind {
        Kind::Imported { entry, exit } => {
            let entry = match entry {
                Entry::Left { state, stages } => {
                    format!("Left(state: {state:?}, stages: {:?})", stages.names().collect::<Vec<_>>())
                }
                other => format!("{other:?}"),
            };
            fields.push(format!("kind: Import(entry: {entry}, exit: {exit:?})"));
        }
        Kind::HistoryCurrent { frames } => fields.push(format!("kind: History(frames: {frames})")),
        Kind::Transient | Kind::HistoryPrevious { .. } => {}
    }
    format!("        {kind}({}),\n", fields.join(", "))
}

fn texture_fields(t: &TextureDesc, fields: &mut Vec<String>) {
    fields.push(format!("format: {:?}", t.format));
    if t.extent != Extent::FRAME {
        fields.push(format!("size: {}", size(t.extent)));
    }
    match t.mips {
        1 => {}
        TextureDesc::ALL_MIPS => fields.push("mips: \"all\"".into()),
        mips => fields.push(format!("mips: {mips}")),
    }
    if t.layers != 1 {
        fields.push(format!("layers: {}", t.layers));
    }
    if t.samples != 1 {
        fields.push(format!("samples: {}", t.samples));
    }
    if t.dimension != Dimension::D2 {
        fields.push(format!("dimension: {:?}", t.dimension));
    }
}

fn size(extent: Extent) -> String {
    match extent {
        Extent::FRAME => "Frame".into(),
        Extent::Absolute { width, height } => format!("Texels({width}, {height})"),
        Extent::Relative { num, den, align: 1 } => format!("Scale(num: {num}, den: {den})"),
        Extent::Relative { num, den, align } => format!("Scale(num: {num}, den: {den}, align: {align})"),
    }
}

fn write_pass(graph: &Graph, pass: PassId, ids: &Ids, out: &mut String) {
    let row = &graph.passes()[pass.index()];
    let kind = match row.kind {
        PassKind::Raster => "Raster",
        PassKind::Compute => "Compute",
        PassKind::Copy => "Copy",
    };
    let name = graph.pass_name(pass);
    *out += &format!("        {kind}(name: {}", quoted(name));
    let id = &ids.passes[pass.index()];
    if id != name {
        *out += &format!(", id: {}", quoted(id));
    }
    let flags: Vec<_> = Flag::ALL
        .iter()
        .filter(|(_, flag)| row.flags.declared().has(*flag))
        .map(|(flag, _)| format!("{flag:?}"))
        .collect();
    if !flags.is_empty() {
        *out += &format!(", flags: [{}]", flags.join(", "));
    }
    *out += ", accesses: [\n";
    let mut next_slot = 0;
    for access in graph.accesses_of(pass) {
        *out += &access_line(graph, access, ids, &mut next_slot);
    }
    *out += "        ]),\n";
}

fn access_line(graph: &Graph, access: &Access, ids: &Ids, next_slot: &mut u8) -> String {
    let target = if access.mode.writes() { "to" } else { "of" };
    let name = &ids.resources[access.resource.index()];
    let mut fields = vec![format!("{target}: {}", quoted(name))];
    if access.kind != AccessKind::Resolve {
        fields.extend(intent(graph, access));
    }
    let usual = if access.kind == AccessKind::Color { *next_slot } else { 0 };
    if access.slot == Access::DEPTH {
        fields.push("of: Depth".into());
    } else if access.slot != usual {
        fields.push(format!("slot: {}", access.slot));
    }
    if access.resolve != ResolveMode::Average {
        fields.push(format!("mode: {:?}", access.resolve));
    }
    if access.kind == AccessKind::Color {
        *next_slot = (*next_slot).max(access.slot.saturating_add(1));
    }
    range_fields(&access.range, &mut fields);
    if let Some(ByteRange { offset, bytes, .. }) = graph.bytes_of(access) {
        fields.push(format!("bytes: ({offset}, {bytes})"));
    }
    format!("            {:?}({}),\n", access.kind, fields.join(", "))
}

fn intent(graph: &Graph, access: &Access) -> Option<String> {
    let value = match access.mode {
        Mode::Read => return None,
        Mode::Overwrite => "Overwrite".into(),
        Mode::Modify => "Modify".into(),
        Mode::Clear => match graph.clears()[access.clear as usize] {
            ClearValue::Color(rgba) => {
                let [r, g, b, a] = rgba.map(float);
                format!("ClearColor({r}, {g}, {b}, {a})")
            }
            ClearValue::DepthStencil(depth, 0) => format!("ClearDepth({})", float(depth)),
            ClearValue::DepthStencil(depth, stencil) => {
                format!("ClearDepthStencil({}, {stencil})", float(depth))
            }
            ClearValue::Zero => "ClearZero".into(),
        },
    };
    Some(format!("intent: {value}"))
}

fn range_fields(range: &Range, fields: &mut Vec<String>) {
    let Range { mip, mips, layer, layers, aspect, view, bytes: _, slice: _ } = *range;
    let all = Range::ALL;
    if mip != 0 || mips == 1 {
        fields.push(format!("mip: {mip}"));
    }
    let usual = if mip != 0 || mips == 1 { 1 } else { all.mips };
    if mips != usual {
        fields.push(format!("mips: {mips}"));
    }
    if layer != 0 || layers == 1 {
        fields.push(format!("layer: {layer}"));
    }
    let usual = if layer != 0 || layers == 1 { 1 } else { all.layers };
    if layers != usual {
        fields.push(format!("layers: {layers}"));
    }
    if aspect != Aspect::All {
        fields.push(format!("aspect: {aspect:?}"));
    }
    fields.extend(view.map(|view| format!("view: {view:?}")));
}

/// Formats a number that reads back to the same bits, except for the payload of a NaN.
fn float<F: serde::Serialize>(value: F) -> String {
    // Cannot fail: numbers can always be written to a string.
    ron::to_string(&value).unwrap_or_default()
}

fn quoted(text: &str) -> String {
    // Cannot fail: strings can always be written to a string.
    ron::to_string(text).unwrap_or_default()
}
