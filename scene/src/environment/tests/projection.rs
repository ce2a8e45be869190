//! Maps and spherical harmonics compared with closed forms and brute-force integration.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use crate::environment::*;

/// Returns directions spread evenly over the sphere (a Fibonacci lattice).
fn directions(count: u32) -> impl Iterator<Item = DVec3> {
    (0..count).map(move |i| {
        let y = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let (sin, cos) = (f64::from(i) * 2.399_963_229_728_653).sin_cos();
        let ring = (1.0 - y * y).sqrt();
        DVec3::new(ring * cos, y, ring * sin)
    })
}

#[test]
fn the_map_has_the_stated_orientation_and_round_trips() {
    for (uv, direction) in [
        (DVec2::new(0.5, 0.5), DVec3::NEG_Z),
        (DVec2::new(0.75, 0.5), DVec3::X),
        (DVec2::new(0.25, 0.5), DVec3::NEG_X),
        (DVec2::new(0.5, 0.0), DVec3::Y),
    ] {
        assert!((direction_from_equirect_uv(uv) - direction).length() < 1e-12, "{uv}");
        assert!((equirect_uv_from_direction(direction) - uv).length() < 1e-12, "{uv}");
    }
    for direction in directions(500) {
        let back = direction_from_equirect_uv(equirect_uv_from_direction(direction));
        assert!((back - direction).length() < 1e-9);
    }
}

#[test]
fn solid_angles_cover_the_sphere_and_the_basis_is_orthonormal() {
    let map = EquirectMap::from_fn(256, 128, |_| DVec3::ONE);
    let mut whole = 0.0;
    let mut gram = [[0.0; 25]; 25];
    let scale = sh_basis_scale();
    map.for_each_texel(|direction, solid_angle, _| {
        whole += solid_angle;
        let p = polynomials(direction);
        for i in 0..25 {
            for j in 0..25 {
                gram[i][j] += p[i] * scale[i] * p[j] * scale[j] * solid_angle;
            }
        }
    });
    assert!((whole - 4.0 * PI).abs() < 1e-9);
    for (i, row) in gram.iter().enumerate() {
        for (j, value) in row.iter().enumerate() {
            let exact = if i == j { 1.0 } else { 0.0 };
            // Error of the midpoint rule for degree-8 polynomials at 128 rows.
            assert!((value - exact).abs() < 2e-3, "{i} {j}: {value}");
        }
    }
}

#[test]
fn a_constant_environment_is_its_own_irradiance() {
    let color = DVec3::new(0.5, 2.0, 7.0);
    let map = EquirectMap::from_fn(64, 32, |_| color);
    assert!((map.average() - color).length() < 1e-6);
    for bands in [ShBands::Two, ShBands::Three, ShBands::Five] {
        let sh = Sh::project(&map, bands);
        let factors = sh.irradiance_over_pi();
        assert_eq!(factors.len(), bands.coefficients());
        for (i, factor) in factors.iter().enumerate() {
            let exact = if i == 0 { color } else { DVec3::ZERO };
            let error = (glam::Vec3::from(*factor).as_dvec3() - exact).length();
            // Rounding of the factors to f32.
            assert!(error < 1e-6, "{i}: {factor:?}");
        }
    }
}

