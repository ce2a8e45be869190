//! Vectors, quaternions and matrices as f64 arrays, independent of the crate.

use std::array::from_fn;

pub type Vector = [f64; 3];
/// x, y, z, w.
pub type Quaternion = [f64; 4];
/// Columns.
pub type Matrix = [[f64; 4]; 4];

pub const IDENTITY: Matrix = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    from_fn(|column| from_fn(|row| (0..4).map(|k| a[k][row] * b[column][k]).sum()))
}

pub fn length(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

pub fn unit<const N: usize>(v: [f64; N]) -> [f64; N] {
    v.map(|x| x / length(&v))
}

/// Returns the rotation by an angle in radians about an axis of any length.
pub fn turn(axis: Vector, angle: f64) -> Quaternion {
    let [x, y, z] = unit(axis).map(|a| a * (angle / 2.0).sin());
    [x, y, z, (angle / 2.0).cos()]
}

/// Returns translation · rotation · scale.
pub fn of_parts(t: Vector, rotation: Quaternion, s: Vector) -> Matrix {
    let [x, y, z, w] = unit(rotation);
    let columns = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)],
        [2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)],
        [2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)],
    ];
    let column = |c: usize| [columns[c][0] * s[c], columns[c][1] * s[c], columns[c][2] * s[c], 0.0];
    [column(0), column(1), column(2), [t[0], t[1], t[2], 1.0]]
}

pub fn point(m: &Matrix, p: Vector) -> Vector {
    from_fn(|row| (0..3).map(|k| m[k][row] * p[k]).sum::<f64>() + m[3][row])
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn linear(m: &Matrix) -> [Vector; 3] {
    from_fn(|column| from_fn(|row| m[column][row]))
}

pub fn determinant(m: &Matrix) -> f64 {
    let [x, y, z] = linear(m);
    let yz = cross(y, z);
    x[0] * yz[0] + x[1] * yz[1] + x[2] * yz[2]
}

/// Returns the columns of the inverse transpose of the upper left 3×3 part.
fn inverse_transpose(m: &Matrix) -> [Vector; 3] {
    let ([x, y, z], determinant) = (linear(m), determinant(m));
    [cross(y, z), cross(z, x), cross(x, y)].map(|column| column.map(|v| v / determinant))
}

/// Returns the unit normal where `m` transforms positions.
pub fn normal(m: &Matrix, n: Vector) -> Vector {
    let columns = inverse_transpose(m);
    unit(from_fn(|row| (0..3).map(|k| columns[k][row] * n[k]).sum()))
}

/// Returns the inverse of an affine matrix.
pub fn inverse(m: &Matrix) -> Matrix {
    let rows = inverse_transpose(m);
    let mut inverse: Matrix = IDENTITY;
    for column in 0..3 {
        for row in 0..3 {
            inverse[column][row] = rows[row][column];
        }
    }
    let moved = point(&inverse, [m[3][0], m[3][1], m[3][2]]);
    inverse[3] = [-moved[0], -moved[1], -moved[2], 1.0];
    inverse
}

/// Spherical interpolation along the shorter arc (glTF 2.0, appendix C.4).
pub fn slerp(a: Quaternion, b: Quaternion, share: f64) -> Quaternion {
    let (a, b) = (unit(a), unit(b));
    let dot: f64 = (0..4).map(|i| a[i] * b[i]).sum();
    let sign = if dot < 0.0 { -1.0 } else { 1.0 };
    let angle = dot.abs().min(1.0).acos();
    if angle < 1e-7 {
        return a;
    }
    let (from, to) = (((1.0 - share) * angle).sin() / angle.sin(), sign * (share * angle).sin() / angle.sin());
    from_fn(|i| from * a[i] + to * b[i])
}

/// Deterministic pseudo-random numbers from −1 to 1.
pub struct Noise(pub u64);

impl Noise {
    pub fn number(&mut self) -> f64 {
        // Constants of Knuth's MMIX generator.
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1 << 30) - 1.0
    }

    pub fn vector(&mut self, size: f64) -> Vector {
        from_fn(|_| rounded(size * self.number()))
    }

    /// Returns a rotation by up to `angle` radians.
    pub fn rotation(&mut self, angle: f64) -> Quaternion {
        let axis = [self.number(), self.number(), self.number() + 1.5];
        turn(axis, angle * self.number()).map(rounded)
    }
}

/// Returns a number rounded to 32 bits, as in a file.
pub fn rounded(number: f64) -> f64 {
    f64::from(number as f32)
}
