//! Loops and templates, and errors in them.

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
fn a_template_repeats_as_often_as_it_is_told() {
    // A mip chain down and up again: both loops take their bounds from the use.
    let text = r#"(version: 1,
        templates: {"chain": (params: ["last"], passes: [
            Each(index: "i", from: 1, count: "{last}", entries: [Raster(name: "down {i}", accesses: [
                Sampled(of: "chain", mip: "{i-1}"), Color(to: "chain", mip: "{i}", intent: Overwrite),
            ])]),
            Each(index: "i", from: "{last-1}", count: "{last}", step: -1, entries: [Raster(name: "up {i}", accesses: [
                Sampled(of: "chain", mip: "{i+1}"), Color(to: "chain", mip: "{i}", intent: Modify),
            ])]),
        ])},
        resources: [Texture(name: "chain", format: Rgba16Float, mips: 4)],
        passes: [
            Raster(name: "top", accesses: [Color(to: "chain", mip: 0, intent: Overwrite)]),
            Use(template: "chain", with: {"last": 3}),
        ],
        exports: [Keep(of: "chain")],
    )"#;
    let graph = graph(text);
    let names: Vec<_> = graph.pass_ids().map(|p| graph.pass_name(p)).collect();
    assert_eq!(names, ["top", "down 1", "down 2", "down 3", "up 2", "up 1", "up 0"]);
    let last: Vec<_> = graph.accesses().iter().rev().take(2).map(|access| access.range.mip).collect();
    assert_eq!(last, [0, 1], "the last pass reads level 1 and draws into level 0");
}

#[test]
fn exports_loop() {
    let text = |exports: &str| {
        format!(
            r#"(version: 1,
            resources: [
                Texture(name: "a0", format: R8Unorm), Texture(name: "a1", format: R8Unorm),
                Texture(name: "b0", format: R8Unorm), Texture(name: "b1", format: R8Unorm),
                Texture(name: "atlas", format: R8Unorm, layers: 2, kind: Import(entry: Undefined, exit: Keep)),
            ],
            passes: [Each(index: "i", count: 2, entries: [
                Raster(name: "a{{i}}", accesses: [Color(to: "a{{i}}", intent: Overwrite)]),
                Raster(name: "b{{i}}", accesses: [Color(to: "b{{i}}", intent: Overwrite)]),
            ])],
            exports: [{exports}],
        )"#
        )
    };
    let looped = r#"Each(index: "i", count: 2, entries: [
        Keep(of: "a{i}"), Forward(of: "b{i}", to: "atlas", layer: "{i}"),
    ])"#;
    let plain = r#"Keep(of: "a0"), Forward(of: "b0", to: "atlas", layer: 0), Keep(of: "a1"),
        Forward(of: "b1", to: "atlas", layer: 1)"#;
    assert!(graph(&text(looped)).same_as(&graph(&text(plain))));
    assert_eq!(graph(&text(looped)).exports().len(), 2);
    assert!(!graph(&text(looped)).same_as(&graph(&text(&plain.replace("layer: 1", "layer: 0")))));
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
        (each(r#"Compute(name: "p{j}")"#), "unknown name in braces `j`; use one of `i`"),
        (each(r#"Compute(name: "p{i*2}")"#), "unknown name in braces `i*2`"),
        (each(r#"Compute(name: "p")"#), "more than one pass is named `p`"),
        (
            each(r#"Raster(name: "p{i}", accesses: [Color(to: "a", mip: "{i-1}", intent: Overwrite)])"#),
            "`-1` is not a number from 0 to 254",
        ),
        ("(version: 1, passes: [Use(template: \"t\")])".into(), "unknown template `t`"),
        (
            r#"(version: 1, templates: {"t": (params: ["a"])}, passes: [Use(template: "t")])"#.into(),
            "the template requires the parameter `a`; add",
        ),
        (
            r#"(version: 1, templates: {"t": (params: ["a"])}, passes: [Use(template: "t", with: {"a": "", "b": ""})])"#.into(),
            "unknown parameter `b`",
        ),
        (
            r#"(version: 1, templates: {"t": (passes: [Use(template: "t")])}, passes: [Use(template: "t")])"#.into(),
            "a template uses another template",
        ),
        (
            r#"(version: 1, templates: {"t": (passes: [Each(index: "i", count: 1, entries: [
                Each(index: "j", count: 2, entries: [Use(template: "t")])])])}, passes: [Use(template: "t")])"#
                .replace('\n', " "),
            "a template uses another template",
        ),
        (
            r#"(version: 1, templates: {"a": (), "b": (passes: [Each(index: "i", count: 1, entries: [Use(template: "a")])])},
                passes: [Use(template: "b"), Use(template: "b")])"#
                .replace('\n', " "),
            "a template uses another template",
        ),
        (
            r#"(version: 1, templates: {"t": (params: ["n"], passes: [Each(index: "i", count: "{n}", entries: [])])},
                passes: [Use(template: "t", with: {"n": "few"})])"#
                .replace('\n', " "),
            "`few` is not a number from 0 to 4294967295",
        ),
        (each(r#"Each(index: "j", from: "{i-1}", count: 1, entries: [])"#), "`-1` is not a number from 0 to 4294967295"),
        (
            r#"(version: 1, exports: [Each(index: "i", count: 2, entries: [Keep(of: "a{j}")])])"#.into(),
            "unknown name in braces `j`",
        ),
        (each(r#"Each(index: "j", count: 4000000000, entries: [Compute(name: "{i} {j}")])"#), "more than 131072 entries"),
    ];
    for (text, expected) in cases {
        let errors = refused(&text);
        assert!(errors.contains(expected), "{text}\n{errors}\nlacks {expected}");
        assert!(errors.lines().all(|line| line.starts_with("t.ron:1:") || line.starts_with("and ")), "{errors}");
    }
}

/// Returns a reader of files by path.
fn read<'f>(files: &'f [(&str, &str)]) -> impl FnMut(&str) -> Result<String, String> + 'f {
    |path| {
        let found = files.iter().find(|(known, _)| *known == path);
        found.map(|(_, text)| (*text).to_owned()).ok_or_else(|| format!("there is no file {path}"))
    }
}

