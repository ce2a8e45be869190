//! Resolves names to versions and parts. Errors list the names that exist.

use super::error::{InspectError, MissingPart, VersionName};
use super::pass::Part;
use super::request::{Request, VersionSelector};
use framegraph::{Aspect, Dimension, Format, Graph, Numeric, PassId, Plan, ResourceId, TextureDesc, VersionId};

/// One part of one version of a texture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InspectTarget {
    /// Full name of the texture.
    pub name: String,
    /// Version of the texture.
    pub version: VersionId,
    /// Version number; 0 for the contents on entry.
    pub number: usize,
    /// Full name of the pass that wrote it; `None` for the contents on entry.
    pub writer: Option<String>,
    /// Format of the texture.
    pub format: Format,
    /// Mip level.
    pub mip: u8,
    /// Layer of an array, or slice of a 3D texture.
    pub layer: u16,
    /// Plane; `All` for color.
    pub aspect: Aspect,
    /// Sample; `None` for the average, or for textures with one sample.
    pub sample: Option<u8>,
    desc: TextureDesc,
}

impl InspectTarget {
    /// Returns a title such as `hdr@color, level 2`.
    pub fn title(&self) -> String {
        let writer = self.writer.as_deref().map_or_else(|| "v0".to_owned(), str::to_owned);
        let mut title = format!("{}@{writer}", self.name);
        let single = self.desc.mips == 1;
        title += &if single { String::new() } else { format!(", level {}", self.mip) };
        title += &if self.desc.layers == 1 { String::new() } else { format!(", layer {}", self.layer) };
        title += match self.aspect {
            Aspect::All => "",
            Aspect::Depth => ", depth",
            Aspect::Stencil => ", stencil",
        };
        title + &self.sample.map_or_else(String::new, |s| format!(", sample {s}"))
    }

    /// Returns a file name without extension, made of letters, digits, `.`, `_`, `-` and `@`.
    pub fn file_stem(&self) -> String {
        let parts = self.title().replace(", ", ".").replace(' ', "");
        let allowed = |c: char| c.is_ascii_alphanumeric() || "._-@".contains(c);
        let name: String = parts.chars().map(|c| if allowed(c) { c } else { '_' }).collect();
        format!("v{}.{name}", self.number)
    }

    /// Returns width and height in texels for a frame size.
    #[cfg(feature = "remote")]
    pub(crate) fn size(&self, frame: [u32; 2]) -> [u32; 2] {
        self.desc.mip_extent(frame, self.mip.into())
    }

    pub(super) fn part(&self) -> Part {
        let Self { desc, mip, layer, aspect, sample, .. } = *self;
        Part { desc, mip, layer, aspect, sample }
    }
}

/// Returns everything that can be inspected in a plan, in order of creation. Includes each version that a pass writes,
/// limited to the written parts, and the contents of resources on entry.
pub fn all_targets(plan: &Plan) -> Vec<InspectTarget> {
    let graph = plan.graph();
    let mut all = Vec::new();
    let mut numbers = vec![0; graph.resources().len()];
    for (index, row) in graph.versions().iter().enumerate() {
        let Some(version) = VersionId::new(index) else { break };
        let number = numbers[row.resource.index()];
        numbers[row.resource.index()] += 1;
        let Some(desc) = graph.resources()[row.resource.index()].desc.texture() else {
            continue;
        };
        let used = plan.resources()[row.resource.index()].first.some().is_some();
        let there = match row.writer.some() {
            Some(writer) => !plan.is_culled(writer),
            None => used && graph.resources()[row.resource.index()].kind.defined_on_entry(),
        };
        if !there {
            continue;
        }
        let range = graph.accesses().get(row.access.index()).map_or(framegraph::Range::ALL, |a| a.range);
        for mip in range.mip_range(desc.mip_count(plan.frame())) {
            let slices = match desc.dimension {
                Dimension::D2 => range.layer_range(desc.layers.into()),
                Dimension::D3 => 0..(u32::from(desc.layers) >> mip).max(1),
            };
            for layer in slices {
                for aspect in planes(desc.format).filter(|a| overlap(*a, range.aspect)) {
                    let (mip, layer) = (mip as u8, layer as u16);
                    let whole = target(graph, row.resource, version, number, *desc);
                    all.push(InspectTarget { mip, layer, aspect, ..whole });
                }
            }
        }
    }
    all
}

