// Upscaling that follows edges: EASU of AMD's FidelityFX Super Resolution 1.0 (2021).
//
// Twelve texels about a place are weighted by an ellipse that is drawn out along the edge through
// them. Colors are encoded for a display, 0 to 1.

/// Returns the edge through a texel, estimated from its four neighbors: the direction in which luma
/// changes, and in z its straightness, 0…2.
fn edge_of(middle: f32, up: f32, left: f32, right: f32, down: f32) -> vec3<f32> {
    let along = vec2<f32>(right - left, down - up);
    let steep_x = max(abs(right - middle), abs(middle - left));
    let steep_y = max(abs(down - middle), abs(middle - up));
    let steep = max(vec2<f32>(steep_x, steep_y), vec2<f32>(1e-5));
    let straight = min(abs(along) / steep, vec2<f32>(1.0));
    return vec3<f32>(along, dot(straight, straight));
}

/// The ellipse of an edge: (x, y) its unit direction, (z, w) how much it is drawn in along that and
/// across. `edge` is the sum of `edge_of`; without a direction it is a circle.
fn kernel_of(edge: vec3<f32>) -> vec4<f32> {
    let length2 = dot(edge.xy, edge.xy);
    let none = length2 < 1.0 / 32768.0;
    let direction = select(edge.xy * inverseSqrt(max(length2, 1e-12)), vec2<f32>(1.0, 0.0), none);
    let half = 0.5 * edge.z;
    let strength = half * half;
    let stretch = 1.0 / max(abs(direction.x), abs(direction.y));
    return vec4<f32>(direction, 1.0 + (stretch - 1.0) * strength, 1.0 - 0.5 * strength);
}

/// Weight of a texel so far from the place, in texels: near to Lanczos's of two lobes, the second
/// the weaker the straighter the edge is.
fn kernel_weight(offset: vec2<f32>, kernel: vec4<f32>, straight: f32) -> f32 {
    let turned = vec2<f32>(dot(offset, kernel.xy), dot(offset, vec2<f32>(-kernel.y, kernel.x)));
    let half = 0.5 * straight;
    let lobe = 0.5 - 0.29 * half * half;
    let way = turned * kernel.zw;
    let distance2 = min(dot(way, way), 1.0 / lobe);
    let base = 0.4 * distance2 - 1.0;
    let window = lobe * distance2 - 1.0;
    return (1.5625 * base * base - 0.5625) * window * window;
}
