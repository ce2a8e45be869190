//! Errors of invalid files: path, line and column, reason and hint, in one line.

use super::{file, refused};
use crate::support::*;
use framegraph::file::*;
use framegraph::*;

#[test]
fn cycles_name_their_passes() {
    let text = file(
        r#"Texture(name: "a", format: R8Unorm), Texture(name: "b", format: R8Unorm)"#,
        r#"
        Raster(name: "one", accesses: [Sampled(of: "b@two"), Color(to: "a", intent: Overwrite)]),
        Raster(name: "two", accesses: [Sampled(of: "a@one"), Color(to: "b", intent: Overwrite)]),
        Compute(name: "self", flags: [SideEffect], after: ["self"]),
        "#,
        "",
    );
    let errors = refused(&text);
    let lines: Vec<_> = errors.lines().collect();
    assert_eq!(
        lines,
        [
            "t.ron:4:22: pass `one`: passes depend on each other: `one` -> `two`; \
             let one of them read a history or another texture, or remove an unnecessary `after`",
            "t.ron:6:23: pass `self`: passes depend on each other: `self`; \
             let one of them read a history or another texture, or remove an unnecessary `after`",
        ]
    );
}

#[test]
fn two_writers_of_one_version_are_named() {
    let text = file(
        r#"Texture(name: "a", format: R8Unorm)"#,
        r#"
        Raster(name: "base", accesses: [Color(to: "a", intent: Overwrite)]),
        Raster(name: "one", accesses: [Color(to: "a@base", intent: Modify)]),
        Raster(name: "two", accesses: [Color(to: "a@base", intent: Modify)]),
        "#,
        "",
    );
    assert_eq!(
        refused(&text),
        "t.ron:6:50: pass `two`: resource `a`: `one` writes the same version; \
         let the second pass modify the version written by the first"
    );
}

