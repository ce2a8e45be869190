//! Checks the JSON form against its schema and against the plan.

use super::{frame, random_plans};
use crate::support::*;
use framegraph::*;
use serde_json::{Value, json};

fn schema() -> Value {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/reference/plan.schema.json");
    let text = std::fs::read_to_string(path).expect("docs/reference/plan.schema.json exists");
    serde_json::from_str(&text).expect("the schema is JSON")
}

fn parsed(plan: &Plan) -> Value {
    serde_json::from_str(&dump::json(plan, "frame")).expect("the form is JSON")
}

/// Checks a value against the JSON Schema keywords that the schema uses. An unknown keyword is an error of the schema.
fn check(root: &Value, schema: &Value, value: &Value, at: &str) -> Result<(), String> {
    let rules = schema.as_object().expect("a schema is an object");
    for (keyword, rule) in rules {
        let wrong = |what: &str| Err(format!("{at}: {value} {what}"));
        match keyword.as_str() {
            "$schema" | "title" | "description" | "$defs" => {}
            "$ref" => {
                let name = rule.as_str().and_then(|r| r.strip_prefix("#/$defs/"));
                let target = &root["$defs"][name.expect("a reference to a definition")];
                assert!(target.is_object(), "{rule} is not defined");
                check(root, target, value, at)?;
            }
            "type" => {
                let is = |word: &Value| match word.as_str().expect("a type is a string") {
                    "object" => value.is_object(),
                    "array" => value.is_array(),
                    "string" => value.is_string(),
                    "boolean" => value.is_boolean(),
                    "null" => value.is_null(),
                    "integer" => value.is_u64() || value.is_i64(),
                    other => panic!("type {other}"),
                };
                let fits = rule.as_array().map_or_else(|| is(rule), |words| words.iter().any(is));
                if !fits {
                    return wrong("has another type");
                }
            }
            "const" if value != rule => return wrong("is another constant"),
            "const" => {}
            "enum" => {
                if !rule.as_array().expect("a list").contains(value) {
                    return wrong("is not in the list");
                }
            }
            "anyOf" => {
                let options = rule.as_array().expect("a list");
                if !options.iter().any(|o| check(root, o, value, at).is_ok()) {
                    return wrong("fits none");
                }
            }
            "minimum" => {
                if value.as_i64().is_some_and(|v| v < rule.as_i64().expect("a number")) {
                    return wrong("is too small");
                }
            }
            "minItems" | "maxItems" => {
                let (items, bound) = (value.as_array().map_or(0, Vec::len), rule.as_u64().expect("a number") as usize);
                let fits = if keyword == "minItems" { items >= bound } else { items <= bound };
                if !fits {
                    return wrong("has another length");
                }
            }
            "items" => {
                for (i, item) in value.as_array().into_iter().flatten().enumerate() {
                    check(root, rule, item, &format!("{at}[{i}]"))?;
                }
            }
            "required" => {
                for field in rule.as_array().expect("a list") {
                    if value.get(field.as_str().expect("a name")).is_none() {
                        return wrong(&format!("lacks {field}"));
                    }
                }
            }
            "properties" => {
                for (name, field) in value.as_object().into_iter().flatten() {
                    match rule.get(name) {
                        Some(rule) => check(root, rule, field, &format!("{at}.{name}"))?,
                        None => return wrong(&format!("has an unknown field {name}")),
                    }
                }
            }
            "additionalProperties" => assert_eq!(rule, &json!(false)),
            other => panic!("the schema uses {other}, which this test does not know"),
        }
    }
    Ok(())
}

#[test]
fn every_plan_fits_the_schema() {
    let schema = schema();
    for plan in random_plans(60) {
        let value = parsed(&plan);
        if let Err(error) = check(&schema, &schema, &value, "$") {
            panic!("{error}");
        }
    }
}

#[test]
fn what_does_not_fit_is_noticed() {
    let schema = schema();
    let good = parsed(&plan(&frame(), &wgpu()));
    check(&schema, &schema, &good, "$").expect("the plan fits");
    let paths = [
        ("/version", json!(2)),
        ("/frame", json!([1])),
        ("/totals/resolves", json!(-1)),
        ("/passes/0/kind", json!("draw")),
        ("/steps/0/attachments/0/load", json!("loaded")),
        ("/resources/0/placement", json!(null)),
        ("/resources/0/bytes", json!("8")),
        ("/decisions/0/about", json!("plan")),
        ("/peak", json!({"step": 0})),
    ];
    for (path, wrong) in paths {
        let mut bad = good.clone();
        *bad.pointer_mut(path).unwrap_or_else(|| panic!("no {path}")) = wrong;
        assert!(check(&schema, &schema, &bad, "$").is_err(), "{path}");
    }
    let mut bad = good.clone();
    bad["steps"][0]["extra"] = json!(1);
    assert!(check(&schema, &schema, &bad, "$").is_err());
    bad = good;
    bad["resources"][0].as_object_mut().expect("an object").remove("offset");
    assert!(check(&schema, &schema, &bad, "$").is_err());
}

