//! Any graph, on any device, with any options: compiling refuses it or gives a plan that the oracle has nothing against.
//!
//! Scratch and plan are kept between cases, to catch what one compile leaves behind for the next.
#![no_main]

use framegraph::generate::{self, Entropy, OPTIONS, Profile, options_of};
use framegraph::{Caps, Plan, Scratch, check, compile, dump};
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
    let profile = Profile { max_passes: 40, sloppy: entropy.one_in(4), plain: false };
    let graph = generate::graph(&mut entropy, &profile);
    KEPT.with_borrow_mut(|(scratch, plan)| {
        if compile(&graph, &caps, &options, scratch, plan).is_ok() {
            let report = check::examine(plan);
            assert!(report.is_clean(), "{report}\n{caps:?}\n{options:?}\n{}", dump::text(plan));
        }
    });
});
