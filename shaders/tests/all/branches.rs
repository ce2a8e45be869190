//! Branches and uniform buffers.
//!
//! Mesa's software driver follows the condition of a branch back to the uniform buffers it is computed from. It keeps room for
//! the first three buffers of a stage: the fourth overwrites its counters, and drawing crashes (Mesa 22.3,
//! `nir_inline_uniforms.c`).

use std::collections::{BTreeMap, BTreeSet};

use framegraph_shaders::{Feature, Features, resolve};
use naga::{AddressSpace, Block, Expression, Function, GlobalVariable, Handle, Module, Statement};

use crate::variants;

/// Uniform buffers of a stage, in the order of group and binding, that a condition may be computed from.
const MAX_DECIDING: usize = 3;

/// Uniform buffers as bits, by the index of the global variable; and [`VARYING`].
type Buffers = u128;

/// The value differs from pixel to pixel: inputs, texels, and elements of storage buffers.
const VARYING: Buffers = 1 << 127;

/// Follows values from uniform buffers to conditions.
struct Walk<'a> {
    module: &'a Module,
    /// Buffers that reach each private variable.
    private: BTreeMap<usize, Buffers>,
    /// Buffers that conditions are computed from, with the functions of the conditions. The driver stops at values that vary
    /// from pixel to pixel, and values of the material meet them before most branches. Buffers outside of the first group
    /// therefore count only where the condition is the same for all pixels.
    found: BTreeMap<usize, BTreeSet<String>>,
}

/// One call of a function.
struct Call<'a> {
    function: &'a Function,
    arguments: Vec<Buffers>,
    locals: BTreeMap<usize, Buffers>,
    results: BTreeMap<usize, Buffers>,
    returned: Buffers,
}

impl<'a> Walk<'a> {
    fn global(&self, handle: Handle<GlobalVariable>) -> Buffers {
        match self.module.global_variables[handle].space {
            AddressSpace::Uniform => 1 << handle.index(),
            AddressSpace::Storage { .. } => VARYING,
            _ => self.private.get(&handle.index()).copied().unwrap_or(0),
        }
    }

    /// Buffers that an expression is computed from by arithmetic alone: those behind texels and storage do not count.
    fn of(&self, call: &Call<'a>, handle: Handle<Expression>) -> Buffers {
        let of = |handle: &Handle<Expression>| self.of(call, *handle);
        match &call.function.expressions[handle] {
            Expression::GlobalVariable(global) => self.global(*global),
            Expression::LocalVariable(local) => call.locals.get(&local.index()).copied().unwrap_or(0),
            Expression::FunctionArgument(number) => call.arguments[*number as usize],
            Expression::CallResult(_) => call.results.get(&handle.index()).copied().unwrap_or(0),
            Expression::Load { pointer } => of(pointer),
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => of(base),
            Expression::Splat { value, .. } => of(value),
            Expression::Swizzle { vector, .. } => of(vector),
            Expression::Compose { components, .. } => components.iter().fold(0, |all, part| all | of(part)),
            Expression::Unary { expr, .. } | Expression::As { expr, .. } | Expression::Derivative { expr, .. } => {
                of(expr)
            }
            Expression::Binary { left, right, .. } => of(left) | of(right),
            Expression::Select { condition, accept, reject } => of(condition) | of(accept) | of(reject),
            Expression::Relational { argument, .. } => of(argument),
            Expression::Math { arg, arg1, arg2, arg3, .. } => [Some(arg), arg1.as_ref(), arg2.as_ref(), arg3.as_ref()]
                .into_iter()
                .flatten()
                .fold(0, |all, arg| all | of(arg)),
            Expression::Literal(_) | Expression::Constant(_) | Expression::Override(_) | Expression::ZeroValue(_) => 0,
            _ => VARYING,
        }
    }

    /// The variable that a pointer leads to gains `buffers`.
    fn store(&mut self, call: &mut Call<'a>, pointer: Handle<Expression>, buffers: Buffers) {
        match &call.function.expressions[pointer] {
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => self.store(call, *base, buffers),
            Expression::LocalVariable(local) => *call.locals.entry(local.index()).or_insert(0) |= buffers,
            Expression::GlobalVariable(global) => *self.private.entry(global.index()).or_insert(0) |= buffers,
            _ => {}
        }
    }

    fn decides(&mut self, call: &Call<'a>, condition: Handle<Expression>) {
        let name = call.function.name.clone().unwrap_or_else(|| "an entry point".to_owned());
        let buffers = self.of(call, condition);
        for (handle, global) in self.module.global_variables.iter() {
            let number = handle.index();
            let is_first = global.binding.is_some_and(|binding| binding.group == 0);
            if global.space != AddressSpace::Uniform
                || buffers >> number & 1 == 0
                || !is_first && buffers & VARYING != 0
            {
                continue;
            }
            self.found.entry(number).or_default().insert(name.clone());
        }
    }

