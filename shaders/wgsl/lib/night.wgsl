// The Purkinje shift: in the dark, rods replace cones, and colors shift toward blue.

/// Returns the appearance of linear Rec.709 in night vision; `amount` is 0 for day to 1 for night.
/// Rods excite the opponent signals of the cones (Cao et al. 2008, with the constants of Kirk and
/// O'Brien 2011). Light is first brightened by 11.4 stops into the mesopic range, a factor of 380.
fn night_adaptation(color: vec3<f32>, amount: f32) -> vec3<f32> {
    let v = color * 380.0;
    let cones = vec3<f32>(
        dot(v, vec3<f32>(7.696847, 18.424824, 2.068096)),
        dot(v, vec3<f32>(2.431137, 18.697937, 3.012463)),
        dot(v, vec3<f32>(0.289117, 1.401833, 13.792292)),
    );
    let rods = dot(v, vec3<f32>(0.466386, 15.564362, 10.059963));
    let excited = cones + vec3<f32>(0.2, 0.2, 0.3) * rods;
    let weight = vec3<f32>(0.33 / 0.63721, 0.33 / 0.39242, 0.33 / 1.6064);
    let g = inverseSqrt(1.0 + max(weight * excited, vec3<f32>(0.0)));
    // Rod contribution to red, green and blue, by the gain of each of the three pathways.
    let added = vec3<f32>(
        dot(g, vec3<f32>(0.31945849, -0.34206805, 0.01050694)),
        dot(g, vec3<f32>(0.05809761, 0.23918254, -0.01133307)),
        dot(g, vec3<f32>(0.65921368, 0.65459800, 0.06186338)),
    );
    return color + added * (rods * amount / 380.0);
}
