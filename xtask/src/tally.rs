//! Summary of test reports: totals from libtest's closing lines, and skips and adapters from a file.
//!
//! # The convention
//! libtest hides the output of passing tests, so a skipped test would go unnoticed. A test that skips prints `SKIP:
//! <test>: <reason>`, and appends this line to the file in the environment variable [`SKIP_LOG`]
//! (`FRAMEGRAPH_SKIP_LOG`). Tests append other lines in the same way: `ADAPTER: <name>` for an opened adapter, `RESULT:
//! <test>: <counts>` for additional counts, and `CASES: <test>: <N> of <M>` if only some cases ran. Each line is a
//! single write to a file opened for appending, so lines of concurrent tests do not mix. `cargo xtask test` sets the
//! variable and prints all of these in its summary.

use std::collections::{BTreeMap, BTreeSet};

/// Environment variable with the path of the file for `SKIP: `, `CASES: `, `RESULT: ` and `ADAPTER: ` lines.
pub const SKIP_LOG: &str = "FRAMEGRAPH_SKIP_LOG";

/// Sums of the `test result:` lines of all test binaries and doc tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    /// Number of closing lines: one for each test binary and each crate's doc tests.
    pub runs: u32,
    /// Tests that passed, including skipped ones.
    pub passed: u32,
    /// Tests that failed.
    pub failed: u32,
    /// Tests marked `#[ignore]`.
    pub ignored: u32,
}

impl Totals {
    /// Adds `line` if it is libtest's closing line, such as
    /// `test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.00s`.
    pub fn add(&mut self, line: &str) {
        let Some(rest) = line.strip_prefix("test result: ") else {
            return;
        };
        self.runs += 1;
        let counts = rest.split_once(". ").map_or(rest, |(_, counts)| counts);
        for part in counts.split(';') {
            let Some((count, what)) = part.trim().split_once(' ') else {
                continue;
            };
            let Ok(count) = count.parse::<u32>() else {
                continue;
            };
            match what {
                "passed" => self.passed += count,
                "failed" => self.failed += count,
                "ignored" => self.ignored += count,
                _ => {}
            }
        }
    }
}

/// Lines that the tests wrote into the file named by [`SKIP_LOG`].
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Reported {
    /// `<test>: <reason>`, sorted, since tests run in any order.
    pub skips: Vec<String>,
    /// Tests that ran only some of their cases: the number that ran, and the total.
    pub shares: BTreeMap<String, [usize; 2]>,
    /// `<test>: <counts>` of tests that report additional counts, sorted.
    pub results: Vec<String>,
    /// Distinct adapter names, sorted.
    pub adapters: BTreeSet<String>,
}

impl Reported {
    /// Reads the file's text. A line of unknown kind counts as a skip.
    pub fn from_text(text: &str) -> Self {
        let mut reported = Self::default();
        for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
            if let Some(adapter) = line.strip_prefix("ADAPTER:") {
                reported.adapters.insert(adapter.trim().to_owned());
            } else if let Some(result) = line.strip_prefix("RESULT:") {
                reported.results.push(result.trim().to_owned());
            } else if let Some((test, [ran, all])) = line.strip_prefix("CASES:").and_then(share) {
                let cases = reported.shares.entry(test.to_owned()).or_default();
                *cases = [cases[0] + ran, cases[1] + all];
            } else {
                let skip = line.strip_prefix("SKIP:").unwrap_or(line);
                reported.skips.push(skip.trim().to_owned());
            }
        }
        reported.skips.sort();
        reported.results.sort();
        reported
    }
}

/// Reads `<test>: <N> of <M>`.
fn share(text: &str) -> Option<(&str, [usize; 2])> {
    let (test, cases) = text.rsplit_once(": ")?;
    let (ran, all) = cases.split_once(" of ")?;
    Some((test.trim(), [ran.parse().ok()?, all.parse().ok()?]))
}

/// A skip that does not fail the run.
struct Known {
    /// Names of the tests, or of one of their cases.
    tests: &'static [&'static str],
    /// Part of the reason.
    reason: &'static str,
}

