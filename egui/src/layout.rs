//! Layered layout of a directed graph, from left to right (Sugiyama, Tagawa, Toda 1981).
//!
//! Longest paths determine the layers, medians of neighbors the order within layers (Eades, Wormald 1994), and least
//! squares the positions.
//!
//! Existing crates (`rust-sugiyama`, `layout-rs`) draw nodes of one size or route every edge separately. Frames have steps
//! with many passes, and textures with dozens of readers whose lines run in parallel. Here all edges of a node share one
//! line until they diverge.

mod order;
mod place;
mod vertex;

use vertex::Vertex;

/// Space between layers.
pub const LAYER_GAP: f32 = 70.0;
/// Maximum number of bends, where lines pass layers; further edges run straight.
const MAX_BENDS: usize = 60_000;

/// Positions of all nodes and edges.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layout {
    /// Left and top of each node.
    pub nodes: Vec<[f32; 2]>,
    /// Layer of each node, from 0.
    pub layers: Vec<usize>,
    /// Points of each edge, from the right side of its source to the left side of its target.
    pub edges: Vec<Vec<[f32; 2]>>,
}

/// Lays out nodes with the given widths and heights. Edges that close a cycle run backward.
pub fn layout(sizes: &[[f32; 2]], edges: &[(usize, usize)]) -> Layout {
    let layers = layers(sizes.len(), edges);
    let count = layers.iter().max().map_or(0, |last| last + 1);
    let mut vertices: Vec<Vertex> =
        (0..sizes.len()).map(|node| Vertex { layer: layers[node], height: sizes[node][1], bend: false }).collect();
    // Bends by source, in all later layers that its edges pass.
    let mut reach: Vec<usize> = layers.clone();
    for &(from, to) in edges {
        reach[from] = reach[from].max(layers[to].saturating_sub(1));
    }
    let mut links: Vec<(usize, usize)> = Vec::new();
    let mut bends: Vec<Vec<usize>> = vec![Vec::new(); sizes.len()];
    for node in 0..sizes.len() {
        let mut before = node;
        for layer in layers[node] + 1..=reach[node] {
            if vertices.len() - sizes.len() >= MAX_BENDS {
                break;
            }
            links.push((before, vertices.len()));
            before = vertices.len();
            bends[node].push(before);
            vertices.push(Vertex { layer, height: 0.0, bend: true });
        }
    }
    for &(from, to) in edges.iter().filter(|(from, to)| layers[*from] < layers[*to]) {
        let between = layers[to] - layers[from] - 1;
        let last = if between == 0 { Some(&from) } else { bends[from].get(between - 1) };
        links.extend(last.map(|last| (*last, to)));
    }
    let rows = order::ordered(&vertices, &links, count);
    let y = place::placed(&vertices, &links, &rows);
    let mut x = vec![0.0f32; count + 1];
    for layer in 0..count {
        let width = rows[layer].iter().filter_map(|v| sizes.get(*v)).map(|s| s[0]).fold(0.0, f32::max);
        x[layer + 1] = x[layer] + width + LAYER_GAP;
    }
    let nodes: Vec<[f32; 2]> = sizes.iter().enumerate().map(|(n, s)| [x[layers[n]], y[n] - s[1] / 2.0]).collect();
    let route = |&(from, to): &(usize, usize)| {
        let mut points = vec![[nodes[from][0] + sizes[from][0], y[from]]];
        let between = layers[to].saturating_sub(layers[from] + 1);
        for &bend in bends[from].iter().take(between) {
            let layer = vertices[bend].layer;
            points.push([x[layer], y[bend]]);
            points.push([x[layer + 1] - LAYER_GAP, y[bend]]);
        }
        points.push([nodes[to][0], y[to]]);
        points
    };
    Layout { edges: edges.iter().map(route).collect(), layers, nodes }
}