    fn block(&mut self, call: &mut Call<'a>, block: &'a Block) {
        for statement in block {
            match statement {
                Statement::Block(inner) => self.block(call, inner),
                Statement::If { condition, accept, reject } => {
                    self.decides(call, *condition);
                    self.block(call, accept);
                    self.block(call, reject);
                }
                Statement::Switch { selector, cases } => {
                    self.decides(call, *selector);
                    cases.iter().for_each(|case| self.block(call, &case.body));
                }
                Statement::Loop { body, continuing, break_if } => {
                    self.block(call, body);
                    self.block(call, continuing);
                    if let Some(condition) = break_if {
                        self.decides(call, *condition);
                    }
                }
                Statement::Return { value: Some(value) } => call.returned |= self.of(call, *value),
                Statement::Store { pointer, value } => {
                    let buffers = self.of(call, *value);
                    self.store(call, *pointer, buffers);
                }
                Statement::Call { function, arguments, result } => {
                    let arguments = arguments.iter().map(|argument| self.of(call, *argument)).collect();
                    let returned = self.call(&self.module.functions[*function], arguments);
                    if let Some(result) = result {
                        call.results.insert(result.index(), returned);
                    }
                }
                _ => {}
            }
        }
    }

    /// Walks through a function, and returns the buffers that its result is computed from.
    fn call(&mut self, function: &'a Function, arguments: Vec<Buffers>) -> Buffers {
        let (locals, results) = (BTreeMap::new(), BTreeMap::new());
        let mut call = Call { function, arguments, locals, results, returned: 0 };
        for (handle, local) in function.local_variables.iter() {
            let first = local.init.map_or(0, |init| self.of(&call, init));
            call.locals.insert(handle.index(), first);
        }
        self.block(&mut call, &function.body);
        call.returned
    }
}

/// Uniform buffers after the third of the entry point that one of its conditions is computed from, in words.
fn late_deciders(wgsl: &str, entry: &str) -> Vec<String> {
    let module = naga::front::wgsl::parse_str(wgsl).unwrap();
    let mut info = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all());
    let info = info.validate(&module).unwrap();
    let number = module.entry_points.iter().position(|own| own.name == entry).unwrap();
    let used = info.get_entry_point(number);
    let uniforms = module
        .global_variables
        .iter()
        .filter(|(handle, global)| global.space == AddressSpace::Uniform && !used[*handle].is_empty());
    let mut order: Vec<_> = uniforms.map(|(handle, global)| (global.binding, handle)).collect();
    order.sort_by_key(|(binding, _)| binding.map(|binding| (binding.group, binding.binding)));
    let function = &module.entry_points[number].function;
    let mut walk = Walk { module: &module, private: BTreeMap::new(), found: BTreeMap::new() };
    walk.call(function, vec![VARYING; function.arguments.len()]);
    let late = order.iter().skip(MAX_DECIDING).flat_map(|(_, handle)| {
        let name = module.global_variables[*handle].name.as_deref().unwrap_or("?");
        let places = walk.found.get(&handle.index()).into_iter().flatten();
        places.map(move |place| format!("`{name}` decides a branch in `{place}`"))
    });
    late.collect()
}

#[test]
fn branches_are_decided_by_the_first_three_uniform_buffers() {
    let mut failures = Vec::new();
    let mut entry_points = 0;
    for pass in framegraph_shaders::library::passes() {
        let every: Features = variants::features_of(&pass).into_iter().filter(|f| *f != Feature::HALF).collect();
        let alone: Features = every.iter().filter(|f| *f != Feature::MATERIAL_TABLE).collect();
        for features in [every, alone] {
            // Effects of post-processing branch on colors alone.
            let shader = resolve(&pass, &features, &[]).unwrap();
            for entry in &shader.reflection.entry_points {
                entry_points += 1;
                let late = late_deciders(&shader.wgsl, &entry.name);
                failures.extend(late.into_iter().map(|late| format!("{} {}: {late}", pass.path, entry.name)));
            }
        }
    }
    failures.sort();
    failures.dedup();
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
    assert!(entry_points > 50, "only {entry_points} entry points were walked through");
}

/// A planted shader whose fourth buffer decides: directly, through a function, a variable, or a loop; or does not.
#[test]
fn a_fourth_buffer_that_decides_is_found() {
    let with = |body: &str| {
        let buffers: String =
            (0..4).map(|i| format!("@group(0) @binding({i}) var<uniform> u{i}: vec4<f32>;\n")).collect();
        let text = format!(
            "{buffers}fn sum(a: f32) -> f32 {{ return a + u3.x; }}
            @fragment fn fs_main(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {{
                var color = u0 + u1 + u2 + u3;
                {body}
                return color;
            }}"
        );
        late_deciders(&text, "fs_main").len()
    };
    assert_eq!(with("if at.x * u3.y > 1.0 { color.x = 2.0; }"), 1);
    assert_eq!(with("if sum(at.x) > 1.0 { color.x = 2.0; }"), 1);
    assert_eq!(with("var w = at.x; w += u3.x; if w > 1.0 { color.x = 2.0; }"), 1);
    assert_eq!(with("for (var i = 0u; i < u32(u3.z); i++) { color.x += 2.0; }"), 1);
    assert_eq!(with("if u3.x > 1.0 { color.x = 2.0; }"), 1);
    assert_eq!(with("if at.x * u2.y > 1.0 { color.x = u3.x; }"), 0);
    assert_eq!(with("color.x = select(1.0, 2.0, u3.x > 1.0);"), 0);
}