/// Every allowed skip. `cargo xtask test` fails on any other, and if no test reported an adapter.
const KNOWN: [Known; 16] = [
    Known {
        tests: &[
            "a_live_frame_is_drawn_in_a_window",
            "a_window_draws_sixty_frames",
            "a_window_is_drawn_into",
            "a_window_is_resized_hidden_and_closed",
        ],
        reason: "there is no Xvfb",
    },
    Known { tests: &["several_layers_are_drawn_into_at_once"], reason: "does not draw into several layers" },
    // Desktop GPUs sample BC7, mobile ones ETC2 and ASTC.
    Known {
        tests: &["compressed_textures_draw_their_source_picture", "every_level_is_sampled_as_rgba"],
        reason: "this device does not sample",
    },
    Known { tests: &["misuse_does_not_compile"], reason: "the expected output is of Rust" },
    // A model that is too large to be committed.
    Known { tests: &["scene", "the_helmet_agrees_with_rays"], reason: "tests/assets/models/FlightHelmet" },
    Known { tests: &["one_depth_of_four_samples_is_that_asked_for"], reason: "depth of several samples" },
    Known { tests: &["inline, Rg11b10Ufloat"], reason: "cannot draw into it" },
    Known {
        tests: &["a_trace_is_json_with_nested_events_on_both_sides", "steps_are_timed_on_cpu_and_gpu"],
        reason: "has no timestamps",
    },
    Known {
        tests: &["the_validation_layers_accept_placed_resources", "the_layers_are_silent_about_whole_frames"],
        reason: "do not detect missing aliasing barriers",
    },
    // Plans are executed on Vulkan only if the validation layers can check them.
    Known {
        tests: &[
            "barriers_of_vulkan_1_0_are_enough",
            "barriers_that_are_left_out_are_reported",
            "broken_loads_differ_from_the_simulation",
            "frames_are_executed_silently_with_the_counts_of_their_plans",
            "frames_on_two_queues_are_silent_and_have_the_contents_of_one",
            "missing_transfers_and_aliasing_barriers_are_detected",
            "post_processing_is_a_subpass_and_its_picture_is_the_reference",
            "random_graphs_leave_the_contents_of_the_simulation",
        ],
        reason: "plans are executed on Vulkan with its layers",
    },
    Known {
        tests: &["docs/guide/vulkan.md", "subpasses_on_vulkan_draw_the_inlined_picture_of_wgpu"],
        reason: "the program needs a Vulkan device",
    },
    // Mesa 22.3 draws all views of multiview into the first layer.
    Known { tests: &["two_eyes_are_drawn_by_the_passes_of_one"], reason: "draws both eyes into the first layer" },
    Known { tests: &["two_eyes_are_drawn_by_the_passes_of_one"], reason: "the device has no multiview" },
    // Only the Vulkan backend places textures in given memory.
    Known {
        tests: &[
            "a_placed_chain_equals_the_unshared_chain",
            "frames_in_one_block_of_memory_are_the_frames_apart",
            "plans_without_driver_sizes_are_rejected",
            "the_validation_layers_accept_placed_resources",
            "the_layers_are_silent_about_whole_frames",
        ],
        reason: "does not support placed textures; use Vulkan",
    },
    Known {
        tests: &[
            "colors_beyond_half_floats_are_held",
            "every_function_of_the_half_build_equals_its_mirror_on_the_device",
            "grading in half floats",
            "highlights_beyond_half_floats_are_kept",
            "lights, half floats",
            "opposite_light_is_finite",
            "pictures_in_half_floats_are_close",
            "the_device_is_as_good_as_the_model",
            "the_distribution_has_the_stated_error",
            "the_textbook_form_and_results_that_are_off_are_found",
        ],
        reason: "has no half floats in shaders",
    },
    // The figures of a document belong to one device.
    Known {
        tests: &[
            "every_function_of_the_half_build_equals_its_mirror_on_the_device",
            "hard_inputs_leave_every_invariant_and_guards_are_missed",
            "pictures_in_half_floats_are_close",
        ],
        reason: ".md are not of",
    },
];

impl Known {
    fn is(&self, skip: &str) -> bool {
        skip.split_once(": ").is_some_and(|(test, why)| self.tests.contains(&test) && why.contains(self.reason))
    }
}

/// Returns the number of allowed skips.
pub fn known_skips() -> usize {
    KNOWN.iter().map(|known| known.tests.len()).sum()
}

impl Reported {
    /// Returns the first problem: a skip that is not allowed, or no adapter.
    pub fn fault(&self) -> Option<String> {
        if self.adapters.is_empty() {
            return Some("no test found an adapter".to_owned());
        }
        let others = self.skips.iter().filter(|skip| !KNOWN.iter().any(|known| known.is(skip))).count();
        (others > 0).then(|| format!("{others} skips are not allowed by xtask/src/tally.rs"))
    }