#[test]
fn files_are_included_once_and_in_front() {
    let main = r#"(version: 1, include: ["b.ron", "parts/a.ron"], features: {"fxaa": true}, name: "main", passes: [
        Raster(name: "own", when: "fxaa", accesses: [Sampled(of: "a"), Color(to: "screen", intent: Overwrite)]),
    ])"#;
    let files = [
        (
            "x/parts/a.ron",
            r#"(version: 1, include: ["c.ron"], name: "a", features: {"fxaa": false}, passes: [
            Raster(name: "draw", accesses: [Color(to: "a", intent: Overwrite)]),
        ])"#,
        ),
        ("x/parts/c.ron", r#"(version: 1, resources: [Texture(name: "a", format: R8Unorm)])"#),
        (
            "x/b.ron",
            r#"(version: 1, include: ["parts/a.ron"], resources: [
            Texture(name: "screen", format: R8Unorm, kind: Import(entry: Undefined, exit: Keep)),
        ])"#,
        ),
    ];
    let included = Included::load("x/main.ron", main, read(&files)).unwrap_or_else(|e| panic!("{e}"));
    let file = GraphFile::parse_with("x/main.ron", main, &included).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((file.name(), file.features()), ("main", [("fxaa".to_owned(), true)].as_slice()));
    let graph = file.graph(&[]).unwrap();
    let names: Vec<_> = graph.resource_ids().map(|r| graph.resource_name(r)).collect();
    let passes: Vec<_> = graph.pass_ids().map(|p| graph.pass_name(p)).collect();
    assert_eq!((names, passes), (vec!["a", "screen"], vec!["draw", "own"]));
}

#[test]
fn what_is_wrong_in_an_included_file_stands_there() {
    let main = r#"(version: 1, include: ["a.ron"])"#;
    let load = |main: &str, a: &str| {
        let files = [("a.ron", a)];
        let included = Included::load("m.ron", main, read(&files))?;
        GraphFile::parse_with("m.ron", main, &included)?.graph(&[]).map(drop)
    };
    let message = |main: &str, a: &str| load(main, a).expect_err("it is wrong").to_string();
    let wrong = "(version: 1,\n passes: [Raster(name: \"p\", accesses: [Sampled(of: \"b\")])])";
    assert!(message(main, wrong).starts_with("a.ron:2:52: unknown resource `b`"), "{}", message(main, wrong));
    assert!(message(main, "(version: 1, x: 1)").starts_with("a.ron:1:14: "));
    assert!(message(main, "(version: 2)").starts_with("a.ron:1:11: the file has version 2"));
    assert!(
        message(r#"(version: 1, include: ["c.ron"])"#, "")
            .contains("m.ron:1:24: the file cannot be included: there is no file")
    );
    for path in ["../a.ron", "/etc/passwd", "a//b.ron", "", "c:\\\\a.ron", "./a.ron"] {
        let main = format!("(version: 1, include: [\"{path}\"])");
        assert!(message(&main, "").contains("outside of the folder"), "{path}: {}", message(&main, ""));
    }
    // A file that includes itself, or the file that includes it, is read once.
    assert!(load(main, r#"(version: 1, include: ["a.ron", "m.ron"])"#).is_ok());
    let alone = GraphFile::parse("m.ron", main).expect_err("nothing was read");
    assert!(alone.to_string().starts_with("m.ron:1:24: the file cannot be included"), "{alone}");
}
