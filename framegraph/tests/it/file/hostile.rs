//! Files that try to break their reader: long, deeply nested, full of errors, or with control characters in names.

use super::{file, refused};
use framegraph::file::*;
use framegraph::*;

/// Returns the errors of declaring and compiling a file.
fn wrong(text: &str) -> FileErrors {
    let parsed = GraphFile::parse("t.ron", text).unwrap_or_else(|e| panic!("{e}"));
    let (caps, options) = (crate::support::wgpu(), Options::default());
    let (mut graph, mut plan, registry) = (Graph::new(), Plan::new(), Registry::new());
    let outcome = parsed.plan(&[], &registry, &mut graph, (&caps, &options), &mut Scratch::new(), &mut plan);
    assert!(plan.steps().is_empty() && plan.graph().passes().is_empty(), "the plan is not empty");
    outcome.expect_err("the file is valid")
}

#[test]
fn a_long_cycle_takes_no_stack() {
    let passes: String = (0..20_000)
        .map(|i| format!("Compute(name: \"p{i}\", flags: [SideEffect], after: [\"p{}\"]),", (i + 1) % 20_000))
        .collect();
    let text = file("", &passes, "");
    // A recursive search would overflow this stack many times.
    let thread = std::thread::Builder::new().stack_size(1 << 20).spawn(move || refused(&text)).unwrap();
    let errors = thread.join().expect("the stack suffices");
    assert!(errors.contains("depend on each other") && errors.contains("and 19988 more"), "{errors}");
    assert!(errors.len() < 1000);
}

#[test]
fn many_errors_are_a_hundred_and_a_number() {
    let texture = r#"Texture(name: "a", format: R8Unorm), Texture(name: "b", format: R8Unorm)"#;
    let many = |accesses: &str| -> String {
        (0..3000).map(|i| format!("Raster(name: \"p{i}\", flags: [SideEffect], accesses: [{accesses}]),\n")).collect()
    };
    for accesses in [
        // Errors of compiling, of looking up names, and of declaring.
        r#"Sampled(of: "a"), Color(to: "b", intent: Overwrite)"#,
        r#"Color(to: "c", intent: Overwrite)"#,
        r#"Color(to: "b", intent: Overwrite, mip: 3)"#,
    ] {
        let errors = wrong(&file(texture, &many(accesses), ""));
        assert_eq!((errors.listed.len(), errors.more), if accesses.contains("mip") { (1, 0) } else { (100, 2900) });
        assert_eq!(errors.to_string().ends_with("and 2900 more errors, not listed"), errors.more != 0);
    }
}

#[test]
fn errors_of_declaring_and_of_compiling_stand_together() {
    let text = file(
        r#"Texture(name: "a", format: R8Unorm), Texture(name: "b", format: R8Unorm), Texture(name: "c", format: R8Unorm),
           Texture(name: "wide", format: R8Unorm, size: Texels(99999, 1))"#,
        r#"
        Raster(name: "bad", accesses: [Color(to: "a", intent: Overwrite), Sampled(of: "a")]),
        Raster(name: "typo", accesses: [Sampled(of: "bb"), Color(to: "c", intent: Overwrite)]),
        Raster(name: "after", flags: [SideEffect], accesses: [Sampled(of: "a"), Sampled(of: "c")]),
        Raster(name: "early", flags: [SideEffect], accesses: [Sampled(of: "b")]),
        "#,
        r#"Keep(of: "a")"#,
    );
    let lines = wrong(&text).to_string();
    let found: Vec<_> = lines.lines().map(|line| line.split("; ").next().unwrap_or_default()).collect();
    assert_eq!(found.len(), 4, "consequences of another error are not reported: {lines}");
    assert!(found[0].contains("resource `wide`: 99999x1 texels"), "{lines}");
    assert!(found[1].contains("pass `bad`: resource `a`: `sampled` conflicts"), "{lines}");
    assert!(found[2].contains("unknown resource `bb`"), "{lines}");
    assert!(found[3].contains("pass `early`: resource `b`: used as `sampled`"), "{lines}");
}

