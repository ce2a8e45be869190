//! Passes and what flows between them: a box a step with its passes, culled passes as ghosts, imports and what outlives
//! the frame at the ends of its lines.

use super::format::{bytes, title};
use super::heads::{step_tip, tip};
use crate::drawing::{Drawing, Ink, Item, shortened, text_width};
use crate::layout::layout;
use crate::plan_data::{Pass, PlanData, Step};
use std::collections::BTreeMap;

/// Height of a pass within its step.
const ROW: f32 = 34.0;
/// Height of the header of a step.
const HEAD: f32 = 20.0;
/// Padding around the passes of a step.
const PAD: f32 = 6.0;
/// Maximum number of characters of a name.
const LETTERS: usize = 30;
/// Font size of names.
const NAME: f32 = 13.0;
/// Font size of notes.
const NOTE: f32 = 10.5;

/// Node of the graph.
#[derive(Clone, Debug, PartialEq)]
enum Node {
    /// Step with its passes.
    Step(usize),
    /// Culled pass.
    Culled(usize),
    /// Resource that enters the frame.
    Source(usize),
    /// Resource that outlives the frame.
    End(usize),
}

/// Draws the graph, and below it the passes that only the compared plan declares.
pub fn drawing(plan: &PlanData, against: Option<&PlanData>) -> Drawing {
    let mut drawing = Drawing::default();
    let top = title(&mut drawing, "graph", plan);
    let (nodes, lines) = nodes(plan);
    let sizes: Vec<[f32; 2]> = nodes.iter().map(|node| size(plan, node)).collect();
    let edges: Vec<(usize, usize)> = lines.keys().copied().collect();
    let placed = layout(&sizes, &edges);
    let at = |[x, y]: [f32; 2]| [x, y + top + 6.0];
    for (points, ((from, to), (resources, flows))) in placed.edges.iter().zip(&lines) {
        let points = smooth(&points.iter().map(|p| at(*p)).collect::<Vec<_>>());
        let Some(&[x, y]) = points.last() else { continue };
        let ghost = matches!(nodes[*to], Node::Culled(_)) || matches!(nodes[*from], Node::Culled(_));
        let ink = if ghost { Ink::Ghost } else { Ink::Flow };
        if ghost {
            drawing.dashes(points, ink, 1.2);
        } else {
            drawing.line(points, ink, 1.6);
        }
        let items = flows.iter().map(|f| Item::Flow(*f)).chain(resources.iter().map(|r| Item::Resource(*r)));
        items.for_each(|item| drawing.mark(item));
        drawing.triangle([[x, y], [x - 9.0, y - 4.5], [x - 9.0, y + 4.5]], ink);
        let names = resources.iter().map(|r| {
            let resource = &plan.form.resources[*r];
            format!("{}: {}, {}", resource.name, resource.shape, bytes(resource.bytes))
        });
        let item = flows.first().map(|f| Item::Flow(*f)).or(resources.first().map(|r| Item::Resource(*r)));
        drawing.hit([x - 14.0, y - 8.0, x, y + 8.0], item, names.collect::<Vec<_>>().join("\n"));
    }
    for ((node, place), size) in nodes.iter().zip(&placed.nodes).zip(&sizes) {
        let [x, y] = at(*place);
        let bounds = [x, y, x + size[0], y + size[1]];
        match *node {
            Node::Step(step) => draw_step(plan, &plan.form.steps[step], bounds, &mut drawing),
            Node::Culled(pass) => {
                drawing.ghost(bounds, Ink::Ghost);
                draw_pass(plan, pass, "culled", [x + PAD, y], Ink::Ghost, &mut drawing);
                let row = &plan.form.passes[pass];
                drawing.hit(bounds, Item::Pass(pass), tip(row));
            }
            Node::Source(resource) | Node::End(resource) => {
                let row = &plan.form.resources[resource];
                drawing.rect(bounds, Ink::Own, Ink::Faint);
                let said = if matches!(node, Node::Source(_)) { "in" } else { "out" };
                let name = shortened(&row.name, LETTERS);
                drawing.text([x + PAD, y + 12.0], NAME, Ink::Text, name);
                drawing.text([x + PAD, y + 26.0], NOTE, Ink::Text, format!("{} {said}", row.kind));
                let tip = format!("{} ({})\n{}, {}", row.name, row.kind, row.shape, bytes(row.bytes));
                drawing.hit(bounds, Item::Resource(resource), tip);
            }
        }
    }
    if let Some(before) = against {
        gone(before, plan, &mut drawing);
    }
    drawing
}

