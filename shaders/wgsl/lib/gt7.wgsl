// Tone curve of Gran Turismo 7 for a display of 250 nits (Yasutomi, Suzuki, Uchimura, "Driving
// Toward Reality", SIGGRAPH 2025). It mixes a per-channel curve with the same curve of brightness
// at the original chroma. An input of 1 represents 100 nits.

/// Codes 0…1 of ST 2084 (PQ) of nits up to 10000.
fn pq_from_nits(nits: vec3<f32>) -> vec3<f32> {
    let y = pow(max(nits / 10000.0, vec3<f32>(1e-20)), vec3<f32>(0.1593017578125));
    let ratio = (0.8359375 + 18.8515625 * y) / (1.0 + 18.6875 * y);
    return pow(ratio, vec3<f32>(78.84375));
}

/// Nits of codes 0…1 of ST 2084.
fn nits_from_pq(code: vec3<f32>) -> vec3<f32> {
    let x = min(pow(max(code, vec3<f32>(1e-20)), vec3<f32>(1.0 / 78.84375)), vec3<f32>(1.0));
    let ratio = max(x - 0.8359375, vec3<f32>(0.0)) / (18.8515625 - 18.6875 * x);
    return 10000.0 * pow(max(ratio, vec3<f32>(1e-20)), vec3<f32>(1.0 / 0.1593017578125));
}

/// ICtCp (ITU-R BT.2100) of linear Rec.2020 in nits.
fn ictcp_from_rec2020(nits: vec3<f32>) -> vec3<f32> {
    let cones = pq_from_nits(vec3<f32>(
        dot(nits, vec3<f32>(0.41210938, 0.52392578, 0.06396484)),
        dot(nits, vec3<f32>(0.16674805, 0.72045898, 0.11279297)),
        dot(nits, vec3<f32>(0.02416992, 0.07543945, 0.90039063)),
    ));
    return vec3<f32>(
        dot(cones, vec3<f32>(0.5, 0.5, 0.0)),
        dot(cones, vec3<f32>(1.61376953, -3.32348633, 1.70971680)),
        dot(cones, vec3<f32>(4.37817383, -4.24560547, -0.13256836)),
    );
}

/// Linear Rec.2020 in nits of ICtCp.
fn rec2020_from_ictcp(ictcp: vec3<f32>) -> vec3<f32> {
    let cones = nits_from_pq(vec3<f32>(
        dot(ictcp, vec3<f32>(1.0, 0.00860904, 0.11102963)),
        dot(ictcp, vec3<f32>(1.0, -0.00860904, -0.11102963)),
        dot(ictcp, vec3<f32>(1.0, 0.56003134, -0.32062717)),
    ));
    return vec3<f32>(
        dot(cones, vec3<f32>(3.43660669, -2.50645212, 0.06984542)),
        dot(cones, vec3<f32>(-0.79132956, 1.98360045, -0.19227090)),
        dot(cones, vec3<f32>(-0.02594990, -0.09891371, 1.12486361)),
    );
}

/// The curve of one channel: a toe below 0.538, light as it is up to 1.11, a shoulder that ends
/// at 2.96 and is cut off at 2.5 (250 nits).
fn gt7_curve(x: f32) -> f32 {
    // No branch: where conditions read many uniforms, Mesa 22.3's software driver crashes.
    let shoulder = 2.9633333 - 3.3733512 * exp(-0.53956835 * x);
    let linear = smoothstep(0.0, 0.538, x);
    let toe = 0.538 * pow(max(x, 1e-10) / 0.538, 1.28);
    return select(mix(toe, x, linear), shoulder, x >= 1.11);
}

/// Rec.2020 light of the scene to Rec.2020 light of a display.
fn tone_gt7(color: vec3<f32>) -> vec3<f32> {
    let c = clamp(color, vec3<f32>(0.0), vec3<f32>(100.0));
    let skewed = vec3<f32>(gt7_curve(c.x), gt7_curve(c.y), gt7_curve(c.z));
    let before = ictcp_from_rec2020(c * 100.0);
    let after = ictcp_from_rec2020(skewed * 100.0);
    // 0.60255916 is the intensity of a white of 250 nits.
    let chroma = 1.0 - smoothstep(0.98, 1.16, before.x / 0.60255916);
    let kept = rec2020_from_ictcp(vec3<f32>(after.x, before.yz * chroma)) / 100.0;
    return min(mix(skewed, kept, 0.6), vec3<f32>(2.5)) / 2.5;
}