/// A cosine lobe max(0, d·a): irradiance/π for the facing normal is 2/3. The coefficients are those of the cosine,
/// π/√(4π) and so on.
#[test]
fn a_cosine_lobe_has_its_known_coefficients() {
    let axis = DVec3::new(1.0, 2.0, -2.0) / 3.0;
    let map = EquirectMap::from_fn(512, 256, |d| DVec3::splat(d.dot(axis).max(0.0)));
    let sh = Sh::project(&map, ShBands::Three);
    let scale = sh_basis_scale();
    let p = polynomials(axis);
    for (i, c) in sh.radiance_coefficients().iter().enumerate() {
        let cosine = [PI, 2.0 * PI / 3.0, PI / 4.0][i.isqrt()];
        let exact = cosine * scale[i] * p[i];
        assert!((c.x - exact).abs() < 2e-4, "{i}: {} for {exact}", c.x);
    }
    // ∫ cos² over the hemisphere / π = 2/3; three bands contain 1/4 + 1/3 + 5/64 of it.
    let exact = map.irradiance(axis).x / PI;
    assert!((exact - 2.0 / 3.0).abs() < 1e-3);
    let three = sh.irradiance_over_pi_at(axis).x;
    assert!((three - (0.25 + 1.0 / 3.0 + 5.0 / 64.0)).abs() < 1e-3, "{three}");
}

/// One bright texel: every coefficient is the basis there times its energy. Irradiance errors relative to the peak are
/// +9.4 % and −4.0 % with 3 bands, 5.9 % and −3.1 % with 5, and 25 % and −25 % with 2.
#[test]
fn a_delta_sun_rings_as_much_as_theory_says() {
    let sun = direction_from_equirect_uv(DVec2::new(100.5 / 256.0, 40.5 / 128.0));
    let map = EquirectMap::from_fn(256, 128, |d| DVec3::splat(if (d - sun).length() < 1e-9 { 1.0 } else { 0.0 }));
    let mut energy = 0.0;
    map.for_each_texel(|_, solid_angle, radiance| energy += solid_angle * radiance.x);
    assert!(energy > 0.0);
    for (bands, worst, lowest) in
        [(ShBands::Two, 0.25, -0.25), (ShBands::Three, 0.094, -0.040), (ShBands::Five, 0.059, -0.031)]
    {
        let sh = Sh::project(&map, bands);
        let (mut error, mut least) = (0.0_f64, 0.0_f64);
        for normal in directions(4000).chain([sun, -sun]) {
            let exact = normal.dot(sun).max(0.0);
            let got = sh.irradiance_over_pi_at(normal).x * PI / energy;
            error = error.max((got - exact).abs());
            least = least.min(got);
        }
        assert!((error - worst).abs() < 0.004, "{bands:?}: worst {error}");
        assert!((least - lowest).abs() < 0.004, "{bands:?}: lowest {least}");
    }
}

/// Three bands are compared with the sum over all texels of a sky without sun. The polynomial form for shaders is
/// compared with the f64 sum.
#[test]
fn sky_irradiance_agrees_with_brute_force() {
    let sky = Sky::default().environment(128).expect("the default sky");
    let three = Sh::project(&sky.map, ShBands::Three);
    let five = Sh::project(&sky.map, ShBands::Five);
    let factors = three.irradiance_over_pi();
    let normals: Vec<DVec3> = directions(60).collect();
    let exact: Vec<DVec3> = normals.iter().map(|n| sky.map.irradiance(*n) / PI).collect();
    let peak = exact.iter().map(|e| e.max_element()).fold(0.0, f64::max);
    let worst = |sh: &Sh| {
        let errors = normals.iter().zip(&exact).map(|(n, e)| (sh.irradiance_over_pi_at(*n) - *e).abs().max_element());
        errors.fold(0.0, f64::max) / peak
    };
    // A sky with its bright ring around the sun lies between the table's gradient (0.57 %, 0.14 %) and its disc of 30°
    // (3.5 %, 1.0 %).
    assert!(worst(&three) < 0.035, "{}", worst(&three));
    assert!(worst(&five) < 0.010, "{}", worst(&five));
    for normal in normals {
        let p = polynomials(normal);
        let shader: DVec3 = factors.iter().zip(p).map(|(f, p)| glam::Vec3::from(*f).as_dvec3() * p).sum();
        let difference = (shader - three.irradiance_over_pi_at(normal)).length();
        // Rounding of nine f32 products.
        assert!(difference < 1e-6 * peak * 9.0, "{normal}");
    }
}
