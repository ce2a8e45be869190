//! Order within layers that minimizes line crossings.

use super::vertex::Vertex;

/// Number of sweeps over all layers, back and forth.
const SWEEPS: usize = 8;

/// Returns the vertices of each layer from the top, in the best order found by median sweeps.
pub(super) fn ordered(vertices: &[Vertex], links: &[(usize, usize)], layers: usize) -> Vec<Vec<usize>> {
    let mut rows: Vec<Vec<usize>> = vec![Vec::new(); layers];
    for (vertex, row) in vertices.iter().enumerate() {
        rows[row.layer].push(vertex);
    }
    let (before, after) = neighbors(vertices.len(), links);
    let mut rank = vec![0usize; vertices.len()];
    renumber(&rows, &mut rank);
    let mut best = (crossings(&rows, &after, &rank), rows.clone());
    for sweep in 0..SWEEPS {
        if best.0 == 0 {
            break;
        }
        let forward = sweep % 2 == 0;
        for step in 0..layers {
            let layer = if forward { step } else { layers - 1 - step };
            let beside = if forward { &before } else { &after };
            sort(&mut rows[layer], beside, &rank);
            for (place, vertex) in rows[layer].iter().enumerate() {
                rank[*vertex] = place;
            }
        }
        let crossed = crossings(&rows, &after, &rank);
        if crossed < best.0 {
            best = (crossed, rows.clone());
        }
    }
    best.1
}

/// Returns the predecessors and the successors of each vertex.
pub(super) fn neighbors(vertices: usize, links: &[(usize, usize)]) -> (Vec<Vec<usize>>, Vec<Vec<usize>>) {
    let (mut before, mut after) = (vec![Vec::new(); vertices], vec![Vec::new(); vertices]);
    for &(from, to) in links {
        after[from].push(to);
        before[to].push(from);
    }
    (before, after)
}

fn renumber(rows: &[Vec<usize>], rank: &mut [usize]) {
    for row in rows {
        for (place, vertex) in row.iter().enumerate() {
            rank[*vertex] = place;
        }
    }
}

/// Sorts a layer by the medians of neighbors. Vertices without neighbors keep their positions.
fn sort(row: &mut [usize], beside: &[Vec<usize>], rank: &[usize]) {
    let median = |vertex: usize| {
        let mut ranks: Vec<usize> = beside[vertex].iter().map(|n| rank[*n]).collect();
        ranks.sort_unstable();
        let last = ranks.len().checked_sub(1)?;
        Some((ranks[last / 2] + ranks[last.div_ceil(2)]) as f32 / 2.0)
    };
    let free: Vec<usize> = (0..row.len()).filter(|place| !beside[row[*place]].is_empty()).collect();
    let mut sorted: Vec<(f32, usize, usize)> =
        free.iter().filter_map(|place| Some((median(row[*place])?, *place, row[*place]))).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for (place, (.., vertex)) in free.iter().zip(sorted) {
        row[*place] = vertex;
    }
}

/// Counts line crossings layer by layer with a binary indexed tree (Barth, Jünger, Mutzel 2002).
fn crossings(rows: &[Vec<usize>], after: &[Vec<usize>], rank: &[usize]) -> u64 {
    let mut total = 0;
    for (layer, row) in rows.iter().enumerate() {
        let Some(next) = rows.get(layer + 1) else { break };
        let mut sums = vec![0u64; next.len() + 1];
        let mut lines = 0;
        for vertex in row {
            let mut ends: Vec<usize> = after[*vertex].iter().map(|n| rank[*n]).collect();
            ends.sort_unstable();
            // A line crosses earlier lines that end below it.
            for end in &ends {
                let mut not_below = 0;
                let mut at = end + 1;
                while at > 0 {
                    not_below += sums[at];
                    at &= at - 1;
                }
                total += lines - not_below;
            }
            for end in &ends {
                lines += 1;
                let mut at = end + 1;
                while at < sums.len() {
                    sums[at] += 1;
                    at += at & at.wrapping_neg();
                }
            }
        }
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossings_are_those_that_pairs_count() {
        let rows = vec![vec![0, 1, 2, 3], vec![4, 5, 6]];
        let links = [(0, 6), (0, 4), (1, 5), (1, 4), (2, 4), (3, 5), (3, 6)];
        let (_, after) = neighbors(7, &links);
        let mut rank = vec![0; 7];
        renumber(&rows, &mut rank);
        let crossed = |a: (usize, usize), b: (usize, usize)| a.0 < b.0 && a.1 > b.1;
        let pairs = links.iter().map(|a| links.iter().filter(|b| crossed(*a, **b)).count() as u64).sum::<u64>();
        assert_eq!((crossings(&rows, &after, &rank), pairs), (5, 5));
    }
}