#[test]
fn bad_files_are_told_where_what_and_what_to_do() {
    let texture = r#"Texture(name: "a", format: R8Unorm)"#;
    let pass = |accesses: &str| format!(r#"Raster(name: "p", accesses: [{accesses}])"#);
    let write = pass(r#"Color(to: "a", intent: Overwrite)"#);
    let cases = [
        ("".into(), "t.ron:1:1: "),
        ("(".into(), "t.ron:1:1: unexpected end of RON; add the missing bracket"),
        ("(name: \"x\")".into(), "`File` requires the field `version`; add `version: …`"),
        ("(version: 2, nonsense: 3)".into(), "t.ron:1:11: the file has version 2"),
        ("(version: 1, pases: [])".into(), "did you mean `passes`?"),
        ("(version: 1) x".into(), "remove the text after the first value"),
        ("(version: 1, frame: (0, 4))".into(), "t.ron:1:21: the frame has 0 texels"),
        ("(version: 1, features: {\"a b\": true})".into(), "is not a valid feature name"),
        ("(version: 1, features: {\"a\": true, \"a\": true})".into(), "duplicate key `a`"),
        (file(r#"Texture(name: "a", format: R8Unrm)"#, "", ""), "did you mean `R8Unorm`?"),
        (file(r#"Texture(name: "a", format: R8Unorm, mips: 0)"#, "", ""), "t.ron:2:55: 0 levels; "),
        (file(r#"Texture(name: "a", format: R8Unorm, mips: 300)"#, "", ""), "from 1 to 32, or \"all\""),
        (file(r#"Texture(name: "a", format: R8Unorm, layers: 70000)"#, "", ""), "70000 layers; "),
        (file(r#"Texture(name: "a", format: R8Unorm, samples: "all")"#, "", ""), "samples cannot be \"all\""),
        (file(r#"Texture(name: "a", format: R8Unorm, samples: {"x": 1})"#, "", ""), "unknown feature `x`"),
        (file(r#"Texture(name: "a", format: R8Unorm, samples: {})"#, "", ""), "no condition for samples holds"),
        (file(r#"Texture(name: "a", format: R8Unorm, size: Scale(num: 1, den: 0))"#, "", ""), "denominator 0"),
        (file(r#"Texture(name: "a", format: R8Unorm, kind: History(frames: 0))"#, "", ""), "0 frames"),
        (file(r#"Buffer(name: "a", bytes: 0)"#, "", ""), "0 bytes; "),
        (file(r#"Buffer(name: "a", bytes: 99999999999999999999)"#, "", ""), "t.ron:2:38: "),
        (file(r#"Buffer(name: "a", bytes: 4, kind: History(frames: 1))"#, "", ""), "a buffer cannot be a history"),
        (file(&format!("{texture}, {texture}"), "", ""), "more than one resource is named `a`; rename"),
        (file(texture, &format!("{write}, {write}"), ""), "more than one pass is named `p`"),
        (file(r#"Texture(name: "a@b", format: R8Unorm)"#, "", ""), "add an `id`"),
        (file(texture, &pass(r#"Color(to: "aa", intent: Overwrite)"#), ""), "did you mean `a`?"),
        (file(texture, &pass(r#"Color(to: "a@q", intent: Overwrite)"#), ""), "unknown pass `q`"),
        (file(texture, &pass(r#"Sampled(of: "a@p")"#), ""), "pass `p` does not write it; no pass writes it"),
        (file(texture, &pass(r#"Sampled(of: "a@-1")"#), ""), "the resource is not a history"),
        (file(texture, &pass(r#"Sampled(of: "a", mip: 1)"#), ""), "levels 1..2"),
        (file(texture, &pass(r#"Uniform(of: "a")"#), ""), "a texture cannot be used as `uniform`; use a buffer"),
        (file(texture, &pass(r#"Resolve(to: "a")"#), ""), "not a multisampled color or depth attachment"),
        (file(texture, &pass(r#"Color(to: "a", intent: Overwrite, slot: 9)"#), ""), "color slot 9 does not exist; use a slot from 0 to 7"),
        (file(texture, &pass(r#"CopySource(of: "a")"#), ""), "a raster pass cannot use `copy_source`"),
        (file(r#"Buffer(name: "a", bytes: 4)"#, &pass(r#"Vertex(of: "a", mip: 0)"#), ""), "a buffer has no levels"),
        (file(r#"Buffer(name: "a", bytes: 4)"#, &write, ""), "a buffer cannot be used as `color`"),
        (file(texture, &write, r#"Keep(of: "b")"#), "unknown resource `b`"),
        (file(texture, r#"Plugin(kind: "x", name: "x")"#, ""), "unknown plugin `x`; none exist here"),
        (file(texture, r#"Raster(name: "p", when: "x")"#, ""), "unknown feature `x`; none exist here"),
        (
            "(version: 1, features: {\"aa\": true, \"bb\": true, \"cc\": true, \"dd\": true, \"ee\": true, \"ff\": true, \
              \"gg\": true, \"hh\": true, \"ii\": true}, exports: [Keep(of: \"x\", when: \"what\")])"
                .into(),
            "unknown feature `what`; use one of `aa`, `bb`, `cc`, `dd`, `ee`, `ff`, `gg`, `hh` and others",
        ),
        (file("Previous(of: \"a\", age: 1)", "", ""), "unknown resource `a`"),
        (file(&format!("{texture}, Previous(of: \"a\", age: 1)"), "", ""), "the resource is not a history"),
    ];
    for (text, expected) in cases {
        let errors = refused(&text);
        assert!(errors.contains(expected), "{text}\n{errors}\nlacks {expected}");
        println!("{errors}");
        for line in errors.lines() {
            assert!(line.starts_with("t.ron:"), "{line}");
            assert!(line.contains("; "), "no hint: {line}");
        }
    }
}

#[test]
fn what_does_not_compile_is_explained_in_the_file() {
    let text = file(
        r#"Texture(name: "a", format: R8Unorm), Texture(name: "wide", format: R8Unorm, size: Texels(99999, 1))"#,
        r#"
        Raster(name: "early", accesses: [Sampled(of: "a")], flags: [SideEffect]),
        Raster(name: "late", accesses: [Color(to: "a", intent: Overwrite)]),
        "#,
        "",
    );
    let file = GraphFile::parse("t.ron", &text).unwrap();
    let errors = file.explain(&CompileErrors { listed: errors(&file.graph(&[]).unwrap()), more: 0 });
    assert!(errors.to_string().starts_with("t.ron:2:64: resource `wide`: 99999x1 texels"), "{errors}");
    let text = text.replace("99999", "9");
    let file = GraphFile::parse("t.ron", &text).unwrap();
    let errors = file.explain(&CompileErrors { listed: crate::support::errors(&file.graph(&[]).unwrap()), more: 0 });
    assert_eq!(
        errors.to_string(),
        "t.ron:4:22: pass `early`: resource `a`: used as `sampled`, but its writer `late` \
         is declared later; declare the writer first"
    );
}

#[test]
fn devices_are_presets_with_differences() {
    let small = caps("c.ron", r#"(version: 1, like: "tiler", name: "small", tile_bytes_per_pixel: 16)"#).unwrap();
    let expected = Caps { name: "small".into(), tile_bytes_per_pixel: 16, ..Caps::tiler() };
    assert_eq!(small, expected);
    assert_eq!(caps("c.ron", "(version: 1)").unwrap(), Caps::wgpu());
    let cases = [
        ("(version: 7)", "c.ron:1:11: the file has version 7"),
        ("(version: 1, like: \"desktp\")", "did you mean `desktop`?"),
        ("(version: 1, inlin: true)", "did you mean `inline`?"),
        ("(version: 1, texture_alignment_bytes: 3)", "c.ron:1:39: alignment of 3 bytes"),
        ("(version: 1, max_samples: 0)", "maximum of 0 samples"),
        ("(version: 1, max_color_attachments: 9)", "maximum of 9 color attachments"),
        ("(version: 1, max_texture_texels: 0)", "maximum of 0 texels or layers"),
    ];
    for (text, expected) in cases {
        let errors = caps("c.ron", text).unwrap_err().to_string();
        assert!(errors.contains(expected), "{errors}");
    }
}
