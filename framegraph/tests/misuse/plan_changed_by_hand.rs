//! A plan that is changed by hand: it is read, and made by compiling alone.

use framegraph::{Plan, StoreOp};

fn patch(plan: &mut Plan) {
    plan.attachments[0].store = StoreOp::Discard;
}

fn main() {}
