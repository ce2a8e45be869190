// Separable blur at half resolution. One shader handles both axes: a workgroup loads a stretch of a line and its borders
// into shared memory, and each texel takes its 25 taps from there.

@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var result: texture_storage_2d<rgba16float, write>;
// Weights of the center and of the 12 texels on each side, four per vector.
@group(0) @binding(2) var<uniform> weights: array<vec4f, 4>;

override DOWN: bool = false;
const RADIUS = 12;
const STRETCH = 64;

// Downsamples by averaging 2x2 texels, clamped at odd edges.
@compute @workgroup_size(8, 8) fn halve(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(result)) {
        return;
    }
    let last = textureDimensions(image) - 1u;
    var sum = vec4f();
    for (var corner = 0u; corner < 4u; corner++) {
        let at = id.xy * 2u + vec2u(corner & 1u, corner >> 1u);
        sum += textureLoad(image, min(at, last), 0);
    }
    textureStore(result, id.xy, 0.25 * sum);
}

var<workgroup> stretch: array<vec4f, 88>; // STRETCH + 2 · RADIUS

fn place(along: i32, line: i32) -> vec2i {
    return select(vec2i(along, line), vec2i(line, along), DOWN);
}

@compute @workgroup_size(64) fn sweep(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let first = i32(group.x) * STRETCH;
    let line = i32(group.y);
    let last = vec2i(textureDimensions(image)) - 1;
    for (var i = i32(local); i < STRETCH + 2 * RADIUS; i += STRETCH) {
        stretch[i] = textureLoad(image, clamp(place(first + i - RADIUS, line), vec2i(), last), 0);
    }
    workgroupBarrier();
    let own = i32(local) + RADIUS;
    var sum = weights[0].x * stretch[own];
    for (var tap = 1; tap <= RADIUS; tap++) {
        sum += weights[tap / 4][tap % 4] * (stretch[own - tap] + stretch[own + tap]);
    }
    let at = place(first + i32(local), line);
    if all(at <= last) {
        textureStore(result, at, sum);
    }
}
