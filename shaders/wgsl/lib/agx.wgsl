// AgX (Sobotka, 2022): a sigmoid of the logarithm in inset primaries, so that bright colors
// desaturate as on film.

const AGX_PLAIN: u32 = 0u;
const AGX_GOLDEN: u32 = 1u;
const AGX_PUNCHY: u32 = 2u;

/// Evaluates Wrensch's polynomial for the sigmoid of AgX over its logarithmic range, 0…1 to 0…1.
fn agx_sigmoid(x: vec3<f32>) -> vec3<f32> {
    let x2 = x * x;
    let x4 = x2 * x2;
    let odd = x * (-0.1718 - 28.72 * x2 - 126.7 * x4 - 17.86 * x4 * x2);
    return 0.002857 + odd + x2 * (4.361 + 92.06 * x2 + 78.01 * x4);
}

/// Applies a look to AgX's encoded color: slope, power and saturation.
fn agx_look(color: vec3<f32>, look: u32) -> vec3<f32> {
    var slope = vec3<f32>(1.0);
    var power = 1.0;
    var saturation = 1.0;
    if look == AGX_GOLDEN {
        slope = vec3<f32>(1.0, 0.9, 0.5);
        power = 0.8;
        saturation = 1.3;
    } else if look == AGX_PUNCHY {
        power = 1.35;
        saturation = 1.4;
    }
    let luma = dot(color, vec3<f32>(0.2126, 0.7152, 0.0722));
    let graded = pow(max(color * slope, vec3<f32>(1e-10)), vec3<f32>(power));
    return luma + saturation * (graded - luma);
}

/// Tone maps scene light to display light, both in Rec.2020, with Blender's matrices: ten stops
/// below 18 % gray to six and a half above.
fn tone_agx(color: vec3<f32>, look: u32) -> vec3<f32> {
    let c = clamp(color, vec3<f32>(0.0), vec3<f32>(65504.0));
    let inset = vec3<f32>(
        dot(c, vec3<f32>(0.85662715, 0.09512124, 0.04825161)),
        dot(c, vec3<f32>(0.13731897, 0.76124199, 0.10143904)),
        dot(c, vec3<f32>(0.11189821, 0.07679942, 0.81130237)),
    );
    let stops = log2(max(inset, vec3<f32>(1e-10)));
    let x = saturate((stops + 12.47393) / (4.026069 + 12.47393));
    let v = agx_look(agx_sigmoid(x), look);
    let shown = vec3<f32>(
        dot(v, vec3<f32>(1.12710058, -0.11060664, -0.01649394)),
        dot(v, vec3<f32>(-0.14132976, 1.15782370, -0.01649394)),
        dot(v, vec3<f32>(-0.14132976, -0.11060664, 1.25193641)),
    );
    return pow(max(shown, vec3<f32>(1e-10)), vec3<f32>(2.2));
}
