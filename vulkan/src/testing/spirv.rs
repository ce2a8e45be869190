//! WGSL to SPIR-V, with input attachments.
//!
//! WGSL has no input attachments. A shader declares a `texture_2d`, `texture_depth_2d` or multisampled texture instead,
//! and reads it with `textureLoad(t, vec2i(0), 0)` (or the number of a sample). The compiled code is then changed:
//! `OpTypeImage` gets the dimension `SubpassData`, and `OpImageFetch` becomes `OpImageRead`, whose coordinate is an
//! offset from the pixel.

use naga::back::spv;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::BTreeMap;

/// A binding of group 0 that is an input attachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct InputAttachment {
    /// The `@binding`.
    pub binding: u32,
    /// Index of the input attachment in the subpass.
    pub index: u32,
}

// Numbers of the SPIR-V specification.
const OP_CAPABILITY: u32 = 17;
const OP_TYPE_IMAGE: u32 = 25;
const OP_TYPE_POINTER: u32 = 32;
const OP_VARIABLE: u32 = 59;
const OP_LOAD: u32 = 61;
const OP_DECORATE: u32 = 71;
const OP_IMAGE_FETCH: u32 = 95;
const OP_IMAGE_READ: u32 = 98;
const OP_IMAGE_QUERY_SIZE_LOD: u32 = 103;
const OP_IMAGE_QUERY_SIZE: u32 = 104;
const CAPABILITY_INPUT_ATTACHMENT: u32 = 40;
const DECORATION_BINDING: u32 = 33;
const DECORATION_INPUT_ATTACHMENT_INDEX: u32 = 43;
const DIM_SUBPASS_DATA: u32 = 6;
const LOD_OPERAND: u32 = 2;

/// Compiles WGSL to SPIR-V 1.3. All entry points are in one module.
///
/// # Errors
/// Returns the message of the compiler, with the source.
pub fn spirv(wgsl: &str, inputs: &[InputAttachment]) -> Result<Vec<u32>, String> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|e| format!("{}\n{wgsl}", e.emit_to_string(wgsl)))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::all())
        .validate(&module)
        .map_err(|e| format!("{}\n{wgsl}", e.emit_to_string(wgsl)))?;
    // Rows grow downward, as in Vulkan's framebuffer: clip space is not flipped.
    let options = spv::Options { lang_version: (1, 3), flags: spv::WriterFlags::empty(), ..spv::Options::default() };
    let words = spv::write_vec(&module, &info, &options, None).map_err(|e| format!("{e}\n{wgsl}"))?;
    Ok(with_inputs(&words, inputs))
}

