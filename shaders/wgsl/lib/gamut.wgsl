// Gamut mapping: colors outside the display's gamut, mapped at constant hue.

import package::lib::primaries::{oklab_from_rec709, rec709_from_oklab};

/// Tolerance by which a channel may exceed 0…1 before gamut mapping applies; grading needs it.
const GAMUT_SLACK: f32 = 0.03;

/// Maps linear Rec.709 into 0…1 within GAMUT_SLACK. Colors outside move in OkLab, at constant hue,
/// along the line toward a gray, until they enter the gamut. The gray is Ottosson's "adaptive L0"
/// around 0.5 with alpha 0.05 ("sRGB gamut clipping", 2021). It is near the color's lightness, and
/// closer to the middle for more colorful colors.
fn map_into_gamut(color: vec3<f32>) -> vec3<f32> {
    let least = min(color.x, min(color.y, color.z));
    let most = max(color.x, max(color.y, color.z));
    let is_inside = (least >= -GAMUT_SLACK) & (most <= 1.0 + GAMUT_SLACK);
    // No branch: where conditions read many uniforms, Mesa 22.3's software driver crashes.
    let lab = oklab_from_rec709(color);
    let from_middle = lab.x - 0.5;
    let e = 0.5 + abs(from_middle) + 0.05 * length(lab.yz);
    let reach = e - sqrt(max(e * e - 2.0 * abs(from_middle), 0.0));
    let grey = vec3<f32>(0.5 * (1.0 + sign(from_middle) * reach), 0.0, 0.0);
    // Twenty halvings leave a millionth of the line.
    var inside = 0.0;
    var outside = 1.0;
    for (var i = 0; i < 20; i++) {
        let middle = 0.5 * (inside + outside);
        let c = rec709_from_oklab(mix(grey, lab, middle));
        let low = min(c.x, min(c.y, c.z));
        let high = max(c.x, max(c.y, c.z));
        let is_valid = (low >= 0.0) & (high <= 1.0);
        inside = select(inside, middle, is_valid);
        outside = select(middle, outside, is_valid);
    }
    return select(rec709_from_oklab(mix(grey, lab, inside)), color, is_inside);
}
