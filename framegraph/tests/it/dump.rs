//! Plans as text and graphics: their content, and validity of the formats.

mod graph;
mod json;
mod svg;

use crate::support::*;
use framegraph::*;
use framegraph_check::check;
use framegraph_check::generate::{self, Entropy, Profile};

/// Returns a frame with a depth prepass, a scene over it, an unused pass, and tone mapping into the screen.
pub fn frame() -> Graph {
    let mut g = Graph::new();
    let out = screen(&mut g);
    let z = g.texture("depth", depth());
    let z = g.add_fn("prepass", |p| p.depth(z, FAR)).unwrap();
    let scene = g.texture("hdr", hdr());
    let scene = g
        .add_fn("scene", |p| {
            p.depth_read_only(z)?;
            p.color(scene, BLACK)
        })
        .unwrap();
    let _ = filter(&mut g, "idle", scene, Format::R8Unorm);
    g.add_fn("tonemap", |p| {
        p.sampled(scene)?;
        p.color(out, Intent::Overwrite)
    })
    .unwrap();
    g
}

/// Returns plans of random graphs for each preset.
pub fn random_plans(count: u64) -> Vec<Plan> {
    let mut plans = Vec::new();
    for seed in 0..count {
        let graph = generate::graph(&mut Entropy::seeded(seed), &Profile::default());
        for caps in Caps::PRESETS.iter().filter_map(|name| Caps::preset(name)) {
            let options = Options {
                frame: generate::FRAME,
                alias: if seed % 2 == 0 { Alias::Heap } else { Alias::Pool },
                ..Options::default()
            };
            let mut plan = Plan::new();
            if compile(&graph, &caps, &options, &mut Scratch::new(), &mut plan).is_ok() {
                plans.push(plan);
            }
        }
    }
    assert!(plans.len() as u64 > count, "only {} plans", plans.len());
    plans
}

/// Notes appear in the text and in JSON, with the names of their scopes, and change the plan. They are removed when the
/// graph is reset.
#[test]
fn notes_are_told() {
    let mut g = frame();
    let plain = g.clone();
    g.scope("left", |g| g.note("glow", format_args!("asked for, {} wide\n", 3)));
    g.note("mist", "left out: nothing is far away");
    assert!(!g.same_as(&plain));
    let plan = plan(&g, &wgpu());
    let text = dump::text(&plan);
    let expected = "decisions:\n  effect `left/glow`: asked for, 3 wide\\n\n  effect `mist`: left out: nothing is far away\n  pass";
    assert!(text.contains(expected), "{text}");
    let value: serde_json::Value = serde_json::from_str(&dump::json(&plan, "")).expect("JSON");
    assert_eq!(value["notes"][1]["about"], "mist");
    assert_eq!(value["notes"][0]["sentence"], "asked for, 3 wide\n");
    g.reset();
    assert_eq!(g.notes().len(), 0);
}

/// Compares every byte of the text with a plan derived by hand. Depth and hdr share a step. Depth is cleared by the
/// prepass, tested by the scene, and never leaves the tile. With 64 × 32 texels, hdr has 16384 bytes and depth 8192.
#[test]
fn text_is_the_golden_format() {
    let expected = "\
plan 2 for wgpu at 64x32
counts: 0 loads, 2 stores, 2 clears, 1 discards, 0 multisample resolves, 1 memoryless, 0 inlined, 2 steps, 3 passes, 1 culled
traffic: 0 B loaded, 24576 B stored
memory: 16384 B of 16384 B unaliased, lower bound 16384 B, optimal; 8192 B avoided, 0 B outlive the frame

steps:
  0 raster 64x32 samples 1
    pass prepass
    pass scene (merged: attachments)
    color 0: hdr clear -> store
    depth: depth clear -> discard
  1 raster 64x32 samples 1
    pass tonemap
      read sampled hdr
    color 0: screen dont_care -> store

resources:
  screen: 64x32 Rgba8UnormSrgb, steps 1..1, attachment, 8.0 KiB, imported
  depth: 64x32 Depth32Float, steps 0..0, attachment, 8.0 KiB, memoryless
  hdr: 64x32 Rgba16Float, steps 0..1, attachment+sampled, 16.0 KiB, slot 0
  idle_out: 64x32 R8Unorm, unused

decisions:
  pass `prepass`: kept because `scene` reads `depth`
  pass `scene`: kept because `tonemap` reads `hdr`
  pass `idle`: culled because no pass reads `idle_out`
  pass `tonemap`: kept because it writes `screen`, which is imported with `Exit::Keep`
  pass `scene`: merged with `prepass`: same attachments
  pass `tonemap`: not merged with `scene`: the later one samples a texture that the step writes; declare a `same_pixel` read if it reads only its own texel
  load of `hdr` in step 0: cleared
  load of `depth` in step 0: cleared
  load of `screen` in step 1: don't care: every texel is written
  store of `hdr` in step 0: stored because `tonemap` reads it
  store of `depth` in step 0: discarded because no later pass reads it
  store of `screen` in step 1: stored because it is imported with `Exit::Keep`
  resource `depth`: needs no memory because it is used in one step only
  resource `screen`: owned outside of the graph
  resource `idle_out`: no kept pass accesses it
  resource `hdr`: first resource in its slot
";
    assert_eq!(dump::text(&plan(&frame(), &wgpu())), expected);
}

