//! Execution of a case: its shader, inputs and result check.

use super::super::quantize::{FLOAT16_MAX, quantize_mantissa};
use super::case::{Bound, Case, Deviation, Disagreement, Domain};
use super::domain::splitmix;
use framegraph_shaders::{Feature, Features, Module, Shader, ShaderError, resolve};

/// Functions that a [`Case::call`] may use to read several of its inputs at once.
const READERS: &str = "\
fn v2(i: u32) -> vec2<f32> { return vec2<f32>(x[i], x[i + 1u]); }
fn v3(i: u32) -> vec3<f32> { return vec3<f32>(x[i], x[i + 1u], x[i + 2u]); }
fn v4(i: u32) -> vec4<f32> { return vec4<f32>(v3(i), x[i + 3u]); }
fn rows5(i: u32) -> array<vec4<f32>, 5> {
    var rows: array<vec4<f32>, 5>;
    for (var k = 0u; k < 5u; k++) { rows[k] = vec4<f32>(v3(i + 3u * k), 0.0); }
    return rows;
}
fn rows4(i: u32) -> array<vec4<f32>, 4> {
    var rows: array<vec4<f32>, 4>;
    for (var k = 0u; k < 4u; k++) { rows[k] = vec4<f32>(v3(i + 3u * k), 0.0); }
    return rows;
}
fn rows18(i: u32) -> array<vec4<f32>, 18> {
    var rows: array<vec4<f32>, 18>;
    for (var k = 0u; k < 18u; k++) { rows[k] = vec4<f32>(v3(i + 3u * k), 0.0); }
    return rows;
}
fn rows9(i: u32) -> array<vec4<f32>, 9> {
    var rows: array<vec4<f32>, 9>;
    for (var k = 0u; k < 9u; k++) { rows[k] = vec4<f32>(v3(i + 3u * k), 0.0); }
    return rows;
}
";

/// Rounds to the nearest half float.
fn half_float(x: f64) -> f64 {
    quantize_mantissa(x.clamp(-FLOAT16_MAX, FLOAT16_MAX), 10, false)
}

/// Appends combination `index` to `numbers`: one point of each list.
fn combine(lists: &[Vec<Vec<f64>>], mut index: usize, numbers: &mut Vec<f64>) {
    for list in lists {
        numbers.extend(&list[index % list.len()]);
        index /= list.len();
    }
}

impl Case {
    /// Returns the number of input values per evaluation.
    pub fn input_width(&self) -> usize {
        self.parameters.iter().map(|p| p.width()).sum()
    }

    /// Returns a compute shader with entry point `evaluate` and workgroups of 64. Group 0 has the inputs at binding 0
    /// (read) and the results at binding 1 (written), one row after the other.
    ///
    /// # Errors
    ///
    /// If `call` or `results` is invalid, which a test of this crate rules out.
    pub fn shader(&self) -> Result<Shader, ShaderError> {
        self.built(self.in_half)
    }

    fn built(&self, in_half: bool) -> Result<Shader, ShaderError> {
        let features = Features::NONE.with_if(Feature::HALF, in_half);
        resolve(&Module::new("case.wgsl", &self.wgsl()), &features, &[])
    }

    /// Returns the call, with the parameters in order if the case does not state them. A case with other parameters of the
    /// same function needs this text as its [`Case::call`].
    pub fn expression(&self) -> String {
        if !self.call.is_empty() {
            return self.call.to_owned();
        }
        let mut at = 0;
        let mut arguments = Vec::new();
        let mut argument = |width: usize, is_count: bool| {
            let vector = if width > 1 { width.to_string() } else { String::new() };
            let value = if width > 1 { format!("v{width}({at}u)") } else { format!("x[{at}]") };
            at += width;
            arguments.push(match self.half {
                _ if is_count => format!("u32({value})"),
                Some(_) => format!("real{vector}({value})"),
                None => value,
            });
        };
        for parameter in self.parameters {
            match parameter {
                Domain::Directions(..) => {
                    argument(3, false);
                    argument(3, false);
                }
                other => argument(other.width(), matches!(other, Domain::Count(_))),
            }
        }
        format!("{}({})", self.function, arguments.join(", "))
    }

