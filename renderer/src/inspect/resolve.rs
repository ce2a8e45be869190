//! From names to versions and parts; says what there is when something is not.

use super::error::InspectError;
use super::look::Part;
use super::request::{Request, Which};
use framegraph::{Aspect, Dimension, Format, Graph, Numeric, PassId, Plan, ResourceId, TextureDesc, VersionId};

/// Names that an error lists at most.
const LISTED: usize = 40;

/// One part of one version of one texture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seen {
    /// Full name of the texture.
    pub name: String,
    /// The version.
    pub version: VersionId,
    /// Its number, the contents on entry being 0.
    pub number: usize,
    /// Full name of the pass that wrote it; none for the contents on entry.
    pub writer: Option<String>,
    /// What the texture holds.
    pub format: Format,
    /// Level.
    pub mip: u8,
    /// Layer of an array, or slice of a three-dimensional texture.
    pub layer: u16,
    /// Plane; `All` for color.
    pub aspect: Aspect,
    /// One sample; none for the average, or for what has one sample.
    pub sample: Option<u8>,
    desc: TextureDesc,
}

impl Seen {
    /// What it is, in words: `hdr@color, level 2`.
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

    /// A name for a file, without an ending: letters, digits, `.`, `_`, `-` and `@` alone.
    pub fn file_stem(&self) -> String {
        let parts = self.title().replace(", ", ".").replace(' ', "");
        let allowed = |c: char| c.is_ascii_alphanumeric() || "._-@".contains(c);
        let name: String = parts.chars().map(|c| if allowed(c) { c } else { '_' }).collect();
        format!("v{}.{name}", self.number)
    }

    pub(super) fn part(&self) -> Part {
        let Self { desc, mip, layer, aspect, sample, .. } = *self;
        Part { desc, mip, layer, aspect, sample }
    }
}

/// Everything that there is to look at in a plan: each version that a pass of it writes, in the parts that were written,
/// and what resources hold on entry. In the order in which versions come to be.
pub fn everything(plan: &Plan) -> Vec<Seen> {
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
                    let seen = seen(graph, row.resource, version, number, *desc);
                    all.push(Seen { mip, layer, aspect, ..seen });
                }
            }
        }
    }
    all
}

/// Finds what a request names.
///
/// # Errors
/// What is not there, with what is.
pub fn find(plan: &Plan, request: &Request) -> Result<Seen, InspectError> {
    let graph = plan.graph();
    let Request { name, which, mip, layer, aspect, sample } = request;
    let named: Vec<_> = graph.resource_ids().filter(|r| graph.resource_name(*r) == name).collect();
    if named.is_empty() {
        let textures = graph.resource_ids().filter(|r| graph.resources()[r.index()].desc.texture().is_some());
        let known = list(textures.map(|r| format!("`{}`", graph.resource_name(r))));
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
        // A pass may be called `v1` or `s1`: whoever has such names means them.
        let meant = |text: String| if graph.find_pass(&text).is_some() { Some(wrote(&text)) } else { None };
        match which {
            Which::Newest => holds,
            Which::After(pass) => wrote(pass),
            Which::Number(wanted) => meant(format!("v{wanted}")).unwrap_or(number == wanted && holds),
            Which::Step(last) => meant(format!("s{last}")).unwrap_or_else(|| {
                let ran = |w: PassId| plan.pass_steps()[w.index()].some().is_some_and(|step| step.index() <= *last);
                row.writer.some().map_or(defined, ran)
            }),
        }
    };
    let found = textures().find_map(|(resource, desc)| {
        let version = graph.versions_of(resource).enumerate().filter(fits).last();
        version.map(|(number, version)| seen(graph, resource, version, number, desc))
    });
    let Some(found) = found else {
        let asked = match which {
            Which::Newest => "that anybody wrote".to_owned(),
            Which::After(pass) => format!("of a pass `{pass}`"),
            Which::Number(number) => format!("v{number}"),
            Which::Step(step) => format!("at step {step} of {}", plan.steps().len()),
        };
        let known = list(textures().flat_map(|(resource, _)| versions(graph, resource)));
        return Err(InspectError::NoVersion { name: name.clone(), asked, known });
    };
    let refuse = |asked: String, known: String| Err(InspectError::NoPart { name: name.clone(), asked, known });
    let (desc, mips) = (found.desc, found.desc.mip_count(plan.frame()));
    if u32::from(*mip) >= mips {
        return refuse(format!("level {mip}"), format!("levels 0 to {}", mips - 1));
    }
    let layers = match desc.dimension {
        Dimension::D2 => u32::from(desc.layers),
        Dimension::D3 => (u32::from(desc.layers) >> mip).max(1),
    };
    if u32::from(*layer) >= layers {
        return refuse(format!("layer {layer}"), format!("layers 0 to {}", layers - 1));
    }
    let aspect = match planes(desc.format).find(|a| overlap(*a, *aspect)) {
        Some(aspect) => aspect,
        None => return refuse(format!("{aspect:?} plane"), format!("the format {:?}", desc.format)),
    };
    if let Some(sample) = sample.filter(|s| *s >= desc.samples) {
        return refuse(format!("sample {sample}"), format!("{} samples", desc.samples));
    }
    let averaged = desc.format.numeric() == Numeric::Float;
    let sample = sample.or((desc.samples > 1 && !averaged).then_some(0)).filter(|_| desc.samples > 1);
    Ok(Seen { mip: *mip, layer: *layer, aspect, sample, ..found })
}

fn seen(graph: &Graph, resource: ResourceId, version: VersionId, number: usize, desc: TextureDesc) -> Seen {
    let writer = graph.versions()[version.index()].writer.some();
    let averaged = desc.format.numeric() == Numeric::Float;
    Seen {
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

/// The planes that are looked at one by one.
fn planes(format: Format) -> impl Iterator<Item = Aspect> {
    let both = format.has_depth() && format.has_stencil();
    [Aspect::Depth, Aspect::Stencil, Aspect::All].into_iter().filter(move |a| (*a == Aspect::All) != both)
}

fn overlap(plane: Aspect, asked: Aspect) -> bool {
    plane == asked || plane == Aspect::All || asked == Aspect::All
}

/// The versions of a resource in words: `v1 (color)`.
fn versions(graph: &Graph, resource: ResourceId) -> impl Iterator<Item = String> {
    let defined = graph.resources()[resource.index()].kind.defined_on_entry();
    graph.versions_of(resource).enumerate().filter_map(move |(number, version)| {
        match graph.versions()[version.index()].writer.some() {
            Some(writer) => Some(format!("v{number} (`{}`)", graph.pass_name(writer))),
            None => defined.then(|| format!("v{number} (on entry)")),
        }
    })
}

fn list(words: impl Iterator<Item = String>) -> String {
    let all: Vec<_> = words.collect();
    match all.len() {
        0 => "none".to_owned(),
        n if n > LISTED => format!("{} and {} more", all[..LISTED].join(", "), n - LISTED),
        _ => all.join(", "),
    }
}