#[test]
fn a_misspelt_word_is_one_error() {
    // The unknown resource of one pass may be the one that the other reads.
    let text = file(
        r#"Texture(name: "glow", format: R8Unorm)"#,
        r#"Raster(name: "p", accesses: [Color(to: "glo", intent: Overwrite)]),
           Raster(name: "q", flags: [SideEffect], accesses: [Sampled(of: "glow")])"#,
        "",
    );
    assert_eq!(wrong(&text).listed.len(), 1);
    // They are not counted either, beyond the hundredth error.
    let readers: String = (0..300)
        .map(|i| format!("Raster(name: \"q{i}\", flags: [SideEffect], accesses: [Sampled(of: \"glow\")]),"))
        .collect();
    let passes = format!(r#"Raster(name: "p", accesses: [Color(to: "glo", intent: Overwrite)]), {readers}"#);
    let errors = wrong(&file(r#"Texture(name: "glow", format: R8Unorm)"#, &passes, ""));
    assert_eq!((errors.listed.len(), errors.more), (1, 0), "{errors}");
    let text = file(
        "",
        r#"Plugin(kind: "shadwo", name: "s", slots: {"output": "map"}),
           Raster(name: "q", flags: [SideEffect], accesses: [Sampled(of: "map")])"#,
        r#"Keep(of: "map")"#,
    );
    let errors = wrong(&text);
    assert_eq!(errors.listed.len(), 1, "{errors}");
    assert!(errors.to_string().contains("unknown plugin `shadwo`"), "{errors}");
}

#[test]
fn no_output_has_control_characters() {
    let name = r"a\u{1b}[31m\u{0}\u{9b}\u{7f}\nb";
    let text = format!(
        "(version: 1, resources: [Texture(name: \"{name}\", format: R8Unorm)], passes: [Raster(name: \"{name}\", \
         accesses: [Color(to: \"{name}\", intent: Overwrite)]), Compute(name: \"idle\", accesses: [])], \
         exports: [Keep(of: \"{name}\")])"
    );
    let parsed = GraphFile::parse("t.ron", &text).unwrap();
    let graph = parsed.graph(&[]).unwrap();
    let mut plan = Plan::new();
    let device = caps("c.ron", &format!("(version: 1, name: \"{name}\")")).unwrap();
    compile(&graph, &device, &Options::default(), &mut Scratch::new(), &mut plan).unwrap();
    let other = crate::support::plan(&Graph::new(), &crate::support::wgpu());
    let outputs = [
        dump::text(&plan),
        dump::json(&plan, "x\u{1b}"),
        dump::dot(&plan),
        dump::mermaid(&plan),
        dump::svg(&plan),
        diff(&other, &plan).to_string(),
        diff(&other, &plan).json(),
        to_ron(&graph, "x\u{1b}", [1, 1]),
        wrong(&text.replace("R8Unorm", "R8Unorm, size: Texels(99999, 1)")).to_string(),
        wrong(&text.replace("Keep(of: \"a", "Keep(of: \"b")).to_string(),
    ];
    for output in outputs {
        let bad = output.chars().find(|c| c.is_control() && *c != '\n');
        assert_eq!(bad, None, "{output:?}");
    }
    assert!(dump::text(&plan).contains(r"a\u{1b}[31m\u{0}\u{9b}\u{7f}\nb"));
}

#[test]
fn long_names_are_shortened_in_errors() {
    let long = "x".repeat(5_000_000);
    let text = file(
        &format!("Texture(name: \"{long}\", format: R8Unorm)"),
        &format!("Raster(name: \"p\", accesses: [Color(to: \"{long}y\", intent: Overwrite)])"),
        "",
    );
    let errors = refused(&text);
    assert!(errors.len() < 2000 && errors.contains("(5000001 characters)"), "{}", errors.len());
}

#[test]
fn what_a_tool_expects_is_passed_over_once() {
    let expect = "(a: 1, b: \"xyz\", c: [1, 2]),".repeat(20_000);
    let text = format!("(version: 1, expect: [{expect}])");
    let parsed = GraphFile::parse("t.ron", &text).unwrap();
    #[derive(serde::Deserialize)]
    #[expect(dead_code, reason = "read and dropped")]
    struct Row {
        a: u8,
        b: String,
        c: Vec<u8>,
    }
    assert_eq!(parsed.expect::<Vec<Row>>().unwrap().map(|rows| rows.len()), Some(20_000));
}

#[test]
fn clear_values_are_checked_against_the_format() {
    let text = |format: &str, value: &str| {
        file(
            &format!("Texture(name: \"a\", format: {format})"),
            &format!("Raster(name: \"p\", accesses: [Color(to: \"a\", intent: ClearColor({value}))])"),
            "Keep(of: \"a\")",
        )
    };
    for (format, value) in [
        ("Rgba8Unorm", "NaN, 0, 0, 1"),
        ("Rgba8Unorm", "2, 0, 0, 1"),
        ("Rgba8Uint", "0.5, 0, 0, 1"),
        ("R16Float", "1e9, 0, 0, 0"),
    ] {
        let errors = wrong(&text(format, value)).to_string();
        assert!(errors.contains(&format!("which {format} cannot represent")), "{errors}");
    }
}