/// Finds the target that a request names.
///
/// # Errors
/// Fails if the name or part does not exist. The error lists those that exist.
pub fn find(plan: &Plan, request: &Request) -> Result<InspectTarget, InspectError> {
    let graph = plan.graph();
    let Request { name, version: selector, mip, layer, aspect, sample } = request;
    let named: Vec<_> = graph.resource_ids().filter(|r| graph.resource_name(*r) == name).collect();
    if named.is_empty() {
        let textures = graph.resource_ids().filter(|r| graph.resources()[r.index()].desc.texture().is_some());
        let known = textures.map(|r| graph.resource_name(r).to_owned()).collect();
        return Err(InspectError::NoTexture { name: name.clone(), known });
    }
    let textures = || {
        let desc = |r: &ResourceId| graph.resources()[r.index()].desc.texture().copied();
        named.iter().filter_map(move |r| Some((*r, desc(r)?)))
    };
    if textures().next().is_none() {
        return Err(InspectError::Buffer { name: name.clone() });
    }
    let fits = |(number, version): &(usize, VersionId)| {
        let row = graph.versions()[version.index()];
        let defined = graph.resources()[row.resource.index()].kind.defined_on_entry();
        let holds = row.writer.some().is_some() || defined;
        let wrote = |pass: &str| row.writer.some().is_some_and(|w| graph.pass_name(w) == pass);
        // Passes may be named `v1` or `s1`; pass names take precedence.
        let meant = |text: String| if graph.find_pass(&text).is_some() { Some(wrote(&text)) } else { None };
        match selector {
            VersionSelector::Newest => holds,
            VersionSelector::After(pass) => wrote(pass),
            VersionSelector::Number(wanted) => meant(format!("v{wanted}")).unwrap_or(number == wanted && holds),
            VersionSelector::Step(last) => meant(format!("s{last}")).unwrap_or_else(|| {
                let ran = |w: PassId| plan.pass_steps()[w.index()].some().is_some_and(|step| step.index() <= *last);
                row.writer.some().map_or(defined, ran)
            }),
        }
    };
    let found = textures().find_map(|(resource, desc)| {
        let version = graph.versions_of(resource).enumerate().filter(fits).last();
        version.map(|(number, version)| target(graph, resource, version, number, desc))
    });
    let Some(found) = found else {
        let known = textures().flat_map(|(resource, _)| versions(graph, resource)).collect();
        return Err(InspectError::NoVersion {
            name: name.clone(),
            requested: selector.clone(),
            steps: plan.steps().len(),
            known,
        });
    };
    let refuse = |part| Err(InspectError::NoPart { name: name.clone(), part });
    let (desc, mips) = (found.desc, found.desc.mip_count(plan.frame()));
    if u32::from(*mip) >= mips {
        return refuse(MissingPart::Level { requested: *mip, levels: mips });
    }
    let layers = match desc.dimension {
        Dimension::D2 => u32::from(desc.layers),
        Dimension::D3 => (u32::from(desc.layers) >> mip).max(1),
    };
    if u32::from(*layer) >= layers {
        return refuse(MissingPart::Layer { requested: *layer, layers });
    }
    let aspect = match planes(desc.format).find(|a| overlap(*a, *aspect)) {
        Some(aspect) => aspect,
        None => return refuse(MissingPart::Plane { requested: *aspect, format: desc.format }),
    };
    if let Some(sample) = sample.filter(|s| *s >= desc.samples) {
        return refuse(MissingPart::Sample { requested: sample, samples: desc.samples });
    }
    let averaged = desc.format.numeric() == Numeric::Float;
    let sample = sample.or((desc.samples > 1 && !averaged).then_some(0)).filter(|_| desc.samples > 1);
    Ok(InspectTarget { mip: *mip, layer: *layer, aspect, sample, ..found })
}

fn target(graph: &Graph, resource: ResourceId, version: VersionId, number: usize, desc: TextureDesc) -> InspectTarget {
    let writer = graph.versions()[version.index()].writer.some();
    let averaged = desc.format.numeric() == Numeric::Float;
    InspectTarget {
        name: graph.resource_name(resource).to_owned(),
        version,
        number,
        writer: writer.map(|w| graph.pass_name(w).to_owned()),
        format: desc.format,
        mip: 0,
        layer: 0,
        aspect: Aspect::All,
        sample: (desc.samples > 1 && !averaged).then_some(0),
        desc,
    }
}

/// Returns the planes that are inspected separately.
fn planes(format: Format) -> impl Iterator<Item = Aspect> {
    let both = format.has_depth() && format.has_stencil();
    [Aspect::Depth, Aspect::Stencil, Aspect::All].into_iter().filter(move |a| (*a == Aspect::All) != both)
}

fn overlap(plane: Aspect, requested: Aspect) -> bool {
    plane == requested || plane == Aspect::All || requested == Aspect::All
}

/// Returns the versions of a resource that can be inspected.
fn versions(graph: &Graph, resource: ResourceId) -> impl Iterator<Item = VersionName> {
    let defined = graph.resources()[resource.index()].kind.defined_on_entry();
    graph.versions_of(resource).enumerate().filter_map(move |(number, version)| {
        let writer = graph.versions()[version.index()].writer.some();
        let writer = writer.map(|writer| graph.pass_name(writer).to_owned());
        (writer.is_some() || defined).then_some(VersionName { number, writer })
    })
}