/// Changes variables of some bindings to input attachments. Also replaces queries of a storage texture's size that name
/// a level of detail, which naga 30 writes for its number of layers and SPIR-V does not allow.
fn with_inputs(words: &[u32], inputs: &[InputAttachment]) -> Vec<u32> {
    let (header, code) = words.split_at(5);
    let instructions = || {
        let mut rest = code;
        std::iter::from_fn(move || {
            let count = (*rest.first()? >> 16) as usize;
            let (one, others) = rest.split_at(count.max(1));
            rest = others;
            Some(one)
        })
    };
    let op = |one: &[u32]| one[0] & 0xFFFF;
    // Variables by id, with the index of their input attachment.
    let mut variables = BTreeMap::new();
    let (mut images, mut pointers) = (BTreeMap::new(), BTreeMap::new());
    for one in instructions() {
        match op(one) {
            OP_DECORATE if one[2] == DECORATION_BINDING => {
                let input = inputs.iter().find(|input| input.binding == one[3]);
                variables.extend(input.map(|input| (one[1], input.index)));
            }
            OP_TYPE_IMAGE => drop(images.insert(one[1], one.to_vec())),
            OP_TYPE_POINTER => drop(pointers.insert(one[1], one.to_vec())),
            _ => {}
        }
    }
    let mut bound = header[3];
    let mut fresh = || {
        bound += 1;
        bound - 1
    };
    // New types by old pointer type; equal types must not be declared twice.
    let mut of_pointer: BTreeMap<u32, [u32; 2]> = BTreeMap::new();
    let mut of_image: BTreeMap<Vec<u32>, u32> = BTreeMap::new();
    let mut out = Vec::new();
    if !variables.is_empty() {
        out.extend([(2 << 16) | OP_CAPABILITY, CAPABILITY_INPUT_ATTACHMENT]);
    }
    // Loaded storage textures: their types have the operand `Sampled` 2.
    let mut storage: Vec<u32> = Vec::new();
    let mut decorated = false;
    let mut loaded: Vec<u32> = Vec::new();
    let mut image_of: BTreeMap<u32, u32> = BTreeMap::new();
    for one in instructions() {
        match op(one) {
            OP_DECORATE if !decorated => {
                decorated = true;
                for (variable, index) in &variables {
                    out.extend([(4 << 16) | OP_DECORATE, *variable, DECORATION_INPUT_ATTACHMENT_INDEX, *index]);
                }
                out.extend(one);
            }
            OP_VARIABLE if variables.contains_key(&one[2]) => {
                let types = *of_pointer.entry(one[1]).or_insert_with(|| {
                    let pointer = &pointers[&one[1]];
                    let mut image: Vec<u32> = images[&pointer[3]].clone();
                    (image[3], image[5], image[7]) = (DIM_SUBPASS_DATA, 0, 2);
                    let key = image[2..].to_vec();
                    let id = *of_image.entry(key).or_insert_with(|| {
                        let id = fresh();
                        image[1] = id;
                        out.extend(&image);
                        id
                    });
                    let new = fresh();
                    out.extend([(4 << 16) | OP_TYPE_POINTER, new, pointer[2], id]);
                    [new, id]
                });
                out.extend([one[0], types[0], one[2], one[3]]);
                image_of.insert(one[2], types[1]);
            }
            OP_LOAD if image_of.contains_key(&one[3]) => {
                loaded.push(one[2]);
                out.extend([one[0], image_of[&one[3]], one[2], one[3]]);
            }
            OP_LOAD => {
                if images.get(&one[1]).is_some_and(|image| image.get(7) == Some(&2)) {
                    storage.push(one[2]);
                }
                out.extend(one);
            }
            OP_IMAGE_QUERY_SIZE_LOD if storage.contains(&one[3]) => {
                out.extend([(4 << 16) | OP_IMAGE_QUERY_SIZE, one[1], one[2], one[3]]);
            }
            OP_IMAGE_FETCH if loaded.contains(&one[3]) => {
                let mut read = one.to_vec();
                // A level of detail is not allowed; the number of a sample is.
                if read.get(5) == Some(&LOD_OPERAND) {
                    read.truncate(5);
                }
                read[0] = (read.len() as u32) << 16 | OP_IMAGE_READ;
                out.extend(read);
            }
            _ => out.extend(one),
        }
    }
    let mut made = header.to_vec();
    made[3] = bound;
    made.extend(out);
    made
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fetches_become_reads_of_the_pixel() -> Result<(), String> {
        let wgsl = "@group(0) @binding(0) var a: texture_2d<f32>; @group(0) @binding(1) var b: texture_2d<f32>;
            @fragment fn fs() -> @location(0) vec4f { return textureLoad(a, vec2i(0), 0) + textureLoad(b, vec2i(0), 0); }";
        let words = spirv(wgsl, &[InputAttachment { binding: 1, index: 3 }])?;
        let count =
            |op: u32| words[5..].iter().filter(|word| *word & 0xFFFF == op && (2..9).contains(&(*word >> 16))).count();
        assert_eq!((count(OP_IMAGE_FETCH), count(OP_IMAGE_READ)), (1, 1));
        assert!(words.windows(2).any(|pair| pair == [DECORATION_INPUT_ATTACHMENT_INDEX, 3]));
        Ok(())
    }
}
