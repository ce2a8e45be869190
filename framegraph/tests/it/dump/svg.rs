//! The SVG is self-contained XML with the expected content.

use super::{frame, hostile, random_plans};
use crate::support::*;
use framegraph::*;
use roxmltree::{Document, Node};

fn texts(document: &Document<'_>) -> Vec<String> {
    let is = |n: &Node<'_, '_>| n.has_tag_name(("http://www.w3.org/2000/svg", "text"));
    let text = |n: Node<'_, '_>| n.text().unwrap_or_default().to_owned();
    document.descendants().filter(is).map(text).collect()
}

#[test]
fn every_picture_is_well_formed_and_stands_alone() {
    for plan in random_plans(30).iter().chain([&plan(&hostile(), &wgpu())]) {
        let svg = dump::svg(plan);
        let document = Document::parse(&svg).unwrap_or_else(|e| panic!("{e}\n{svg}"));
        for node in document.descendants().filter(Node::is_element) {
            let name = node.tag_name().name();
            let known = ["svg", "style", "rect", "path", "text", "title"];
            assert!(known.contains(&name), "{name}");
            for attribute in node.attributes() {
                assert!(!attribute.name().contains("href") && !attribute.value().contains("url("));
            }
        }
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }
}

/// All shapes lie within the image.
#[test]
fn everything_is_inside_of_the_picture() {
    let number = |n: &Node<'_, '_>, what: &str| n.attribute(what).and_then(|v| v.parse::<f64>().ok());
    for plan in random_plans(30) {
        let svg = dump::svg(&plan);
        let document = Document::parse(&svg).expect("well-formed");
        let root = document.root_element();
        let (w, h) = (number(&root, "width").expect("a width"), number(&root, "height").expect("a height"));
        for node in document.descendants().filter(|n| n.has_tag_name(("http://www.w3.org/2000/svg", "rect"))) {
            let value = |what| number(&node, what).unwrap_or(0.0);
            let (right, bottom) = (value("x") + value("width"), value("y") + value("height"));
            assert!(right <= w && bottom <= h && value("x") >= 0.0 && value("y") >= 0.0, "{svg}");
            assert!(value("width") > 0.0 && value("height") > 0.0, "{svg}");
        }
    }
}

#[test]
fn the_picture_names_steps_resources_and_what_was_culled() {
    let svg = dump::svg(&plan(&frame(), &wgpu()));
    let document = Document::parse(&svg).expect("well-formed");
    let texts = texts(&document);
    let has = |wanted: &str| texts.iter().any(|t| t == wanted);
    for wanted in ["plan for wgpu at 64×32", "prepass +scene", "tonemap", "depth", "hdr", "memoryless", "imported"] {
        assert!(has(wanted), "{wanted} is not in {texts:?}");
    }
    assert!(has("idle: culled because no pass reads `idle_out`"));
    // Tooltips contain the reason.
    assert!(svg.contains("store: stored because `tonemap` reads it"));
}

#[test]
fn a_plan_without_steps_is_a_picture_too() {
    for graph in [Graph::new(), {
        let mut g = Graph::new();
        let _ = filtered_nothing(&mut g);
        g
    }] {
        let svg = dump::svg(&plan(&graph, &wgpu()));
        Document::parse(&svg).expect("well-formed");
        assert!(svg.contains("no resource uses shared memory"));
    }
}

/// A pass that is culled, so that the plan has no step.
fn filtered_nothing(g: &mut Graph) -> Texture {
    let t = g.texture("t", hdr());
    g.add_fn("unread", |p| p.color(t, BLACK)).unwrap()
}
