//! Temporal errors of a sequence of frames against a sequence of the finest frames.

use super::technique::Outcome;
use crate::reference::picture::Picture;

/// Temporal errors, in 8-bit steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Temporal {
    /// Spatial error: root mean square difference of all frames.
    pub spatial: f64,
    /// Flicker: root mean square change between consecutive frames of channels that change by less than one step
    /// in the reference.
    pub flicker: f64,
    /// Ghosting: mean share, 0 to 1, of the old value in channels that the reference has changed by more than 16 steps
    /// from the previous frame, such as after a disocclusion.
    pub ghost: f64,
    /// Popping: the largest root mean square change of the error between consecutive frames, over the median of
    /// these changes. 1 is even; a level of detail that changes at once gives a large value.
    pub pop: f64,
}

/// Change of a channel in the reference, in 8-bit steps, below which the channel is static.
const STATIC_STEPS: f64 = 1.0;
/// Change of a channel in the reference, in 8-bit steps, above which its old value can be a ghost.
const CHANGED_STEPS: f64 = 16.0;

/// Returns the temporal errors of two sequences of equal length and size.
///
/// # Errors
/// Fails if the sequences differ in length or size, or have fewer than three frames.
pub fn temporal(ours: &[Picture], truth: &[Picture]) -> Outcome<Temporal> {
    let equal = ours.iter().zip(truth).all(|(a, b)| a.size_px == b.size_px && a.size_px == truth[0].size_px);
    if ours.len() != truth.len() || ours.len() < 3 || !equal {
        return Err("temporal errors need two sequences of equal size, with at least three frames".into());
    }
    let steps = |pictures: &[Picture]| -> Vec<Vec<f64>> {
        let of = |picture: &Picture| picture.encoded.iter().flatten().map(|c| 255.0 * f64::from(*c)).collect();
        pictures.iter().map(of).collect()
    };
    let (ours, truth) = (steps(ours), steps(truth));
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
    let (mut spatial, mut flicker, mut ghost, mut jumps) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for frame in 0..ours.len() {
        spatial.extend(ours[frame].iter().zip(&truth[frame]).map(|(a, b)| (a - b).powi(2)));
        if frame == 0 {
            continue;
        }
        let [[a, before_a], [b, before_b]] = [&ours, &truth].map(|all| [&all[frame], &all[frame - 1]]);
        let mut jump = Vec::with_capacity(a.len());
        for at in 0..a.len() {
            let (own, change) = (a[at] - before_a[at], b[at] - before_b[at]);
            jump.push((own - change).powi(2));
            if change.abs() < STATIC_STEPS {
                flicker.push(own * own);
            } else if change.abs() > CHANGED_STEPS {
                // 0 at the new value, 1 at the old one.
                ghost.push(((b[at] - a[at]) / change).clamp(0.0, 1.0));
            }
        }
        jumps.push(mean(&jump).sqrt());
    }
    jumps.sort_by(f64::total_cmp);
    let (typical, most) = (jumps[jumps.len() / 2], jumps[jumps.len() - 1]);
    let pop = if most < 0.01 { 1.0 } else { most / typical.max(0.01) };
    Ok(Temporal { spatial: mean(&spatial).sqrt(), flicker: mean(&flicker).sqrt(), ghost: mean(&ghost), pop })
}