/// Draws passes that are no longer declared, such as those of disabled effects.
fn gone(before: &PlanData, plan: &PlanData, drawing: &mut Drawing) {
    let names = super::diff::changes(before, plan).passes_removed;
    if names.is_empty() {
        return;
    }
    let right = drawing.size[0].max(700.0);
    let [mut x, mut y] = [0.0, drawing.size[1] + 40.0];
    drawing.text([x, y - 18.0], NOTE, Ink::Ghost, "not declared here, only in the compared plan:");
    for name in names.iter().map(|name| shortened(name, LETTERS)) {
        let width = text_width(&name, NAME) + 2.0 * PAD;
        if x > 0.0 && x + width > right {
            (x, y) = (0.0, y + 34.0);
        }
        drawing.ghost([x, y, x + width, y + 26.0], Ink::Ghost);
        drawing.text([x + PAD, y + 13.0], NAME, Ink::Ghost, name);
        x += width + 10.0;
    }
}

/// Resources and flows of each line between two nodes.
type Lines = BTreeMap<(usize, usize), (Vec<usize>, Vec<usize>)>;

/// Returns the nodes in execution order and the lines between them.
fn nodes(plan: &PlanData) -> (Vec<Node>, Lines) {
    let form = &plan.form;
    let mut nodes: Vec<Node> = (0..form.steps.len()).map(Node::Step).collect();
    let mut node_of: Vec<Option<usize>> = form.passes.iter().map(|pass| pass.step).collect();
    for (index, _) in form.passes.iter().enumerate().filter(|(_, pass)| pass.culled) {
        node_of[index] = Some(nodes.len());
        nodes.push(Node::Culled(index));
    }
    let mut lines = Lines::new();
    let mut put = |from: usize, to: usize, resource: Option<usize>, flow: Option<usize>| {
        if from == to {
            return;
        }
        let (resources, flows) = lines.entry((from, to)).or_default();
        resources.extend(resource.filter(|r| !resources.contains(r)).as_slice());
        flows.extend(flow.filter(|f| !flows.contains(f)).as_slice());
    };
    let mut written_before = vec![Vec::new(); form.passes.len()];
    for (index, flow) in form.flows.iter().flatten().enumerate() {
        let (Some(from), Some(to)) = (plan.pass(&flow.from), plan.pass(&flow.to)) else { continue };
        let (Some(from), Some(to_node)) = (node_of[from], node_of[to]) else { continue };
        for resource in flow.resources.iter().filter_map(|name| plan.resource(name)) {
            written_before[to].push(resource);
            put(from, to_node, Some(resource), Some(index));
        }
    }
    // Full-screen resolves read the output of their pass in an earlier step.
    for step in form.steps.iter().filter(|step| step.full_screen_resolve) {
        for drawn in step.passes.iter().filter_map(|name| node_of[plan.pass(name)?]) {
            put(drawn, step.index, None, None);
        }
    }
    let mut writers: Vec<Option<usize>> = vec![None; form.resources.len()];
    let mut sources: BTreeMap<usize, usize> = BTreeMap::new();
    for step in &form.steps {
        for pass in step.passes.iter().filter_map(|name| plan.pass(name)) {
            for access in &form.passes[pass].accesses {
                let Some(resource) = plan.resource(&access.resource) else { continue };
                let outside = form.resources[resource].kind != "transient";
                if access.reads() && outside && !written_before[pass].contains(&resource) {
                    let source = *sources.entry(resource).or_insert_with(|| {
                        nodes.push(Node::Source(resource));
                        nodes.len() - 1
                    });
                    put(source, step.index, Some(resource), None);
                }
                if access.writes() {
                    writers[resource] = Some(step.index);
                }
            }
        }
    }
    for (resource, row) in form.resources.iter().enumerate() {
        let stays = row.exit.as_deref() == Some("keep") || row.kind == "history" || row.placement == "own";
        if let Some(writer) = writers[resource].filter(|_| stays && row.kind != "previous") {
            put(writer, nodes.len(), Some(resource), None);
            nodes.push(Node::End(resource));
        }
    }
    (nodes, lines)
}

/// Returns the resources that a pass writes, as a short line.
fn written(pass: &Pass) -> String {
    let mut names: Vec<&str> = Vec::new();
    for access in pass.accesses.iter().filter(|a| a.writes()) {
        if !names.contains(&access.resource.as_str()) {
            names.push(&access.resource);
        }
    }
    if names.is_empty() { "writes nothing".into() } else { format!("→ {}", names.join(", ")) }
}

/// Returns the label of how a pass joined its step.
fn joined(pass: &Pass, step: &Step) -> &'static str {
    match pass.join.as_deref() {
        _ if step.full_screen_resolve => "full-screen resolve",
        Some("attachments") => "merged",
        Some("same_pixel") => "same pixel",
        Some("inlined") => "inlined",
        _ => "",
    }
}

fn head_of(step: &Step) -> String {
    let [w, h] = step.extent;
    let mut head = format!("step {} {}", step.index, step.kind);
    if w > 0 {
        head += &format!(" {w}x{h}");
    }
    if step.samples > 1 {
        head += &format!(" x{}", step.samples);
    }
    head
}

