// Diffuse reflection.

import package::lib::math::PI;
import package::lib::real::real;

/// Lambert's BRDF for albedo one, in 1/sr. Its white furnace is exactly one; Burley's lies
/// between 0.60 and 1.46, which is why it is not used.
fn fd_lambert() -> real {
    return real(1.0 / PI);
}

/// Lambert's transmission times cosine for albedo one, in 1/sr: of light from behind, whose `nol`
/// is below 0. Light from the front is reflected and not transmitted.
fn fd_transmitted(nol: real) -> real {
    return saturate(-nol) * fd_lambert();
}
