//! A change of a plan, which is read-only.

use framegraph::{Plan, StoreOp};

fn patch(plan: &mut Plan) {
    plan.attachments[0].store = StoreOp::Discard;
}

fn main() {}