    fn wgsl(&self) -> String {
        let (Self { file, function, .. }, call) = (self, self.expression());
        let (inputs, outputs) = (self.input_width(), self.results.len());
        let mut text = format!(
            "import package::lib::{file}::{function};\n\
             import package::lib::real::{{real, real2, real3}};\n\
             import package::lib::standard_surface::StandardSurface;\n\
             import package::lib::unproject::Projection;\n\
             @group(0) @binding(0) var<storage, read> numbers: array<f32>;\n\
             @group(0) @binding(1) var<storage, read_write> results: array<f32>;\n\
             var<private> x: array<f32, {inputs}>;\n\
             {READERS}\
             @compute @workgroup_size(64)\n\
             fn evaluate(@builtin(global_invocation_id) id: vec3<u32>) {{\n    \
                 if id.x >= arrayLength(&numbers) / {inputs}u {{ return; }}\n    \
                 for (var i = 0u; i < {inputs}u; i++) {{ x[i] = numbers[id.x * {inputs}u + i]; }}\n    \
                 let r = {call};\n"
        );
        for (i, result) in self.results.iter().enumerate() {
            text.push_str(&format!("    results[id.x * {outputs}u + {i}u] = {result};\n"));
        }
        text.push_str("}\n");
        text
    }

    /// Returns the inputs: first the hard combinations, then points spread over the domain. The values are
    /// deterministic.
    pub fn inputs(&self, count: usize) -> Vec<f32> {
        let specials: Vec<Vec<Vec<f64>>> = self.parameters.iter().map(|p| p.specials()).collect();
        let total: usize = specials.iter().map(Vec::len).product();
        let corners = total.min(count / 4);
        let in_half = self.in_half;
        let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
        let mut random = move || splitmix(&mut seed);
        let mut rows = Vec::with_capacity(count * self.input_width());
        for row in 0..count {
            let mut numbers = Vec::new();
            if row < corners {
                // Spread evenly over the combinations if there are too many.
                combine(&specials, row * total / corners, &mut numbers);
            } else {
                self.parameters.iter().for_each(|p| p.sample(&mut random, &mut numbers));
            }
            rows.extend(numbers.into_iter().map(|x| if in_half { half_float(x) as f32 } else { x as f32 }));
        }
        rows
    }

    /// Returns all combinations of hard values of the domains, or `most` of them, spread evenly. Values are rounded to
    /// half floats in the half-float build.
    pub fn hard_inputs(&self, most: usize) -> Vec<f32> {
        let lists: Vec<Vec<Vec<f64>>> = self.parameters.iter().map(|p| p.hard()).collect();
        let total = lists.iter().fold(1_usize, |product, list| product.saturating_mul(list.len()));
        let count = total.min(most);
        let mut numbers = Vec::new();
        for row in 0..count {
            // A prime that divides no product of such lengths: each combination appears once before any repeats.
            combine(&lists, (row as u128 * 2_654_435_761 % total as u128) as usize, &mut numbers);
        }
        // NaN and values outside the range of half floats are passed unchanged.
        let rounded = |x: f64| if self.in_half && x.abs() <= FLOAT16_MAX { half_float(x) as f32 } else { x as f32 };
        numbers.into_iter().map(rounded).collect()
    }

