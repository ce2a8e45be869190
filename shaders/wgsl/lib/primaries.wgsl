// Linear light in other primaries. All have the white D65 but those of ACES, to which nothing is
// adapted here.

/// Rec.2020 from Rec.709 (ITU-R BT.2087).
fn rec2020_from_rec709(color: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        dot(color, vec3<f32>(0.6274039, 0.3292830, 0.0433131)),
        dot(color, vec3<f32>(0.0690973, 0.9195404, 0.0113623)),
        dot(color, vec3<f32>(0.0163914, 0.0880133, 0.8955953)),
    );
}

/// Rec.709 from Rec.2020; negative where Rec.709 does not reach.
fn rec709_from_rec2020(color: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        dot(color, vec3<f32>(1.6604910, -0.5876411, -0.0728499)),
        dot(color, vec3<f32>(-0.1245505, 1.1328999, -0.0083494)),
        dot(color, vec3<f32>(-0.0181508, -0.1005789, 1.1187297)),
    );
}

/// OkLab (Ottosson, 2020) of linear Rec.709: lightness, green to red, blue to yellow.
fn oklab_from_rec709(color: vec3<f32>) -> vec3<f32> {
    let cones = vec3<f32>(
        dot(color, vec3<f32>(0.4122214708, 0.5363325363, 0.0514459929)),
        dot(color, vec3<f32>(0.2119034982, 0.6806995451, 0.1073969566)),
        dot(color, vec3<f32>(0.0883024619, 0.2817188376, 0.6299787005)),
    );
    let root = sign(cones) * pow(max(abs(cones), vec3<f32>(1e-30)), vec3<f32>(1.0 / 3.0));
    return vec3<f32>(
        dot(root, vec3<f32>(0.2104542553, 0.7936177850, -0.0040720468)),
        dot(root, vec3<f32>(1.9779984951, -2.4285922050, 0.4505937099)),
        dot(root, vec3<f32>(0.0259040371, 0.7827717662, -0.8086757660)),
    );
}

/// Linear Rec.709 of OkLab.
fn rec709_from_oklab(lab: vec3<f32>) -> vec3<f32> {
    let root = vec3<f32>(
        dot(lab, vec3<f32>(1.0, 0.3963377774, 0.2158037573)),
        dot(lab, vec3<f32>(1.0, -0.1055613458, -0.0638541728)),
        dot(lab, vec3<f32>(1.0, -0.0894841775, -1.2914855480)),
    );
    let cones = root * root * root;
    return vec3<f32>(
        dot(cones, vec3<f32>(4.0767416621, -3.3077115913, 0.2309699292)),
        dot(cones, vec3<f32>(-1.2684380046, 2.6097574011, -0.3413193965)),
        dot(cones, vec3<f32>(-0.0041960863, -0.7034186147, 1.7076147010)),
    );
}
