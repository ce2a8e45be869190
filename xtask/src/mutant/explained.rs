//! Faults that no test can see, each with the reason. A test sees to it that each still stands in its file.

use crate::mutant::plant::Mutant;

/// A fault that makes no difference, or none that a test could be sure of.
#[derive(Debug)]
pub struct Explained {
    pub file: &'static str,
    pub before: &'static str,
    pub after: &'static str,
    /// A sentence for the document.
    pub why: &'static str,
}

/// All of them, by file.
pub const EXPLAINED: &[Explained] = &[
    Explained {
        file: "shaders/wgsl/pass/occlusion.wgsl",
        before: "var right = vec3<f32>(0.0);",
        after: "var right = vec3<f32>(0.1);",
        why: "Both branches that follow give it another value.",
    },
    Explained {
        file: "shaders/wgsl/pass/occlusion.wgsl",
        before: "let aside = normalize_or(vec3<f32>(way.y, -way.x, 0.0), vec3<f32>(0.0)).xy;",
        after: "let aside = normalize_or(vec3<f32>(way.y, -way.x, 0.0), vec3<f32>(0.1)).xy;",
        why: "It stands in where the way has no length, and is multiplied by that length.",
    },
    Explained {
        file: "shaders/wgsl/pass/flare.wgsl",
        before: "return textureSampleLevel(glow, glow_sampler, at, 0.0).rgb;",
        after: "return textureSampleLevel(glow, glow_sampler, at, 0.1).rgb;",
        why: "What is bound is one level, and there is none between it and the next.",
    },
    Explained {
        file: "shaders/wgsl/pass/dof.wgsl",
        before: "sort(&v, 5u, 8u);",
        after: "sort(&v, 5u, 9u);",
        why: "There are nine, and an index beyond the last is taken for the last, which is 8.",
    },
    Explained {
        file: "shaders/wgsl/pass/dof.wgsl",
        before: "if tile.y - tile.x <= abs(tile.y) * 0.05 {",
        after: "if tile.y - tile.x <= abs(tile.y) * 0.05500000000000001 {",
        why: "It is from where on the cheaper gather is taken: of radii that differ by a twentieth both make the same picture.",
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
        why: "Below 0.01 the change of the last term is a fifteenth of what 32 bits resolve.",
    },
    Explained {
        file: "shaders/wgsl/pass/reflection.wgsl",
        before: "let along = normalize_or(view_from_world * mirrored, vec3<f32>(0.0, 0.0, -1.0));",
        after: "let along = normalize_or(view_from_world * mirrored, vec3<f32>(0.0, 0.1, -1.0));",
        why: "What is mirrored has a length of one; what stands in the place of none is not seen.",
    },
    Explained {
        file: "shaders/wgsl/interface/structure.wgsl",
        before: "return StructureTap(vec3<f32>(0.0), false);",
        after: "return StructureTap(vec3<f32>(0.1), false);",
        why: "Where nothing is met there is no position, and none is read.",
    },
    Explained {
        file: "shaders/wgsl/pass/shadow_blur.wgsl",
        before: "sum += textureLoad(moments, texel, 0).xy * weight;",
        after: "sum -= textureLoad(moments, texel, 0).xy * weight;",
        why: "A blur is two passes, along both axes: what is negated twice is as it was.",
    },
    Explained {
        file: "shaders/wgsl/pass/fxaa.wgsl",
        before: "return vec4<f32>(select(linear_from_srgb(encoded), encoded, OUTPUT_ENCODED), 1.0);",
        after: "return vec4<f32>(select(linear_from_srgb(encoded), encoded, OUTPUT_ENCODED), 1.1);",
        why: "It is the alpha of a picture of eight bits, which hold 1.1 as 1.",
    },
    Explained {
        file: "shaders/wgsl/lib/occlusion.wgsl",
        before: "let r1 = acos(clamp(cos_cap1, -1.0, 1.0));",
        after: "let r1 = acos(clamp(cos_cap1, -1.0, 1.1));",
        why: "The clamp is for what rounding may carry past 1, which no input of a test does on every driver.",
    },
    Explained {
        file: "shaders/wgsl/pass/scene.wgsl",
        before: "let ndc = vec2<f32>(vertex.uv.x * 2.0 - 1.0, 1.0 - vertex.uv.y * 2.0);",
        after: "let ndc = vec2<f32>(vertex.uv.x * 2.0 - 1.0, 1.1 - vertex.uv.y * 2.0);",
        why: "No projection that can be stated tilts its planes of equal depth: the distance ahead is the same all over the picture.",
    },
    Explained {
        file: "shaders/wgsl/pass/scene.wgsl",
        before: "let ndc = vec2<f32>(vertex.uv.x * 2.0 - 1.0, 1.0 - vertex.uv.y * 2.0);",
        after: "let ndc = vec2<f32>(vertex.uv.x * 2.0 + 1.0, 1.0 - vertex.uv.y * 2.0);",
        why: "Planes of equal depth are not tilted: the distance ahead is the same all over the picture.",
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
        why: "The color is left aside: alpha alone is read.",
    },
    Explained {
        file: "shaders/wgsl/pass/sky.wgsl",
        before: "let d = normalize_or(vertex.ray, vec3<f32>(0.0, 1.0, 0.0));",
        after: "let d = normalize_or(vertex.ray, vec3<f32>(0.1, 1.0, 0.0));",
        why: "No ray of a camera has no length; what stands in its place is not seen.",
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
        why: "What is bound is one level, and there is none between it and the next.",
    },
    Explained {
        file: "shaders/wgsl/lib/display_range.wgsl",
        before: "let stop = clamp(log2(clamp(y, 1e-10, 65504.0) / 0.18) + 5.0, 0.0, 15.0);",
        after: "let stop = clamp(log2(clamp(y, 1e-10, 65504.0) / 0.18) + 5.0, 0.0, 16.5);",
        why: "From the fifteenth stop on all colors are white.",
    },
    Explained {
        file: "shaders/wgsl/lib/gt7.wgsl",
        before: "let x = min(pow(max(code, vec3<f32>(1e-20)), vec3<f32>(1.0 / 78.84375)), vec3<f32>(1.0));",
        after: "let x = min(pow(max(code, vec3<f32>(1e-20)), vec3<f32>(1.0 / 78.84375)), vec3<f32>(1.1));",
        why: "No code is above 1; the limit is for what rounding may carry past it.",
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
        why: "It is where the two radii differ by a twentieth at the most, so that their mean is either to a fortieth.",
    },
    Explained {
        file: "shaders/wgsl/pass/post.wgsl",
        before: "return fullscreen_position(vertex, 0.0);",
        after: "return fullscreen_position(vertex, 0.1);",
        why: "It is the depth of a pass that has no depth attached.",
    },
    Explained {
        file: "shaders/wgsl/pass/scene.wgsl",
        before: "let ndc = vec2<f32>(vertex.uv.x * 2.0 - 1.0, 1.0 - vertex.uv.y * 2.0);",
        after: "let ndc = vec2<f32>(vertex.uv.x * 2.0 - 1.0, 1.0 - vertex.uv.x * 2.0);",
        why: "No projection that can be stated tilts its planes of equal depth: the distance ahead is the same all over the picture.",
    },
    Explained {
        file: "shaders/wgsl/pass/shadow_blur.wgsl",
        before: "let texel = clamp(center + shadow_blur.step * i, shadow_blur.first, shadow_blur.last);",
        after: "let texel = clamp(center - shadow_blur.step * i, shadow_blur.first, shadow_blur.last);",
        why: "Taps are as many on both sides and weigh the same.",
    },
    Explained {
        file: "shaders/wgsl/pass/taa.wgsl",
        before: "return select(vec3<f32>(uv, 1.0), vec3<f32>(place, f32(shown)), REPROJECT);",
        after: "return select(vec3<f32>(uv, 1.1), vec3<f32>(place, f32(shown)), REPROJECT);",
        why: "What reads it asks whether it is above 0.",
    },
    Explained {
        file: "shaders/wgsl/pass/taa.wgsl",
        before: "let usable = all_finite3(before) && place.z > 0.0;",
        after: "let usable = all_finite3(before) && place.z > 0.1;",
        why: "It is 0 or 1.",
    },
    Explained {
        file: "shaders/wgsl/shading/contact_shadow.wgsl",
        before: "let texel = vec2<i32>(clamp(at.xy * size, vec2<f32>(0.0), size - 1.0));",
        after: "let texel = vec2<i32>(clamp(at.xy * size, vec2<f32>(0.1), size - 1.0));",
        why: "What is below 1 is the first texel.",
    },
    Explained {
        file: "shaders/wgsl/shading/surface.wgsl",
        before: "var under = real3(0.0);",
        after: "var under = real3(0.1);",
        why: "Both branches that follow give it another value.",
    },
    Explained {
        file: "shaders/wgsl/shading/surface.wgsl",
        before: "t = normalize_or(t, vec3<f32>(1.0, 0.0, 0.0));",
        after: "",
        why: "What comes of it is made as long as one whatever length it has.",
    },
    Explained {
        file: "shaders/wgsl/shading/surface.wgsl",
        before: "let b = cross(front, t) * tangent.w;",
        after: "let b = cross(front, t) / tangent.w;",
        why: "Handedness is 1 or −1.",
    },
    Explained {
        file: "shaders/wgsl/shading/vertex.wgsl",
        before: "vec3<f32>(0.0, 0.0, 1.0),",
        after: "vec3<f32>(0.1, 0.0, 1.0),",
        why: "No triangle that covers a pixel has no area there; what stands in for its normal is not seen.",
    },
    Explained {
        file: "shaders/wgsl/shading/shadow.wgsl",
        before: "return tints[min(select(4u, cascade, cascade < CASCADES), 4u)];",
        after: "return tints[min(select(5u, cascade, cascade < CASCADES), 4u)];",
        why: "What is beyond the last is taken for the last, which is 4.",
    },
    Explained {
        file: "passes/src/upload/textures.rs",
        before: "gpu.wait()?;",
        after: "",
        why: "It waits for copies that are queued, so that their memory is free before more is queued: the same is uploaded without.",
    },
];

/// Why a fault that survived is no gap, if that is known.
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