    /// Returns the number of cases that ran, and the total, over tests that ran only some.
    pub fn cases(&self) -> [usize; 2] {
        self.shares.iter().fold([0, 0], |[ran, all], (_, cases)| [ran + cases[0], all + cases[1]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closing_lines_are_summed_and_others_ignored() {
        let mut totals = Totals::default();
        for line in [
            "running 3 tests",
            "test 5 passed; ... ok",
            "test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.00s",
            "test result: FAILED. 10 passed; 2 failed; 0 ignored; 0 measured; 0 filtered out; finished in 1.25s",
        ] {
            totals.add(line);
        }
        assert_eq!(totals, Totals { runs: 2, passed: 13, failed: 2, ignored: 1 });
    }

    #[test]
    fn skips_and_adapters_are_distinguished() {
        let text = "SKIP: b: no f16\nADAPTER: llvmpipe\n\nCASES: x::c: 3 of 9\nSKIP: a: no EXR\nADAPTER: llvmpipe\nodd\n\
                    CASES: x::c: 1 of 2\nCASES: d: x of 2\nCASES: e: 1 of 5\nRESULT: f: 3 ok\n";
        let reported = Reported::from_text(text);
        assert_eq!(reported.skips, ["CASES: d: x of 2", "a: no EXR", "b: no f16", "odd"]);
        assert_eq!(reported.results, ["f: 3 ok"]);
        assert_eq!(reported.cases(), [5, 16]);
        assert_eq!(reported.shares.into_iter().collect::<Vec<_>>(), [("e".into(), [1, 5]), ("x::c".into(), [4, 11])]);
        assert_eq!(reported.adapters.into_iter().collect::<Vec<_>>(), ["llvmpipe"]);
        assert_eq!(Reported::from_text(""), Reported::default());
    }

    #[test]
    fn skips_that_are_not_known_and_no_adapter_are_faults() {
        let with = |skips: &str| Reported::from_text(&format!("ADAPTER: llvmpipe\n{skips}")).fault();
        assert_eq!(with(""), None);
        assert_eq!(with("SKIP: a_window_is_drawn_into: there is no Xvfb to open a window on\n"), None);
        assert_eq!(with("SKIP: opposite_light_is_finite: llvmpipe has no half floats in shaders\n"), None);
        let elsewhere = "hard_inputs_leave_every_invariant_and_guards_are_missed: the figures of docs/measurements/hard-cases.md are not of it";
        assert_eq!(with(&format!("SKIP: {elsewhere}\n")), None);
        // A wrong test, a wrong reason, and a test that lost its adapter.
        for skip in [
            "b: there is no Xvfb",
            "a_window_is_drawn_into: it is late",
            "c: no adapter",
            "half: half of it",
            "f16: llvmpipe has no half floats in shaders",
        ] {
            assert!(with(&format!("SKIP: {skip}\n")).is_some_and(|fault| fault.starts_with("1 skips")), "{skip}");
        }
        let none = Reported::from_text("SKIP: a_window_is_drawn_into: there is no Xvfb to open a window on\n");
        assert_eq!(none.fault().as_deref(), Some("no test found an adapter"));
    }

    /// Removed tests must not stay in the list.
    #[test]
    fn every_known_skip_is_one_of_a_test() {
        let rooms = [
            "framegraph/tests",
            "renderer/src",
            "renderer/tests",
            "scene/src",
            "tests/tests",
            "examples",
            "viewer",
            "vulkan",
        ];
        let root = crate::workspace::root();
        let mut folders: Vec<_> = rooms.iter().map(|room| root.join(room)).collect();
        let mut texts = String::new();
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(&folder).expect("a folder of the repository").flatten() {
                let path = entry.path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|ending| ending == "rs") {
                    texts += &std::fs::read_to_string(&path).expect("a source");
                }
            }
        }
        for Known { tests, reason } in KNOWN {
            let file = reason.rsplit('/').next().unwrap_or(reason);
            assert!(texts.contains(file), "{reason}");
            for test in tests {
                // Some names end with the name of a case.
                let (name, case) = test.split_once(", ").unwrap_or((test, ""));
                assert!(texts.contains(name) && texts.contains(case), "{test}: {reason}");
            }
        }
    }
}
