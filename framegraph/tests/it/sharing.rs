//! Plans share the arrays of their graph: nothing is copied, and changes are not visible to the other.

use crate::support::*;
use framegraph::*;

fn one_pass(g: &mut Graph, name: &str) -> Texture {
    let t = g.texture("t", hdr());
    let t = g.add_fn(name, |p| p.color(t, BLACK)).unwrap();
    g.export(t).unwrap();
    t
}

fn names(graph: &Graph) -> Vec<&str> {
    graph.pass_ids().map(|p| graph.pass_name(p)).collect()
}

fn compiled(g: &Graph) -> Plan {
    let mut plan = Plan::new();
    compile(g, &wgpu(), &Options::for_frame(64, 64), &mut Scratch::new(), &mut plan).unwrap();
    plan
}

#[test]
fn compiling_copies_nothing() {
    let mut g = Graph::new();
    one_pass(&mut g, "a");
    let plan = compiled(&g);
    assert!(std::ptr::eq(plan.graph().passes(), g.passes()));
    let copy = g.clone();
    assert!(std::ptr::eq(copy.passes(), g.passes()) && copy.same_as(&g));
}

#[test]
fn a_plan_keeps_what_it_was_made_from() {
    let mut g = Graph::new();
    let t = one_pass(&mut g, "a");
    let plan = compiled(&g);
    // Without a reset, the graph continues with a copy that accepts its handles.
    g.add_fn("b", |p| p.sampled(t).map(drop)).unwrap();
    assert_eq!((names(plan.graph()), names(&g)), (vec!["a"], vec!["a", "b"]));
    assert!(!g.same_as(plan.graph()));
    let later = compiled(&g);
    g.reset();
    one_pass(&mut g, "c");
    assert_eq!((names(plan.graph()), names(later.graph()), names(&g)), (vec!["a"], vec!["a", "b"], vec!["c"]));
    drop(g);
    assert_eq!(names(later.graph()), ["a", "b"]);
}

#[test]
fn two_sets_of_arrays_take_turns() {
    let mut g = Graph::new();
    let mut plan = Plan::new();
    let mut seen = Vec::new();
    for _ in 0..6 {
        g.reset();
        one_pass(&mut g, "a");
        compile(&g, &wgpu(), &Options::for_frame(64, 64), &mut Scratch::new(), &mut plan).unwrap();
        seen.push(g.passes().as_ptr());
    }
    assert_ne!(seen[0], seen[1]);
    assert_eq!(seen[..2], seen[2..4]);
    assert_eq!(seen[..2], seen[4..]);
}

#[test]
fn an_unchanged_graph_hands_its_handles_to_the_plan() {
    let mut g = Graph::new();
    let mut plan = Plan::new();
    let old = one_pass(&mut g, "a");
    let (caps, options, mut scratch) = (wgpu(), Options::for_frame(64, 64), Scratch::new());
    assert_eq!(recompile(&g, &caps, &options, &mut scratch, &mut plan), Ok(true));
    g.reset();
    let new = one_pass(&mut g, "a");
    assert_eq!(plan.graph().resource_of(new), None);
    assert_eq!(recompile(&g, &caps, &options, &mut scratch, &mut plan), Ok(false));
    assert!(plan.graph().resource_of(new).is_some() && plan.graph().resource_of(old).is_none());
}

#[test]
fn a_copy_and_its_original_part_at_the_first_change() {
    let mut g = Graph::new();
    let t = one_pass(&mut g, "a");
    let mut copy = g.clone();
    copy.add_fn("b", |p| p.sampled(t).map(drop)).unwrap();
    assert_eq!((names(&g), names(&copy)), (vec!["a"], vec!["a", "b"]));
    copy.reset();
    let foreign = one_pass(&mut copy, "c");
    assert!(g.add_fn("d", |p| p.sampled(foreign).map(drop)).is_err());
    g.add_fn("d", |p| p.sampled(t).map(drop)).unwrap();
}