#[test]
fn text_names_parts_and_barriers() {
    let mut g = Graph::new();
    let t = g.texture("t", color(Format::R32Float).mips(3).layers(2));
    let t = g.add_fn("write", |p| p.storage_write(t.mip(1).layer(0), Intent::Overwrite)).unwrap();
    g.add_fn("read", |p| {
        p.side_effect();
        p.sampled(t.mip(1).layer(0))
    })
    .unwrap();
    let text = dump::text(&plan(&g, &Caps::desktop()));
    for line in [
        "      overwrite storage_write t mip 1 layer 0\n",
        "      read sampled t mip 1 layer 0\n",
        // Part (0 · 2 + 0) · 3 + 1 of six.
        "  before step 1: t parts 1..2 Storage -> Sampled, [compute] -> [compute] after step 0\n",
    ] {
        assert!(text.contains(line), "{text}\nlacks {line}");
    }
}

#[test]
fn every_form_is_reproducible() {
    let forms =
        |plan: &Plan| [dump::text(plan), dump::dot(plan), dump::mermaid(plan), dump::svg(plan), dump::json(plan, "f")];
    let (a, b) = (plan(&frame(), &Caps::tiler()), plan(&frame(), &Caps::tiler()));
    assert_eq!(forms(&a), forms(&b));
    let other = plan(&frame(), &Caps::desktop());
    for (a, other) in forms(&a).iter().zip(&forms(&other)) {
        assert_ne!(a, other);
    }
}

/// A frame whose names contain every special character of the formats.
pub fn hostile() -> Graph {
    let mut g = Graph::new();
    for name in
        ["\"quoted\"", "a<b>&'c'", "back\\slash", "line\nend\t\u{1}", "#35;`|]", "%%{init}%%", "ü 漢 \u{FFFF}", ""]
    {
        let t = g.texture(name, hdr());
        let t = g.add_fn(name, |p| p.color(t, BLACK)).unwrap();
        let out = filter(&mut g, name, t, Format::R8Unorm);
        g.export(out).unwrap();
    }
    g
}

#[test]
fn dot_mermaid_and_text_keep_names_in_their_places() {
    let p = plan(&hostile(), &wgpu());
    for line in dump::dot(&p).lines() {
        let bare = line.replace("\\\\", "").replace("\\\"", "");
        assert_eq!(bare.matches('"').count() % 2, 0, "{line}");
    }
    for line in dump::mermaid(&p).lines() {
        assert!(line.matches('"').count() % 2 == 0 && line.matches('"').count() <= 2, "{line}");
        let label = line.split('"').nth(1).unwrap_or_default().replace("<br/>", "");
        assert!(!label.contains(['<', '>', '`', '|', '%']), "{line}");
        assert!(!line.contains("[\"\"") && !line.contains("|\"\"|"), "Mermaid does not accept empty labels: {line}");
    }
    let (text, kinds) = (dump::text(&p), ["  ", "plan ", "counts: ", "traffic: ", "memory: "]);
    let heads = ["", "steps:", "resources:", "barriers:", "decisions:"];
    for line in text.lines() {
        assert!(heads.contains(&line) || kinds.iter().any(|k| line.starts_with(k)), "a name breaks the line: {line}");
        assert!(!line.contains(char::is_control), "{line:?}");
    }
    assert!(text.contains(r"`line\nend\t\u{1}`"), "{text}");
}

#[test]
fn mermaid_arrows_join_passes_that_it_draws() {
    for p in random_plans(40) {
        let text = dump::mermaid(&p);
        let drawn: Vec<_> =
            text.lines().filter_map(|l| l.trim_start().strip_prefix('p')?.split_once('[').map(|(n, _)| n)).collect();
        assert_eq!(drawn.len(), p.graph().passes().len(), "{text}");
        for line in text.lines().filter(|l| l.contains("->|")) {
            let ends: Vec<_> = line.split(|c: char| !(c.is_alphanumeric() || c == 'p')).collect();
            let named = |end: &&&str| end.starts_with('p') && drawn.contains(&&end[1..]);
            assert!(ends.iter().filter(named).count() >= 2, "{line}\n{text}");
        }
        assert_eq!(text.matches("subgraph").count(), p.steps().len());
        assert_eq!(text.lines().filter(|l| l.trim() == "end").count(), p.steps().len());
    }
}

#[test]
fn a_refused_plan_reads_as_an_empty_one() {
    let mut bad = Graph::new();
    let (z, out) = (bad.texture("z", depth()), screen(&mut bad));
    bad.add_fn("show", |p| {
        p.sampled(z)?;
        p.color(out, Intent::Overwrite)
    })
    .unwrap();
    let good = plan(&frame(), &wgpu());
    // Into a new plan, and into one that contains another frame.
    for mut refused in [Plan::new(), good.clone()] {
        let outcome = compile(&bad, &wgpu(), &options(), &mut Scratch::new(), &mut refused);
        assert!(outcome.is_err(), "no pass writes the resource that is read");
        assert!(refused.graph().passes().is_empty() && refused.steps().is_empty() && refused.decisions().is_empty());
        assert!(dump::text(&refused).starts_with("plan 2 for wgpu at 64x32\ncounts: 0 loads, 0 stores,"));
        let totals = dump::totals(&refused);
        assert!(totals.iter().all(|(_, count)| *count == 0), "{totals:?}");
        assert!(dump::json(&refused, "refused").contains("\"passes\": []"));
        assert!(dump::dot(&refused).starts_with("digraph plan {") && dump::mermaid(&refused).starts_with("flowchart"));
        roxmltree::Document::parse(&dump::svg(&refused)).expect("the image is XML");
        assert_eq!(dump::graph::bipartite(refused.graph()).node_count(), 0);
        assert!(diff(&refused, &good).to_string().contains("prepass"));
        assert!(!diff(&good, &refused).json().is_empty());
        assert!(check(&refused).is_err(), "an empty plan is not valid");
    }
}
