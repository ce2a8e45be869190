// Scalar constants and powers shared by the library.

import package::lib::real::real;

/// Ratio of a circle's circumference to its diameter.
const PI: f32 = 3.14159265358979;

/// x².
fn sq(x: f32) -> f32 {
    return x * x;
}

/// x⁵ by three multiplications. `pow(x, 5.0)` is NaN for a negative x, and x is negative
/// whenever a dot product of two unit vectors rounds past one (accuracy: hard case 6).
fn pow5(x: real) -> real {
    let x2 = x * x;
    return x2 * x2 * x;
}
