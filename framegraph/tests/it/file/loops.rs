//! Loops and templates: one entry that stands for several, and what is wrong with them.

use super::refused;
use framegraph::file::*;
use framegraph::*;

fn graph(text: &str) -> Graph {
    let file = GraphFile::parse("l.ron", text).unwrap_or_else(|e| panic!("{e}"));
    file.graph(&[]).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn a_chain_of_levels_is_one_entry() {
    let looped = r#"(version: 1,
        resources: [Texture(name: "chain", format: Rgba16Float, mips: 4)],
        passes: [
            Raster(name: "top", accesses: [Color(to: "chain", mip: 0, intent: Overwrite)]),
            Each(index: "i", from: 1, count: 3, entries: [
                Raster(name: "down {i}", accesses: [
                    Sampled(of: "chain", mip: "{i-1}"),
                    Color(to: "chain", mip: "{i}", intent: Overwrite),
                ]),
            ]),
        ],
        exports: [Keep(of: "chain")],
    )"#;
    let pass = |i: u32| {
        let above = i - 1;
        format!(
            r#"Raster(name: "down {i}", accesses: [
                Sampled(of: "chain", mip: {above}), Color(to: "chain", mip: {i}, intent: Overwrite),
            ]),"#
        )
    };
    let begin = looped.find("Each").unwrap();
    let end = looped.find("        ],\n        exports").unwrap();
    let plain = [&looped[..begin], &pass(1), &pass(2), &pass(3), &looped[end..]].concat();
    assert!(graph(looped).same_as(&graph(&plain)));
    assert_eq!(graph(looped).passes().len(), 4);
}

#[test]
fn loops_nest_and_make_resources() {
    let text = r#"(version: 1,
        resources: [Each(index: "v", count: 2, entries: [
            Each(index: "l", count: 3, entries: [Texture(name: "view {v} level {l}", format: R8Unorm)]),
        ])],
        passes: [Each(index: "v", count: 2, entries: [
            Each(index: "l", count: 3, entries: [
                Raster(name: "{v}.{l}", accesses: [Color(to: "view {v} level {l}", intent: Overwrite)]),
            ]),
        ])],
    )"#;
    let graph = graph(text);
    let names: Vec<_> = graph.pass_ids().map(|p| graph.pass_name(p)).collect();
    assert_eq!(names, ["0.0", "0.1", "0.2", "1.0", "1.1", "1.2"]);
    assert_eq!(graph.resource_name(graph.accesses()[5].resource), "view 1 level 2");
}

#[test]
fn a_template_is_used_twice() {
    let text = r#"(version: 1,
        templates: {"copy": (params: ["from", "to"], passes: [
            Raster(name: "{from} to {to}", accesses: [Sampled(of: "{from}"), Color(to: "{to}", intent: Overwrite)]),
        ])},
        resources: [Each(index: "i", count: 3, entries: [Texture(name: "t{i}", format: R8Unorm)])],
        passes: [
            Raster(name: "first", accesses: [Color(to: "t0", intent: Overwrite)]),
            Use(template: "copy", with: {"from": "t0", "to": "t1"}),
            Use(template: "copy", with: {"from": "t1", "to": "t2"}),
        ],
    )"#;
    let graph = graph(text);
    let names: Vec<_> = graph.pass_ids().map(|p| graph.pass_name(p)).collect();
    assert_eq!(names, ["first", "t0 to t1", "t1 to t2"]);
}

#[test]
fn braces_outside_of_loops_mean_nothing() {
    let text = r#"(version: 1, resources: [Texture(name: "a{i}", format: R8Unorm)])"#;
    assert_eq!(graph(text).find_resource("a{i}").map(ResourceId::index), Some(0));
}

#[test]
fn what_is_wrong_with_a_loop_has_its_place() {
    let each = |inside: &str| format!("(version: 1, passes: [Each(index: \"i\", count: 2, entries: [{inside}])])");
    let cases = [
        (each(r#"Compute(name: "p{j}")"#), "there is no name in braces `j`; there are `i`"),
        (each(r#"Compute(name: "p{i*2}")"#), "there is no name in braces `i*2`"),
        (each(r#"Compute(name: "p")"#), "more than one pass is called `p`"),
        (
            each(r#"Raster(name: "p{i}", accesses: [Color(to: "a", mip: "{i-1}", intent: Overwrite)])"#),
            "`-1` is no level or layer",
        ),
        ("(version: 1, passes: [Use(template: \"t\")])".into(), "there is no template `t`"),
        (
            r#"(version: 1, templates: {"t": (params: ["a"])}, passes: [Use(template: "t")])"#.into(),
            "the template needs the parameter `a`; add",
        ),
        (
            r#"(version: 1, templates: {"t": (params: ["a"])}, passes: [Use(template: "t", with: {"a": "", "b": ""})])"#.into(),
            "there is no parameter `b`",
        ),
        (
            r#"(version: 1, templates: {"t": (passes: [Use(template: "t")])}, passes: [Use(template: "t")])"#.into(),
            "a template uses a template",
        ),
        (each(r#"Each(index: "j", count: 4000000000, entries: [Compute(name: "{i} {j}")])"#), "more than 131072 entries"),
    ];
    for (text, expected) in cases {
        let errors = refused(&text);
        assert!(errors.contains(expected), "{text}\n{errors}\nlacks {expected}");
        assert!(errors.lines().all(|line| line.starts_with("t.ron:1:") || line.starts_with("and ")), "{errors}");
    }
}
