//! Estimated costs of steps, for use without measurements.

use framegraph::Plan;

/// Estimates the cost of each step in microseconds from the bytes of the resources it uses, each counted once.
///
/// `bytes_per_us` is the bandwidth in bytes per microsecond; 1000 is one gigabyte per second. Measured times are more
/// accurate.
#[must_use]
pub fn estimate_us(plan: &Plan, bytes_per_us: f64) -> Vec<f64> {
    let bytes_of = |step| {
        let members = plan.passes_of(step).iter();
        let accesses = members.flat_map(|member| plan.graph().accesses_of(member.pass));
        let mut accessed: Vec<_> = accesses.map(|access| access.resource).collect();
        accessed.sort_unstable();
        accessed.dedup();
        accessed.iter().map(|resource| plan.resources()[resource.index()].bytes as f64).sum::<f64>()
    };
    plan.step_ids().map(|step| bytes_of(step) / bytes_per_us.max(1e-9)).collect()
}
