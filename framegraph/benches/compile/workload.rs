//! Deterministic graphs used for comparisons with other render graphs: `chain_N`, `dag_N` and `frame`, from a
//! splitmix64 stream.

use framegraph::{DeclareError, Entry, Exit, Extent, Format, Graph, Intent, Texture, TextureDesc};

/// One resource of a workload.
#[derive(Clone, Copy, Debug)]
pub struct WorkResource {
    /// Owned outside of the graph.
    pub imported: bool,
    /// A pass writes it.
    pub written: bool,
    /// Width and height in texels.
    pub extent: [u32; 2],
    /// A format with the workload's bytes per texel.
    pub format: Format,
}

/// One pass of a workload.
#[derive(Clone, Debug)]
pub struct WorkPass {
    /// Name.
    pub name: String,
    /// Never culled.
    pub side_effect: bool,
    /// Indices of the sampled resources.
    pub reads: Vec<usize>,
    /// Indices of the written resources: the first writer creates a resource, later ones modify it.
    pub writes: Vec<usize>,
}

/// A graph before it is declared.
#[derive(Clone, Debug)]
pub struct Workload {
    /// Name.
    pub name: String,
    /// Resources.
    pub resources: Vec<WorkResource>,
    /// Passes, in declaration order.
    pub passes: Vec<WorkPass>,
}

/// splitmix64 (Steele, Lea, Flood 2014).
struct Rng(u64);

impl Rng {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        ((self.next() >> 11) % n as u64) as usize
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns a texture with a log-uniform size from 64 KiB to 16 MiB: RGBA8, 256 texels wide.
    fn texture(&mut self) -> WorkResource {
        let k = 2f64.powf(self.unit() * 8.0).round_ties_even().clamp(1.0, 256.0) as u32;
        WorkResource { imported: false, written: true, extent: [256, (64 * k).min(16384)], format: Format::Rgba8Unorm }
    }
}

/// Returns a chain: pass i reads resource i − 1 and creates i; the last pass has a side effect.
pub fn chain(n: usize) -> Workload {
    let mut rng = Rng(1);
    let resources = (0..n).map(|_| rng.texture()).collect();
    let passes = (0..n).map(|i| WorkPass {
        name: format!("p{i}"),
        side_effect: i == n - 1,
        reads: if i == 0 { vec![] } else { vec![i - 1] },
        writes: vec![i],
    });
    Workload { name: format!("chain_{n}"), resources, passes: passes.collect() }
}

/// Returns a random graph: each pass reads 3 of the last 64 resources and creates 2; exactly n/5 passes are unused.
pub fn dag(n: usize, seed: u64) -> Workload {
    let mut rng = Rng(seed);
    let resources = (0..2 * n).map(|_| rng.texture()).collect();
    let mut dead = vec![false; n];
    let mut left = n / 5;
    while left > 0 {
        let d = 1 + rng.below(n - 2);
        left -= usize::from(!dead[d]);
        dead[d] = true;
    }
    let mut passes = Vec::with_capacity(n);
    let mut pending: Vec<usize> = Vec::new();
    for i in 0..n {
        let low = (2 * i).saturating_sub(64);
        let candidates: Vec<usize> = (low..2 * i).filter(|x| dead[i] || !dead[x >> 1]).collect();
        let mut want = candidates.len().min(3);
        let mut reads: Vec<usize> = Vec::new();
        let last = i == n - 1;
        if !dead[i] && !last && pending.first().is_some_and(|p| i - p >= 24) {
            reads.push(2 * pending[0] + rng.below(2));
        }
        if last {
            reads = pending.iter().map(|p| 2 * p).collect();
            want = want.max(reads.len());
        }
        while reads.len() < want {
            let c = candidates[rng.below(candidates.len())];
            if !reads.contains(&c) {
                reads.push(c);
            }
        }
        if !dead[i] {
            pending.retain(|p| !reads.iter().any(|x| x >> 1 == *p));
            if !last {
                pending.push(i);
            }
        }
        passes.push(WorkPass { name: format!("p{i}"), side_effect: last, reads, writes: vec![2 * i, 2 * i + 1] });
    }
    Workload { name: format!("dag_{n}"), resources, passes }
}