fn size(plan: &PlanData, node: &Node) -> [f32; 2] {
    let pass_width = |pass: &Pass, said: &str| {
        let name = text_width(&shortened(&pass.name, LETTERS), NAME);
        let said = if said.is_empty() { 0.0 } else { text_width(said, NOTE) + 12.0 };
        let note = text_width(&shortened(&written(pass), note_letters()), NOTE);
        (name + said).max(note)
    };
    match *node {
        Node::Step(index) => {
            let step = &plan.form.steps[index];
            let passes = step.passes.iter().filter_map(|name| Some(&plan.form.passes[plan.pass(name)?]));
            let width = passes.clone().map(|p| pass_width(p, joined(p, step)) + 2.0 * PAD).fold(0.0, f32::max);
            let width = width.max(text_width(&head_of(step), NOTE)).max(90.0) + 2.0 * PAD;
            [width, HEAD + ROW * passes.count() as f32 + PAD]
        }
        Node::Culled(pass) => [pass_width(&plan.form.passes[pass], "culled") + 2.0 * PAD, ROW + 2.0],
        Node::Source(resource) | Node::End(resource) => {
            let row = &plan.form.resources[resource];
            let said = text_width(&format!("{} out", row.kind), NOTE);
            [text_width(&shortened(&row.name, LETTERS), NAME).max(said) + 2.0 * PAD, ROW + 2.0]
        }
    }
}

/// Number of note characters as wide as the longest name.
fn note_letters() -> usize {
    (LETTERS as f32 * NAME / NOTE) as usize
}

fn draw_step(plan: &PlanData, step: &Step, bounds: [f32; 4], drawing: &mut Drawing) {
    let [x, y, right, _] = bounds;
    drawing.rect(bounds, Ink::Step, Ink::Faint);
    drawing.text([x + PAD, y + HEAD / 2.0], NOTE, Ink::Faint, head_of(step));
    drawing.hit(bounds, Item::Step(step.index), step_tip(step));
    let passes = step.passes.iter().filter_map(|name| plan.pass(name));
    for (row, pass) in passes.enumerate() {
        let data = &plan.form.passes[pass];
        let top = y + HEAD + ROW * row as f32;
        let box_ = [x + PAD, top, right - PAD, top + ROW - 3.0];
        let ink = match data.kind.as_str() {
            "compute" => Ink::Compute,
            "copy" => Ink::Copy,
            _ => Ink::Raster,
        };
        drawing.rect(box_, ink, None);
        draw_pass(plan, pass, joined(data, step), [x + 2.0 * PAD, top], Ink::Text, drawing);
        drawing.hit(box_, Item::Pass(pass), tip(data));
    }
}

/// Draws the two lines of a pass.
fn draw_pass(plan: &PlanData, pass: usize, said: &str, [x, y]: [f32; 2], ink: Ink, drawing: &mut Drawing) {
    let pass = &plan.form.passes[pass];
    let name = shortened(&pass.name, LETTERS);
    let end = x + text_width(&name, NAME) + 12.0;
    drawing.text([x, y + 10.0], NAME, ink, name);
    if !said.is_empty() {
        drawing.text([end, y + 10.5], NOTE, ink, said);
    }
    drawing.text([x, y + 23.0], NOTE, ink, shortened(&written(pass), note_letters()));
}

/// Returns a polyline with smooth slopes.
fn smooth(points: &[[f32; 2]]) -> Vec<[f32; 2]> {
    const PARTS: usize = 8;
    let mut out = vec![points[0]];
    for pair in points.windows(2) {
        let [[x0, y0], [x1, y1]] = [pair[0], pair[1]];
        if (y1 - y0).abs() > 0.5 {
            out.extend((1..PARTS).map(|part| {
                let t = part as f32 / PARTS as f32;
                [x0 + (x1 - x0) * t, y0 + (y1 - y0) * t * t * (3.0 - 2.0 * t)]
            }));
        }
        out.push([x1, y1]);
    }
    out
}

/// Returns an item and its related items, which are highlighted together. A resource includes its writers and readers.
pub fn lit(plan: &PlanData, item: Item) -> Vec<Item> {
    let mut lit = vec![item];
    match item {
        Item::Resource(resource) => {
            let name = &plan.form.resources[resource].name;
            let uses = |pass: &Pass| pass.accesses.iter().any(|a| a.resource == *name);
            let passes = plan.form.passes.iter().enumerate().filter(|(_, pass)| uses(pass));
            lit.extend(passes.map(|(index, _)| Item::Pass(index)));
        }
        Item::Pass(pass) => {
            let name = &plan.form.passes[pass].name;
            let flows = plan.form.flows.iter().flatten().enumerate();
            let touching = flows.filter(|(_, flow)| flow.from == *name || flow.to == *name);
            lit.extend(touching.map(|(index, _)| Item::Flow(index)));
        }
        Item::Flow(flow) => {
            if let Some(flow) = plan.form.flows.as_ref().and_then(|flows| flows.get(flow)) {
                lit.extend([&flow.from, &flow.to].into_iter().filter_map(|name| plan.pass(name)).map(Item::Pass));
                lit.extend(flow.resources.iter().filter_map(|name| plan.resource(name)).map(Item::Resource));
            }
        }
        Item::Step(_) => {}
    }
    lit
}
