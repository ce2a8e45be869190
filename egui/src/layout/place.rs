//! Positions within layers: near the neighbors, in order, without overlap.

use super::order::neighbors;
use super::vertex::Vertex;

/// Number of sweeps over all layers, back and forth.
const SWEEPS: usize = 6;

/// Returns the vertical center of each vertex, with the topmost edge at 0.
pub(super) fn placed(vertices: &[Vertex], links: &[(usize, usize)], rows: &[Vec<usize>]) -> Vec<f32> {
    let (before, after) = neighbors(vertices.len(), links);
    let mut y = vec![0.0f32; vertices.len()];
    for row in rows {
        let mut end = 0.0;
        for (place, vertex) in row.iter().enumerate() {
            end += place.checked_sub(1).map_or(0.0, |last| vertices[row[last]].apart(&vertices[*vertex]));
            y[*vertex] = end;
        }
        // Layers start centered on one line.
        row.iter().for_each(|vertex| y[*vertex] -= end / 2.0);
    }
    for sweep in 0..SWEEPS {
        let forward = sweep % 2 == 0;
        for step in 0..rows.len() {
            let row = &rows[if forward { step } else { rows.len() - 1 - step }];
            let wish = |vertex: usize| {
                let beside = if forward { &before[vertex] } else { &after[vertex] };
                let sum: f32 = beside.iter().map(|n| y[*n]).sum();
                // A vertex without neighbors on this side stays, with a low weight.
                if beside.is_empty() { (y[vertex], 0.1) } else { (sum / beside.len() as f32, 1.0) }
            };
            let wishes: Vec<(f32, f32)> = row.iter().map(|v| wish(*v)).collect();
            for (vertex, place) in row.iter().zip(nearest(vertices, row, &wishes)) {
                y[*vertex] = place;
            }
        }
    }
    let top = vertices.iter().zip(&y).map(|(v, y)| y - v.height / 2.0).fold(f32::INFINITY, f32::min);
    y.iter_mut().for_each(|y| *y -= top);
    y
}

/// Returns the positions nearest to the wishes by weighted least squares, under the constraints of order and distance.
///
/// It is an isotonic regression that pools adjacent violators (Ayer and others 1955).
fn nearest(vertices: &[Vertex], row: &[usize], wishes: &[(f32, f32)]) -> Vec<f32> {
    // After subtracting the accumulated distances, order is the only constraint.
    let mut shift = 0.0f64;
    let mut shifts = Vec::with_capacity(row.len());
    // Blocks of vertices at one shifted position: sum of weighted wishes, weight, count.
    let mut blocks: Vec<(f64, f64, usize)> = Vec::new();
    for (place, vertex) in row.iter().enumerate() {
        if let Some(last) = place.checked_sub(1) {
            shift += f64::from(vertices[row[last]].apart(&vertices[*vertex]));
        }
        shifts.push(shift);
        let (wish, weight) = wishes[place];
        let weight = f64::from(weight);
        let mut block = ((f64::from(wish) - shift) * weight, weight, 1);
        while let Some(last) = blocks.pop_if(|last| last.0 / last.1 > block.0 / block.1) {
            block = (block.0 + last.0, block.1 + last.1, block.2 + last.2);
        }
        blocks.push(block);
    }
    let places = blocks.iter().flat_map(|(sum, weight, count)| std::iter::repeat_n(sum / weight, *count));
    places.zip(shifts).map(|(place, shift)| (place + shift) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wishes_that_agree_are_met_and_others_shared() {
        let vertices = [Vertex { layer: 0, height: 10.0, bend: false }; 3];
        let gap = vertices[0].apart(&vertices[1]);
        let at = |wishes: [f32; 3]| nearest(&vertices, &[0, 1, 2], &wishes.map(|w| (w, 1.0)));
        assert_eq!(at([0.0, 100.0, 200.0]), [0.0, 100.0, 200.0]);
        assert_eq!(at([5.0, 5.0, 5.0]), [5.0 - gap, 5.0, 5.0 + gap]);
        assert_eq!(at([0.0, 0.0, 300.0]), [-gap / 2.0, gap / 2.0, 300.0]);
    }
}