#[test]
fn the_values_are_those_of_the_plan() {
    let value = parsed(&plan(&frame(), &wgpu()));
    assert_eq!(
        (&value["schema"], &value["version"], &value["name"]),
        (&json!("framegraph-plan"), &json!(dump::JSON_VERSION), &json!("frame"))
    );
    let totals = &value["totals"];
    let of = |what: &str| totals[what].as_u64().expect("a number");
    assert_eq!((of("unresolves"), of("resolves"), of("steps"), of("culled")), (0, 2, 2, 1));
    assert_eq!((of("unresolve_bytes"), of("resolve_bytes")), (0, 24576));
    assert_eq!((of("heap_bytes"), of("lower_bound_bytes"), of("gap_bytes")), (16384, 16384, 0));
    assert_eq!(totals["optimal"], json!(true));
    let idle = &value["passes"][2];
    assert_eq!(
        (&idle["name"], &idle["culled"], &idle["step"], &idle["reason"]),
        (&json!("idle"), &json!(true), &json!(null), &json!("culled because no pass reads `idle_out`"))
    );
    let flows = json!([
        {"from": "prepass", "to": "scene", "resources": ["depth"]},
        {"from": "scene", "to": "idle", "resources": ["hdr"]},
        {"from": "scene", "to": "tonemap", "resources": ["hdr"]},
    ]);
    assert_eq!(value["flows"], flows);
    let step = &value["steps"][0];
    assert_eq!(step["passes"], json!(["prepass", "scene"]));
    let depth = &step["attachments"][1];
    assert_eq!(
        (&depth["resource"], &depth["load"], &depth["store"], &depth["stencil_load"]),
        (&json!("depth"), &json!("clear"), &json!("discard"), &json!(null))
    );
    let [screen, depth, hdr] = [0, 1, 2].map(|i| &value["resources"][i]);
    assert_eq!((&depth["memoryless"], &depth["offset"]), (&json!(true), &json!(null)));
    assert_eq!((&hdr["first_step"], &hdr["last_step"], &hdr["offset"]), (&json!(0), &json!(1), &json!(0)));
    assert_eq!((&screen["placement"], &screen["bytes"]), (&json!("external"), &json!(8192)));
    let split = value["decisions"].as_array().expect("a list").iter().find(|d| d["reason"] == "split");
    let split = split.expect("tonemap is not merged");
    assert_eq!(
        (&split["about"], &split["pass"], &split["other_pass"], &split["refusal"]),
        (&json!("pass"), &json!("tonemap"), &json!("scene"), &json!("sampled_elsewhere"))
    );
    assert!(split["hint"].as_str().is_some_and(|h| h.contains("same_pixel")));
    assert_eq!(value["peak"], json!({"step": 0, "passes": ["prepass", "scene"], "resources": ["hdr"]}));
}

#[test]
fn what_comes_from_outside_says_how() {
    let mut g = Graph::new();
    let left = Entry::Left { state: State::Sampled, stages: Stages::SHADER.union(Stages::COPY) };
    let lent = g.import_texture("lent", hdr(), left, Exit::Discard);
    let taa = g.history("taa", hdr(), 2);
    let old = g.previous(taa, 2).unwrap();
    g.add_fn("taa", |p| {
        p.sampled(lent)?;
        p.sampled(old)?;
        p.color(taa, Intent::Overwrite)
    })
    .unwrap();
    let heap = Options { alias: Alias::Heap, ..options() };
    let value = parsed(&plan_with(&g, &Caps::desktop(), &heap));
    let [lent, taa] = [0, 1].map(|i| &value["resources"][i]);
    let entry = json!({"defined": true, "state": "sampled", "stages": ["shader", "copy"]});
    assert_eq!((&lent["entry"], &lent["exit"]), (&entry, &json!("discard")));
    assert_eq!((&taa["entry"], &taa["exit"]), (&json!(null), &json!(null)));
    let history = json!({
        "name": "taa", "images": 3, "image_bytes": 16384, "offsets": [0, 65536, 131072],
        "previous": [{"resource": "taa@-2", "age": 2}],
    });
    assert_eq!(value["histories"], json!([history]));
}

/// Checks what an external reader can verify: resources that are live at the same time do not overlap, offsets lie
/// within the heap, and sums are correct.
#[test]
fn offsets_and_sums_can_be_checked_by_a_reader() {
    for plan in random_plans(60) {
        let value = parsed(&plan);
        let number = |v: &Value, what: &str| v[what].as_u64();
        let list = |what: &str| value[what].as_array().expect("a list").clone();
        let last = list("steps").len().saturating_sub(1) as u64;
        // Every image of a history is listed, even if this frame does not read it.
        let images = list("histories").into_iter().flat_map(|h| {
            let bytes = number(&h, "image_bytes").expect("a number");
            let offsets = h["offsets"].as_array().expect("a list").clone();
            offsets.into_iter().filter_map(move |o| Some(((0, last), o.as_u64()?, bytes)))
        });
        let rows: Vec<_> = list("resources")
            .iter()
            .filter(|r| r["kind"] != "history" && r["kind"] != "previous")
            .filter_map(|r| {
                let held = r["held_steps"].as_array()?;
                let life = (held[0].as_u64()?, held[1].as_u64()?);
                Some((life, number(r, "offset")?, number(r, "bytes")?))
            })
            .chain(images)
            .collect();
        let heap = number(&value["totals"], "heap_bytes").expect("a number");
        for (i, &((first, last), offset, bytes)) in rows.iter().enumerate() {
            assert!(offset + bytes <= heap || plan.caps().separate_heaps, "{offset} + {bytes} > {heap}");
            for &((f, l), o, b) in &rows[..i] {
                let apart = last < f || l < first || offset + bytes <= o || o + b <= offset;
                assert!(apart, "{}", dump::text(&plan));
            }
        }
        let steps = value["steps"].as_array().expect("a list");
        for what in ["unresolves", "resolves", "unresolve_bytes", "resolve_bytes"] {
            let sum: u64 = steps.iter().filter_map(|s| number(s, what)).sum();
            assert_eq!(Some(sum), number(&value["totals"], what), "{what}");
        }
        for step in steps {
            let attachments = step["attachments"].as_array().expect("a list");
            for what in ["unresolve_bytes", "resolve_bytes"] {
                let sum: u64 = attachments.iter().filter_map(|a| number(a, what)).sum();
                assert_eq!(Some(sum), number(step, what), "{what}");
            }
        }
    }
}
