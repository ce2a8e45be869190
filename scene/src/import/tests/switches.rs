//! Switches in `extras.framegraph`.

use serde_json::json;

use super::fixture::Fixture;
use crate::draw_options::DrawOptions;
use crate::material::{Stencil, StencilCompare, StencilFace, StencilOp};

/// A triangle with a light on its node.
fn lit_triangle() -> Fixture {
    let mut fixture = Fixture::triangle();
    fixture.set("/extensionsUsed", json!(["KHR_lights_punctual"]));
    fixture.set("/extensions", json!({"KHR_lights_punctual": {"lights": [{"type": "point"}]}}));
    fixture.set("/nodes/0/extensions", json!({"KHR_lights_punctual": {"light": 0}}));
    fixture
}

#[test]
fn switches_are_read() {
    let mut fixture = lit_triangle();
    let scene = fixture.load().expect("it is plain");
    assert_eq!((scene.instances[0].draw, scene.lights[0].channels), (DrawOptions::default(), 1));
    fixture.set(
        "/nodes/0/extras",
        json!({"framegraph": {
            "layers": 3, "lightChannels": 6.0, "priority": 0, "blendOrder": 65535, "globalBlendOrder": true,
            "castShadows": false, "receiveShadows": false,
        }}),
    );
    fixture.set("/extensions/KHR_lights_punctual/lights/0/extras", json!({"framegraph": {"lightChannels": 128}}));
    let scene = fixture.load().expect("switches are sound");
    let expected = DrawOptions {
        layers: 3,
        light_channels: 6,
        priority: 0,
        blend_order: 65535,
        global_blend_order: true,
        casts_shadows: false,
        receives_shadows: false,
    };
    assert_eq!((scene.instances[0].draw, scene.lights[0].channels), (expected, 128));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn stencil_states_are_read() {
    let mut fixture = Fixture::triangle();
    fixture.push("materials", json!({}));
    fixture.set("/meshes/0/primitives/0/material", json!(0));
    assert_eq!(fixture.load().expect("it is plain").materials[0].stencil, None);
    let stated = json!({
        "write": true, "compare": "not-equal", "reference": 1, "readMask": 3, "writeMask": 2, "stencilFail": "zero",
        "depthFail": "increment-wrap", "pass": "replace", "back": {"compare": "less", "pass": "invert"},
    });
    fixture.set("/materials/0/extras", json!({"framegraph": {"stencil": stated}}));
    let scene = fixture.load().expect("the state is sound");
    let front = StencilFace {
        compare: StencilCompare::NotEqual,
        stencil_fail: StencilOp::Zero,
        depth_fail: StencilOp::IncrementWrap,
        pass: StencilOp::Replace,
    };
    let back = StencilFace { compare: StencilCompare::Less, pass: StencilOp::Invert, ..front };
    let expected = Stencil { write: true, reference: 1, read_mask: 3, write_mask: 2, front, back };
    assert_eq!((scene.materials[0].stencil.as_deref(), scene.uses_stencil()), (Some(&expected), true));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let wrong = json!({"compare": "sometimes", "back": {"reference": 1}, "readMask": 256});
    fixture.set("/materials/0/extras", json!({"framegraph": {"stencil": wrong}}));
    let scene = fixture.load().expect("wrong switches are no error");
    assert_eq!(scene.materials[0].stencil.as_deref(), Some(&Stencil::default()));
    let warning = "material 0: extras.framegraph.stencil.compare and 2 other places: 3 switches are unknown or out of range; \
                   they are ignored";
    assert!(matches!(&scene.warnings[..], [one] if one.ends_with(warning)), "{:?}", scene.warnings);
}

/// All invalid values of a file cause one warning with their number, which names the first by node and member.
#[test]
fn wrong_switches_are_counted_and_ignored() {
    let mut fixture = lit_triangle();
    fixture.set("/extensions/KHR_lights_punctual/lights/0/extras", json!({"framegraph": 7}));
    let wrong = json!({"layers": 256, "lightChannels": -1, "priority": 8, "blendOrder": 0.5, "castShadows": 1,
        "receiveShadows": null, "globalBlendOrder": "yes", "shade": true});
    fixture.set("/nodes/0/extras", json!({"framegraph": wrong}));
    let scene = fixture.load().expect("wrong switches are no error");
    assert_eq!((scene.instances[0].draw, scene.lights[0].channels), (DrawOptions::default(), 1));
    let warning =
        "light 0: extras.framegraph and 8 other places: 9 switches are unknown or out of range; they are ignored";
    assert!(matches!(&scene.warnings[..], [one] if one.ends_with(warning)), "{:?}", scene.warnings);
    fixture.set("/extensions/KHR_lights_punctual/lights/0/extras", json!(null));
    fixture.set("/nodes/0/extras", json!({"framegraph": {"layers": 3, "priority": 8}}));
    let scene = fixture.load().expect("wrong switches are no error");
    assert_eq!(scene.instances[0].draw, DrawOptions { layers: 3, ..DrawOptions::default() });
    let warning =
        "node 0 \"only\": extras.framegraph.priority: 1 switches are unknown or out of range; they are ignored";
    assert!(matches!(&scene.warnings[..], [one] if one.ends_with(warning)), "{:?}", scene.warnings);
}
