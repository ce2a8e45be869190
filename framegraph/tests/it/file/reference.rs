//! Checks `docs/reference/graph-format.md` against the parser: its examples are valid, and every keyword is documented.

use framegraph::file::*;

fn reference() -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/reference/graph-format.md");
    std::fs::read_to_string(path).expect("docs/reference/graph-format.md exists")
}

/// Returns the text of each RON block.
fn examples(text: &str) -> Vec<&str> {
    let blocks = text.split("```ron\n").skip(1);
    blocks.map(|block| block.split("```").next().unwrap_or_default()).collect()
}

#[test]
fn every_example_is_read() {
    let text = reference();
    let examples = examples(&text);
    assert!(examples.len() >= 7, "only {} examples", examples.len());
    for example in examples.iter().filter(|e| !e.contains('…')) {
        let list = example.trim_end().replace(")\n", "),\n");
        let whole = match example.split(['(', ':']).next().unwrap_or_default() {
            "Texture" => format!("(version: 1, resources: [{list}])"),
            "Raster" | "Compute" | "Each" => format!("(version: 1, passes: [{list}])"),
            "Plugin" => format!("(version: 1, passes: [{list}])"),
            "exports" | "templates" => format!("(version: 1, {example})"),
            _ => {
                caps("d.ron", example).unwrap_or_else(|e| panic!("{e}\n{example}"));
                continue;
            }
        };
        let whole = whole.replace(",,", ",");
        GraphFile::parse("e.ron", &whole).unwrap_or_else(|e| panic!("{e}\n{whole}"));
    }
}

/// The parser lists the words it knows in its errors; each of them must be documented.
#[test]
fn every_word_that_the_reader_knows_is_documented() {
    let text = reference();
    let wrong = [
        "(version: 1, zzz: 0)",
        "(version: 1, resources: [Zzzzzz()])",
        "(version: 1, resources: [Texture(zzz: 0)])",
        "(version: 1, resources: [Buffer(zzz: 0)])",
        "(version: 1, resources: [Texture(name: \"a\", format: R8Unorm, kind: Zzzzzz)])",
        "(version: 1, resources: [Texture(name: \"a\", format: R8Unorm, size: Zzzzzz)])",
        "(version: 1, resources: [Texture(name: \"a\", format: R8Unorm, dimension: Zzzzzz)])",
        "(version: 1, passes: [Zzzzzz()])",
        "(version: 1, passes: [Raster(zzz: 0)])",
        "(version: 1, passes: [Plugin(zzz: 0)])",
        "(version: 1, passes: [Raster(name: \"p\", flags: [Zzzzzz])])",
        "(version: 1, passes: [Raster(name: \"p\", accesses: [Zzzzzz()])])",
        "(version: 1, passes: [Raster(name: \"p\", accesses: [Color(zzz: 0)])])",
        "(version: 1, passes: [Raster(name: \"p\", accesses: [Sampled(zzz: 0)])])",
        "(version: 1, passes: [Raster(name: \"p\", accesses: [Color(to: \"a\", intent: Zzzzzz)])])",
        "(version: 1, passes: [Each(zzz: 0)])",
        "(version: 1, passes: [Use(zzz: 0)])",
        "(version: 1, templates: {\"t\": (zzz: 0)})",
        "(version: 1, exports: [Zzzzzz()])",
        "(version: 1, exports: [Forward(zzz: 0)])",
    ];
    let mut words = 0;
    for wrong in wrong {
        let error = ron_words(wrong);
        assert!(error.len() >= 2, "{wrong}: {error:?}");
        for word in error {
            words += 1;
            assert!(text.contains(&word), "`{word}` is not in the reference");
        }
    }
    let caps_fields = caps("c.ron", "(version: 1, zzz: 0)").expect_err("the field does not exist");
    assert!(caps_fields.to_string().contains("`version`"));
    assert!(words > 90, "only {words} words");
}

/// Returns the accepted words, from the hint.
fn ron_words(text: &str) -> Vec<String> {
    let error = GraphFile::parse("w.ron", text).expect_err("the text is wrong").to_string();
    let known = error.split("known are ").nth(1).unwrap_or_default();
    let words = known.split('`').skip(1).step_by(2);
    words.map(str::to_owned).collect()
}
