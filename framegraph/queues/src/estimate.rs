//! Costs where nothing was measured.

use framegraph::Plan;

/// What each step costs in microseconds if all it does is to move the bytes of what it touches, each resource once, at
/// `bytes_per_us` bytes a microsecond: a gigabyte a second is a thousand. A stand-in for times, which say more.
#[must_use]
pub fn estimate_us(plan: &Plan, bytes_per_us: f64) -> Vec<f64> {
    let bytes_of = |step| {
        let members = plan.passes_of(step).iter();
        let accesses = members.flat_map(|member| plan.graph().accesses_of(member.pass));
        let mut touched: Vec<_> = accesses.map(|access| access.resource).collect();
        touched.sort_unstable();
        touched.dedup();
        touched.iter().map(|resource| plan.resources()[resource.index()].bytes as f64).sum::<f64>()
    };
    plan.step_ids().map(|step| bytes_of(step) / bytes_per_us.max(1e-9)).collect()
}
