//! Errors of color grading tables against the exact functions.

use framegraph_passes::grading::{Baked, Extras, GradingError, Look, TableDesc, TableFormat};
use framegraph_shaders::layout::{Grading, ToneMap};
use glam::DVec3;

/// Error of one table, in 8-bit steps.
#[derive(Clone, Debug, PartialEq)]
pub struct TableError {
    /// Name of the look.
    pub look: &'static str,
    /// Entries along each axis.
    pub entries: usize,
    /// Number format of the entries.
    pub format: &'static str,
    /// Size of the table, in bytes.
    pub bytes: usize,
    /// Largest error of grays.
    pub grey: f64,
    /// Root mean square error of colors, over channels.
    pub rms: f64,
    /// Error that 1 % of the colors exceed.
    pub p99: f64,
    /// Largest error of colors.
    pub worst: f64,
    /// Root mean square error with tetrahedral interpolation instead of trilinear.
    pub tetrahedral: f64,
}

impl TableError {
    /// Returns the row of the document.
    pub fn row(&self) -> String {
        let Self { look, entries, format, bytes, grey, rms, p99, worst, tetrahedral } = self;
        let kib = *bytes as f64 / 1024.0;
        format!(
            "| {look:<8} | {entries:>4} | {format:<5} | {kib:>6.0} | {grey:>5.2} | {rms:>5.2} | {p99:>5.2} | {worst:>5.1} | {tetrahedral:>5.2} |"
        )
    }
}

/// Head of the table with the rows of [`TableError::row`].
pub const HEAD: &str = "\
| look     | size | bits  |    KiB |  grey |   rms |   p99 | worst | tetr. |
| -------- | ---- | ----- | ------ | ----- | ----- | ----- | ----- | ----- |";

/// Returns the measured looks with their names.
pub fn looks() -> [(&'static str, Look); 4] {
    let graded = Grading { temperature: 0.3, tint: -0.2, contrast: 1.2, saturation: 1.2, ..Grading::NEUTRAL };
    let plain = Look::default();
    [
        ("hill", plain),
        ("aces", Look { tone_map: ToneMap::Aces, ..plain }),
        ("graded", Look { tone_map: ToneMap::AcesLegacy, grading: graded, ..plain }),
        ("filmic", Look { tone_map: ToneMap::Filmic, ..plain }),
    ]
}

/// Returns the measured tables; one-dimensional curves have a single size.
pub fn descs(look: &Look) -> Vec<TableDesc> {
    if look.keeps_channels_apart(&Extras::default()) {
        return vec![TableDesc::DEFAULT];
    }
    [16, 32, 64].into_iter().flat_map(|entries| TableFormat::ALL.map(|format| TableDesc { entries, format })).collect()
}

/// Measures one table.
///
/// # Errors
/// The errors of [`Look::function`].
pub fn error(name: &'static str, look: &Look, desc: TableDesc) -> Result<TableError, GradingError> {
    let extras = Extras::default();
    let (baked, exact) = (Baked::new(look, &extras, desc)?, look.function(&extras)?);
    let off = |color: DVec3, tetrahedral| (baked.sample(color, tetrahedral) - exact(color)) * 255.0;
    let stop = |share: f64| 0.18 * (16.0 * share - 9.0).exp2();
    let grey = (0..=1000).map(|i| off(DVec3::splat(stop(f64::from(i) / 1000.0)), false).abs().max_element());
    let mut seed = 1_u64;
    let mut random = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as f64 / (1_u64 << 31) as f64
    };
    // Colors from nine stops below 18 % gray to seven above, independent per channel.
    let colors: Vec<DVec3> = (0..8192).map(|_| DVec3::new(stop(random()), stop(random()), stop(random()))).collect();
    let rms = |tetrahedral| {
        let squares: f64 = colors.iter().map(|color| off(*color, tetrahedral).length_squared()).sum();
        (squares / (3.0 * colors.len() as f64)).sqrt()
    };
    let mut worst: Vec<f64> = colors.iter().map(|color| off(*color, false).abs().max_element()).collect();
    worst.sort_by(f64::total_cmp);
    Ok(TableError {
        look: name,
        entries: baked.entries,
        format: baked.format.name(),
        bytes: baked.bytes.len(),
        grey: grey.fold(0.0, f64::max),
        rms: rms(false),
        p99: worst[worst.len() * 99 / 100],
        worst: worst.last().copied().unwrap_or(0.0),
        tetrahedral: rms(true),
    })
}