/// Returns the layer of each node: one after its last predecessor.
///
/// Nodes without predecessors are placed next to their first successor. In a cycle, edges into its first node are ignored.
fn layers(nodes: usize, edges: &[(usize, usize)]) -> Vec<usize> {
    let mut after = vec![Vec::new(); nodes];
    let mut waiting = vec![0usize; nodes];
    for &(from, to) in edges.iter().filter(|(from, to)| from != to) {
        after[from].push(to);
        waiting[to] += 1;
    }
    let mut ready: std::collections::BTreeSet<usize> = (0..nodes).filter(|n| waiting[*n] == 0).collect();
    let mut left: std::collections::BTreeSet<usize> = (0..nodes).collect();
    let (mut layers, mut source) = (vec![0usize; nodes], vec![true; nodes]);
    while let Some(node) = ready.pop_first().or_else(|| left.first().copied()) {
        left.remove(&node);
        for &next in after[node].iter().filter(|next| left.contains(next)) {
            layers[next] = layers[next].max(layers[node] + 1);
            source[next] = false;
            waiting[next] -= 1;
            if waiting[next] == 0 {
                ready.insert(next);
            }
        }
    }
    for node in (0..nodes).filter(|n| source[*n]) {
        let nearest = after[node].iter().map(|next| layers[*next]).min();
        layers[node] = nearest.map_or(layers[node], |nearest| nearest.saturating_sub(1).max(layers[node]));
    }
    layers
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Asserts that no nodes overlap.
    fn assert_apart(sizes: &[[f32; 2]], layout: &Layout) {
        let bounds = |n: usize| {
            let ([x, y], [w, h]) = (layout.nodes[n], sizes[n]);
            [x, y, x + w, y + h]
        };
        for a in 0..sizes.len() {
            for b in 0..a {
                let (p, q) = (bounds(a), bounds(b));
                let overlap = p[0] < q[2] && q[0] < p[2] && p[1] < q[3] && q[1] < p[3];
                assert!(!overlap, "{a} {p:?} and {b} {q:?}");
            }
        }
    }

    #[test]
    fn edges_lead_to_later_layers_and_boxes_stay_apart() {
        let sizes: Vec<[f32; 2]> =
            (0..40).map(|i| [60.0 + (i % 5) as f32 * 20.0, 20.0 + (i % 7) as f32 * 10.0]).collect();
        let edges: Vec<_> = (1..40).flat_map(|i| [(i / 2, i), (i / 3, i)]).filter(|(a, b)| a != b).collect();
        let layout = layout(&sizes, &edges);
        assert_apart(&sizes, &layout);
        for (&(from, to), points) in edges.iter().zip(&layout.edges) {
            assert!(layout.layers[from] < layout.layers[to]);
            assert!(points.windows(2).all(|p| p[0][0] <= p[1][0]), "{points:?}");
            assert_eq!(
                points[0],
                [layout.nodes[from][0] + sizes[from][0], layout.nodes[from][1] + sizes[from][1] / 2.0]
            );
        }
    }

    #[test]
    fn a_cycle_is_laid_out() {
        let sizes = [[10.0, 10.0]; 3];
        let layout = layout(&sizes, &[(0, 1), (1, 2), (2, 0), (1, 1)]);
        assert_eq!(layout.layers, [0, 1, 2]);
        assert_apart(&sizes, &layout);
    }

    #[test]
    fn avoidable_crossings_are_avoided() {
        // Two ladders, declared crosswise.
        let sizes = [[10.0, 10.0]; 6];
        let edges = [(0, 3), (1, 2), (2, 4), (3, 5)];
        let layout = layout(&sizes, &edges);
        let y = |n: usize| layout.nodes[n][1];
        assert_eq!(y(0) < y(1), y(3) < y(2));
        assert_eq!(y(3) < y(2), y(5) < y(4));
        assert_eq!(y(0), y(3), "a line without need of a bend is straight");
    }

    #[test]
    fn a_source_is_next_to_its_first_reader() {
        let layout = layout(&[[10.0, 10.0]; 5], &[(0, 1), (1, 2), (2, 3), (4, 3)]);
        assert_eq!(layout.layers, [0, 1, 2, 3, 2]);
    }

    #[test]
    fn an_empty_graph_has_an_empty_layout() {
        assert_eq!(layout(&[], &[]), Layout::default());
    }
}
