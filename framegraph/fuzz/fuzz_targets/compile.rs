//! Compiles random graphs on random devices with random options. The compiler must report errors or return a plan
//! without findings of the oracle. All dumps must succeed, also of empty plans. Offsets must be kept when a plan is
//! compiled after itself.
//!
//! Scratch memory and plan are reused between cases, to detect state that leaks from one compilation into the next.
#![no_main]

use framegraph::{Caps, Order, Plan, Scratch, compile, compile_after, dump, recompile};
use framegraph_check::check;
use framegraph_check::generate::{self, Entropy, OPTIONS, Profile, options_of};
use libfuzzer_sys::fuzz_target;
use std::cell::RefCell;

thread_local! {
    static KEPT: RefCell<(Scratch, Plan)> = RefCell::default();
}

fuzz_target!(|bytes: &[u8]| {
    let mut entropy = Entropy::from_bytes(bytes);
    let options = options_of(entropy.below(OPTIONS));
    let preset = entropy.pick(&Caps::PRESETS);
    let strange = entropy.one_in(4).then(|| generate::caps(&mut entropy));
    let caps = strange.or_else(|| Caps::preset(preset)).unwrap_or_default();
    // The optimizing order plans each graph up to a thousand times.
    let max_passes = if options.order == Order::Optimized { 12 } else { 40 };
    let profile = Profile { max_passes, sloppy: entropy.one_in(4), ..Profile::default() };
    let graph = generate::graph(&mut entropy, &profile);
    KEPT.with_borrow_mut(|(scratch, plan)| {
        let sound = |plan: &Plan| {
            let report = check::examine(plan);
            assert!(report.is_clean(), "{report}\n{caps:?}\n{options:?}\n{}", dump::text(plan));
        };
        let compiled = compile(&graph, &caps, &options, scratch, plan).is_ok();
        let forms = [dump::text(plan), dump::dot(plan), dump::mermaid(plan), dump::svg(plan), dump::json(plan, "fuzz")];
        assert!(forms.iter().all(|form| !form.is_empty()));
        if compiled {
            sound(plan);
            let mut after = Plan::new();
            assert_eq!(compile_after(&graph, &caps, &options, plan, scratch, &mut after), Ok(()));
            sound(&after);
            assert!(after.memory().bytes <= plan.memory().bytes, "kept offsets enlarge the heap");
            assert_eq!(recompile(&graph, &caps, &options, scratch, plan), Ok(false));
        }
    });
});
