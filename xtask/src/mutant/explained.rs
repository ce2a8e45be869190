//! Mutants that no test can detect, each with the reason. A test checks that each still matches its file.

use crate::mutant::plant::Mutant;

/// A mutant whose effect is nil, or too small for a reliable test.
#[derive(Debug)]
pub struct Explained {
    pub file: &'static str,
    pub before: &'static str,
    pub after: &'static str,
    /// Reason, as a sentence for the document.
    pub why: &'static str,
}

/// All explained mutants, by file.
pub const EXPLAINED: &[Explained] = &[
    Explained {
        file: "shaders/wgsl/pass/occlusion.wgsl",
        before: "var right = vec3<f32>(0.0);",
        after: "var right = vec3<f32>(0.1);",
        why: "Both branches that follow overwrite the value.",
    },
    Explained {
        file: "shaders/wgsl/pass/occlusion.wgsl",
        before: "let aside = normalize_or(vec3<f32>(way.y, -way.x, 0.0), vec3<f32>(0.0)).xy;",
        after: "let aside = normalize_or(vec3<f32>(way.y, -way.x, 0.0), vec3<f32>(0.1)).xy;",
        why: "The fallback applies only to a vector of length 0, and is multiplied by that length.",
    },
    Explained {
        file: "shaders/wgsl/pass/flare.wgsl",
        before: "return textureSampleLevel(glow, glow_sampler, at, 0.0).rgb;",
        after: "return textureSampleLevel(glow, glow_sampler, at, 0.1).rgb;",
        why: "The bound view has a single level, so the level of detail has no effect.",
    },
    Explained {
        file: "shaders/wgsl/pass/dof.wgsl",
        before: "sort(&v, 5u, 8u);",
        after: "sort(&v, 5u, 9u);",
        why: "The array has nine elements, and indices beyond 8 are clamped to 8.",
    },
    Explained {
        file: "shaders/wgsl/pass/dof.wgsl",
        before: "if tile.y - tile.x <= abs(tile.y) * 0.05 {",
        after: "if tile.y - tile.x <= abs(tile.y) * 0.05500000000000001 {",
        why: "The threshold selects the cheaper gather. Near it, both gathers give the same picture.",
    },
    Explained {
        file: "shaders/wgsl/pass/dof.wgsl",
        before: "return vec4<f32>(found, 0.0, 0.0);",
        after: "return vec4<f32>(found, 0.0, 0.1);",
        why: "Tiles have two channels.",
    },
    Explained {
        file: "shaders/wgsl/lib/fog.wgsl",
        before: "let series = 1.0 - x * (0.5 - x * (1.0 / 6.0 - x / 24.0));",
        after: "let series = 1.0 - x * (0.5 - x * (1.0 / 6.0 - x / 26.400000000000002));",
        why: "For x below 0.01, the change is a fifteenth of the precision of f32.",
    },
    Explained {
        file: "shaders/wgsl/pass/reflection.wgsl",
        before: "let along = normalize_or(view_from_world * mirrored, vec3<f32>(0.0, 0.0, -1.0));",
        after: "let along = normalize_or(view_from_world * mirrored, vec3<f32>(0.0, 0.1, -1.0));",
        why: "The reflected vector has length 1, so the fallback is never used.",
    },
    Explained {
        file: "shaders/wgsl/interface/structure.wgsl",
        before: "return StructureTap(vec3<f32>(0.0), false);",
        after: "return StructureTap(vec3<f32>(0.1), false);",
        why: "Without a hit, the position is not read.",
    },
    Explained {
        file: "shaders/wgsl/pass/shadow_blur.wgsl",
        before: "sum += textureLoad(moments, texel, 0).xy * weight;",
        after: "sum -= textureLoad(moments, texel, 0).xy * weight;",
        why: "The blur runs twice, once per axis, and two negations cancel.",
    },
    Explained {
        file: "shaders/wgsl/pass/fxaa.wgsl",
        before: "return vec4<f32>(select(linear_from_srgb(encoded), encoded, OUTPUT_ENCODED), 1.0);",
        after: "return vec4<f32>(select(linear_from_srgb(encoded), encoded, OUTPUT_ENCODED), 1.1);",
        why: "The value is alpha in an 8-bit picture, which clamps 1.1 to 1.",
    },
    Explained {
        file: "shaders/wgsl/lib/occlusion.wgsl",
        before: "let r1 = acos(clamp(cos_cap1, -1.0, 1.0));",
        after: "let r1 = acos(clamp(cos_cap1, -1.0, 1.1));",
        why: "The clamp guards against rounding above 1, which no test input causes on every driver.",
    },
    Explained {
        file: "shaders/wgsl/pass/scene.wgsl",
        before: "let ndc = vec2<f32>(vertex.uv.x * 2.0 - 1.0, 1.0 - vertex.uv.y * 2.0);",
        after: "let ndc = vec2<f32>(vertex.uv.x * 2.0 - 1.0, 1.1 - vertex.uv.y * 2.0);",
        why: "Every supported projection has planes of equal depth that face the camera, so the depth does not vary over the picture.",
    },
    Explained {
        file: "shaders/wgsl/pass/scene.wgsl",
        before: "let ndc = vec2<f32>(vertex.uv.x * 2.0 - 1.0, 1.0 - vertex.uv.y * 2.0);",
        after: "let ndc = vec2<f32>(vertex.uv.x * 2.0 + 1.0, 1.0 - vertex.uv.y * 2.0);",
        why: "Planes of equal depth face the camera, so the depth does not vary over the picture.",
    },
    Explained {
        file: "shaders/wgsl/interface/object.wgsl",
        before: "return (length(m[0].xyz) + length(m[1].xyz) + length(m[2].xyz)) / 3.0;",
        after: "return (length(m[0].zyx) + length(m[1].xyz) + length(m[2].xyz)) / 3.0;",
        why: "A length does not depend on the order of components.",
    },
    Explained {
        file: "shaders/wgsl/pass/shadow.wgsl",
        before: "if base_color(uv, vec4<f32>(1.0, 1.0, 1.0, alpha)).a < material.alpha_cutoff {",
        after: "if base_color(uv, vec4<f32>(1.0, 1.1, 1.0, alpha)).a < material.alpha_cutoff {",
        why: "Only alpha is read, not the color.",
    },
    Explained {
        file: "shaders/wgsl/pass/sky.wgsl",
        before: "let d = normalize_or(vertex.ray, vec3<f32>(0.0, 1.0, 0.0));",
        after: "let d = normalize_or(vertex.ray, vec3<f32>(0.1, 1.0, 0.0));",
        why: "Camera rays never have length 0, so the fallback is never used.",
    },
    Explained {
        file: "shaders/wgsl/shading/quality.wgsl",
        before: "override SH_BANDS: u32 = 3u;",
        after: "override SH_BANDS: u32 = 4u;",
        why: "Every pipeline sets it.",
    },
    Explained {
        file: "shaders/wgsl/effect/bloom.wgsl",
        before: "added += textureSampleLevel(bloom_flare, bloom_sampler, uv, 0.0).rgb * blooming.flare;",
        after: "added += textureSampleLevel(bloom_flare, bloom_sampler, uv, 0.1).rgb * blooming.flare;",
        why: "The bound view has a single level, so the level of detail has no effect.",
    },
    Explained {
        file: "shaders/wgsl/lib/display_range.wgsl",
        before: "let stop = clamp(log2(clamp(y, 1e-10, 65504.0) / 0.18) + 5.0, 0.0, 15.0);",
        after: "let stop = clamp(log2(clamp(y, 1e-10, 65504.0) / 0.18) + 5.0, 0.0, 16.5);",
        why: "All colors from the fifteenth stop on are white.",
    },
    Explained {
        file: "shaders/wgsl/lib/gt7.wgsl",
        before: "let x = min(pow(max(code, vec3<f32>(1e-20)), vec3<f32>(1.0 / 78.84375)), vec3<f32>(1.0));",
        after: "let x = min(pow(max(code, vec3<f32>(1e-20)), vec3<f32>(1.0 / 78.84375)), vec3<f32>(1.1));",
        why: "Encoded values are at most 1; the limit guards against rounding.",
    },
    Explained {
        file: "shaders/wgsl/pass/dof.wgsl",
        before: "override TEXEL_PX: f32 = 1.0;",
        after: "override TEXEL_PX: f32 = 1.1;",
        why: "Every pipeline sets it.",
    },
    Explained {
        file: "shaders/wgsl/pass/dof.wgsl",
        before: "override RINGS_EVEN: f32 = 5.0;",
        after: "override RINGS_EVEN: f32 = 5.5;",
        why: "Every pipeline sets it.",
    },
    Explained {
        file: "shaders/wgsl/pass/dof.wgsl",
        before: "return gather_even(vertex.uv, 0.5 * (abs(tile.x) + abs(tile.y)), noise);",
        after: "return gather_even(vertex.uv, 0.5 * (abs(tile.x) + abs(tile.x)), noise);",
        why: "Here the two radii differ by at most a twentieth, so their mean is within a fortieth of either.",
    },
    Explained {
        file: "shaders/wgsl/pass/post.wgsl",
        before: "return fullscreen_position(vertex, 0.0);",
        after: "return fullscreen_position(vertex, 0.1);",
        why: "The pass has no depth attachment.",
    },
    Explained {
        file: "shaders/wgsl/pass/scene.wgsl",
        before: "let ndc = vec2<f32>(vertex.uv.x * 2.0 - 1.0, 1.0 - vertex.uv.y * 2.0);",
        after: "let ndc = vec2<f32>(vertex.uv.x * 2.0 - 1.0, 1.0 - vertex.uv.x * 2.0);",
        why: "Every supported projection has planes of equal depth that face the camera, so the depth does not vary over the picture.",
    },
    Explained {
        file: "shaders/wgsl/pass/shadow_blur.wgsl",
        before: "let texel = clamp(center + shadow_blur.step * i, shadow_blur.first, shadow_blur.last);",
        after: "let texel = clamp(center - shadow_blur.step * i, shadow_blur.first, shadow_blur.last);",
        why: "The taps are symmetric.",
    },
    Explained {
        file: "shaders/wgsl/pass/taa.wgsl",
        before: "return select(vec3<f32>(uv, 1.0), vec3<f32>(place, f32(shown)), REPROJECT);",
        after: "return select(vec3<f32>(uv, 1.1), vec3<f32>(place, f32(shown)), REPROJECT);",
        why: "Readers only test whether the value is above 0.",
    },
    Explained {
        file: "shaders/wgsl/pass/taa.wgsl",
        before: "let usable = all_finite3(before) && place.z > 0.0;",
        after: "let usable = all_finite3(before) && place.z > 0.1;",
        why: "The value is 0 or 1.",
    },
    Explained {
        file: "shaders/wgsl/shading/contact_shadow.wgsl",
        before: "let texel = vec2<i32>(clamp(at.xy * size, vec2<f32>(0.0), size - 1.0));",
        after: "let texel = vec2<i32>(clamp(at.xy * size, vec2<f32>(0.1), size - 1.0));",
        why: "Coordinates below 1 select the first texel.",
    },
    Explained {
        file: "shaders/wgsl/shading/surface.wgsl",
        before: "var under = real3(0.0);",
        after: "var under = real3(0.1);",
        why: "Both branches that follow overwrite the value.",
    },
    Explained {
        file: "shaders/wgsl/shading/surface.wgsl",
        before: "t = normalize_or(t, vec3<f32>(1.0, 0.0, 0.0));",
        after: "",
        why: "The result is normalized, whatever its length.",
    },
    Explained {
        file: "shaders/wgsl/shading/surface.wgsl",
        before: "let b = cross(front, t) * tangent.w;",
        after: "let b = cross(front, t) / tangent.w;",
        why: "The handedness is 1 or −1.",
    },
    Explained {
        file: "shaders/wgsl/shading/vertex.wgsl",
        before: "vec3<f32>(0.0, 0.0, 1.0),",
        after: "vec3<f32>(0.1, 0.0, 1.0),",
        why: "A triangle that covers a pixel has an area, so the fallback of its normal is never used.",
    },
    Explained {
        file: "shaders/wgsl/shading/shadow.wgsl",
        before: "return tints[min(select(4u, cascade, cascade < CASCADES), 4u)];",
        after: "return tints[min(select(5u, cascade, cascade < CASCADES), 4u)];",
        why: "Indices beyond 4 are clamped to 4.",
    },
];

/// Returns the reason a surviving mutant is not a gap in the tests, if it is listed.
pub fn why(mutant: &Mutant) -> Option<&'static str> {
    let same = |e: &&Explained| e.file == mutant.file && e.before == mutant.before && e.after == mutant.after;
    EXPLAINED.iter().find(same).map(|explained| explained.why)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mutant::room::ROOMS;

    #[test]
    fn every_explained_fault_can_still_be_planted() {
        let all: Vec<Mutant> = ROOMS.iter().flat_map(|room| room.mutants().expect("readable sources")).collect();
        assert!(all.len() > 1000, "{}", all.len());
        for Explained { file, before, after, why } in EXPLAINED {
            let there = all.iter().any(|m| m.file == *file && m.before == *before && m.after == *after);
            assert!(there && why.ends_with('.'), "{file}: `{before}` with `{after}` instead");
        }
    }
}