/// Returns a Filament-like frame at 1080p with 26 passes and 24 resources.
pub fn frame() -> Workload {
    let (w, h) = (1920, 1080);
    let mut names: Vec<String> = Vec::new();
    let mut resources = Vec::new();
    let mut add = |name: String, imported: bool, extent: [u32; 2], bytes: u32| {
        let format = match bytes {
            2 => Format::R16Float,
            4 => Format::Rgba8Unorm,
            _ => Format::Rgba16Float,
        };
        names.push(name);
        resources.push(WorkResource { imported, written: false, extent, format });
    };
    add("history".into(), true, [w, h], 8);
    add("lut".into(), true, [1024, 32], 4);
    add("backbuffer".into(), true, [w, h], 4);
    add("history_next".into(), true, [w, h], 8);
    add("shadow".into(), false, [4096, 4096], 2);
    for i in 0..4 {
        add(format!("depth{i}"), false, [w >> i, h >> i], 4);
    }
    for name in ["sao_raw", "sao_h", "sao"] {
        add(name.into(), false, [w / 2, h / 2], 4);
    }
    add("picking".into(), false, [w, h], 8);
    add("color".into(), false, [w, h], 8);
    add("zbuf".into(), false, [w, h], 4);
    add("refr".into(), false, [w / 2, h / 2], 8);
    add("taa".into(), false, [w, h], 8);
    for i in 0..5 {
        add(format!("bloom{i}"), false, [w >> (i + 1), h >> (i + 1)], 4);
    }
    add("ldr".into(), false, [w, h], 4);
    add("fxaa".into(), false, [w, h], 4);
    let find = |name: &str| names.iter().position(|n| n == name).expect("the name is in the list");
    let mut passes = Vec::new();
    let mut pass = |name: &str, reads: &[&str], writes: &[&str], side_effect: bool| {
        let ids = |names: &[&str]| names.iter().map(|n| find(n)).collect();
        passes.push(WorkPass { name: name.into(), side_effect, reads: ids(reads), writes: ids(writes) });
    };
    pass("shadow0", &[], &["shadow"], false);
    pass("shadow1", &[], &["shadow"], false);
    pass("structure", &[], &["depth0"], false);
    for i in 1..4 {
        pass(&format!("depth_mip{i}"), &[&format!("depth{}", i - 1)], &[&format!("depth{i}")], false);
    }
    pass("picking", &["depth0"], &["picking"], false);
    pass("sao", &["depth0", "depth1", "depth2", "depth3"], &["sao_raw"], false);
    pass("sao_blur_h", &["sao_raw", "depth0"], &["sao_h"], false);
    pass("sao_blur_v", &["sao_h", "depth0"], &["sao"], false);
    pass("color_opaque", &["shadow", "sao"], &["color", "zbuf"], false);
    pass("refraction_mip", &["color"], &["refr"], false);
    pass("color_transm", &["refr", "shadow", "sao"], &["color", "zbuf"], false);
    pass("taa", &["color", "zbuf", "history"], &["taa", "history_next"], false);
    for i in 0..5 {
        let from = if i == 0 { "taa".to_owned() } else { format!("bloom{}", i - 1) };
        pass(&format!("bloom_dn{i}"), &[&from], &[&format!("bloom{i}")], false);
    }
    for i in (0..4).rev() {
        pass(&format!("bloom_up{i}"), &[&format!("bloom{}", i + 1)], &[&format!("bloom{i}")], false);
    }
    pass("grading", &["taa", "bloom0", "lut"], &["ldr"], false);
    pass("fxaa", &["ldr"], &["fxaa"], false);
    pass("present", &["fxaa"], &["backbuffer"], true);
    for written in passes.iter().flat_map(|p: &WorkPass| &p.writes) {
        resources[*written].written = true;
    }
    Workload { name: "frame".into(), resources, passes }
}

/// Handles of a workload's resources while it is declared.
pub type Handles = Vec<Option<Texture>>;

impl Workload {
    /// Declares the workload into an empty graph. A pass that writes one resource is a raster pass; a pass that writes
    /// several of different sizes is a compute pass.
    pub fn declare(&self, graph: &mut Graph, handles: &mut Handles) -> Result<(), DeclareError> {
        handles.clear();
        for (index, resource) in self.resources.iter().enumerate() {
            handles.push(resource.imported.then(|| {
                let (entry, exit) =
                    if resource.written { (Entry::Undefined, Exit::Keep) } else { (Entry::Defined, Exit::Discard) };
                graph.import_texture("imported", self.desc(index), entry, exit)
            }));
        }
        for pass in &self.passes {
            graph.add_fn(&pass.name, |p| {
                if pass.side_effect {
                    p.side_effect();
                }
                for texture in pass.reads.iter().filter_map(|r| handles[*r]) {
                    p.sampled(texture)?;
                }
                let raster = pass.writes.len() == 1;
                for write in &pass.writes {
                    let (texture, intent) = match handles[*write] {
                        Some(texture) if !self.resources[*write].imported => (texture, Intent::Modify),
                        Some(texture) => (texture, Intent::Overwrite),
                        None => (p.texture("t", self.desc(*write)), Intent::Overwrite),
                    };
                    let written = if raster { p.color(texture, intent)? } else { p.storage_write(texture, intent)? };
                    handles[*write] = Some(written);
                }
                Ok(())
            })?;
        }
        Ok(())
    }

    fn desc(&self, index: usize) -> TextureDesc {
        let WorkResource { extent: [w, h], format, .. } = self.resources[index];
        TextureDesc::new(Extent::absolute(w, h), format)
    }
}