    /// Compares results with the mirror, row by row.
    ///
    /// # Errors
    ///
    /// Returns the first point outside the bound; NaN is always outside.
    ///
    /// # Panics
    ///
    /// If `results` does not hold one row for each row of `inputs`.
    pub fn check(&self, inputs: &[f32], results: &[f32]) -> Result<Deviation, Box<Disagreement>> {
        let rows = inputs.chunks_exact(self.input_width());
        assert_eq!(rows.len() * self.results.len(), results.len(), "{}", self.function);
        let mut worst = Deviation::default();
        for (row, got) in rows.zip(results.chunks_exact(self.results.len())) {
            let numbers: Vec<f64> = row.iter().map(|x| f64::from(*x)).collect();
            let expected = (self.mirror)(&numbers);
            for (result, (gpu, mirror)) in got.iter().zip(expected).enumerate() {
                let Bound { absolute, relative, period } = self.bound;
                let bound = absolute + relative * mirror.abs();
                let mut apart = (f64::from(*gpu) - mirror).abs();
                if period > 0.0 {
                    apart = (apart % period).min(period - apart % period);
                }
                if apart.is_nan() || apart > bound {
                    return Err(Box::new(Disagreement {
                        function: self.function,
                        inputs: row.to_vec(),
                        result,
                        gpu: *gpu,
                        mirror,
                        bound,
                    }));
                }
                worst.absolute = worst.absolute.max(apart);
                if bound > 0.0 {
                    worst.of_bound = worst.of_bound.max(apart / bound);
                }
            }
        }
        Ok(worst)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{all, half};
    use super::*;

    fn perfect(case: &Case, inputs: &[f32]) -> Vec<f32> {
        let rows = inputs.chunks_exact(case.input_width());
        let results = rows.flat_map(|row| (case.mirror)(&row.iter().map(|x| f64::from(*x)).collect::<Vec<_>>()));
        results.map(|y| y as f32).collect()
    }

    #[test]
    fn mirrors_take_what_domains_give_and_stay_finite() {
        for case in all().copied().chain(half()) {
            let inputs = case.inputs(256);
            let results = perfect(&case, &inputs);
            assert_eq!(results.len(), 256 * case.results.len(), "{}", case.function);
            assert!(results.iter().all(|y| y.is_finite()), "{}", case.function);
            // Rounding the mirror to f32 must already lie within the bound.
            if let Err(disagreement) = case.check(&inputs, &results) {
                panic!("{disagreement}");
            }
        }
    }

    #[test]
    fn a_wrong_result_is_found() {
        for case in all().copied().chain(half()) {
            let inputs = case.inputs(64);
            let mut results = perfect(&case, &inputs);
            let spoilt = results.len() / 2;
            results[spoilt] = f32::NAN;
            assert!(case.check(&inputs, &results).is_err(), "{}: NaN", case.function);
            let mut results = perfect(&case, &inputs);
            for y in &mut results {
                *y = *y * 1.1 + 0.3;
            }
            assert!(case.check(&inputs, &results).is_err(), "{}: +10 %", case.function);
        }
    }

    #[test]
    fn every_case_makes_a_valid_shader() {
        for case in all().copied().chain(half()) {
            if let Err(error) = case.shader() {
                panic!("{}: {error}\n{}", case.function, case.wgsl());
            }
        }
    }

    #[test]
    fn half_floats_are_used_where_a_case_says_so_and_nowhere_else() {
        let text = |case: &Case, in_half| {
            case.built(in_half).unwrap_or_else(|error| panic!("{}: {error}", case.function)).wgsl
        };
        for case in all() {
            let (full, small) = (text(case, false), text(case, true));
            assert!(!full.contains("f16"), "{}:\n{full}", case.function);
            if case.half.is_some() {
                assert!(small.contains("= f16;") || small.contains("vec3<f16>;"), "{}:\n{small}", case.function);
                assert_eq!(small.matches("enable f16;").count(), 1, "{}", case.function);
            } else {
                assert_eq!(small.replace("enable f16;\n", ""), full, "{}", case.function);
            }
        }
    }

    #[test]
    fn numbers_of_the_half_build_are_half_floats() {
        for case in half() {
            for x in case.inputs(64) {
                assert_eq!(half_float(f64::from(x)) as f32, x, "{}", case.function);
            }
        }
    }

    #[test]
    fn inputs_are_the_same_every_time() {
        let case = all().next().unwrap();
        assert_eq!(case.inputs(100), case.inputs(100));
    }
}
