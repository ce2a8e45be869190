//! Bloom and flare on the CPU in f64, from the published formulas, without the shader's optimizations.

use super::stage::Image;
use framegraph_passes::effects::bloom::{BloomChain, BloomSettings, FlareSettings, Threshold};
use glam::{DVec2, DVec3};

fn picture(size: [u32; 2], color: impl Fn(f64, f64) -> DVec3) -> Image {
    let [width, height] = size.map(f64::from);
    Image::from_fn(size, |x, y| color((f64::from(x) + 0.5) / width, (f64::from(y) + 0.5) / height))
}

/// Returns a tent filter that is 0 at a distance of two texels.
fn tent(distance: f64) -> f64 {
    (2.0 - distance.abs()).max(0.0) / 4.0
}

/// Downsamples the picture by a tent filter over groups of 2×2 texels, with reduced weights for very bright pixels.
fn first(source: &Image, size: [u32; 2], settings: Option<&BloomSettings>) -> Image {
    let multiple = settings.map_or(1, |own| own.multiple_px);
    let span = source.size.map(|side| side.next_multiple_of(multiple));
    let above = f64::from(span[1] - source.size[1]);
    let thresholds = settings.filter(|own| own.threshold != Threshold::None);
    let mut made = picture(size, |u, v| {
        let (x, y) = (u * f64::from(span[0]) - 0.5, v * f64::from(span[1]) - above - 0.5);
        let (left, top) = (x.floor() as i64 - 1, y.floor() as i64 - 1);
        let (mut sum, mut whole) = (DVec3::ZERO, 0.0);
        for group in [[0, 0], [2, 0], [0, 2], [2, 2]] {
            let (mut own, mut weight) = (DVec3::ZERO, 0.0);
            for [i, j] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
                let (px, py) = (left + group[0] + i, top + group[1] + j);
                let w = tent(px as f64 - x) * tent(py as f64 - y);
                own += w * source.at(px, py).min(DVec3::splat(4094.0));
                weight += w;
            }
            let mean = own / weight;
            let counts = if thresholds.is_some() { weight / (1.0 + mean.max_element()) } else { weight };
            sum += mean * counts;
            whole += counts;
        }
        sum / whole
    });
    if let Some(own) = thresholds {
        let at = f64::from(own.threshold_at);
        for color in &mut made.texels {
            let reaches = color.max_element() >= at;
            let left = match own.threshold {
                Threshold::Hard if reaches => *color,
                Threshold::Hard => DVec3::ZERO,
                _ => (*color - at).max(DVec3::ZERO),
            };
            *color = left / (1.0 + left.max_element() / f64::from(own.highlight));
        }
    }
    made.rounded()
}

/// Computes a level from the one above.
fn down(above: &Image, size: [u32; 2]) -> Image {
    let [width, height] = above.size.map(f64::from);
    let even = above.size.iter().all(|side| side % 2 == 0);
    let tap = |u: f64, v: f64, dx: f64, dy: f64| above.sample(u + dx / width, v + dy / height);
    let made = picture(size, |u, v| {
        if even {
            // Three samples per side, with weights 0.2333, 0.5334 and 0.2333.
            let side = [(-1.761629, 7.46602 / 32.0), (0.0, 1.0 - 7.46602 / 16.0), (1.761629, 7.46602 / 32.0)];
            let pairs = side.iter().flat_map(|x| side.iter().map(move |y| (x, y)));
            return pairs.map(|(x, y)| tap(u, v, x.0, y.0) * x.1 * y.1).sum();
        }
        // Five boxes of four samples: the central one has weight 1/2, the others 1/8 each.
        let corners = |x: f64, y: f64| {
            let all = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
            all.iter().map(|(dx, dy)| tap(u, v, x + dx, y + dy)).sum::<DVec3>() / 4.0
        };
        let outer = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
        corners(0.0, 0.0) * 0.5 + outer.iter().map(|(x, y)| corners(*x, *y)).sum::<DVec3>() * 0.125
    });
    made.rounded()
}

/// Adds the upsampled lower level to a level.
fn up(own: &Image, below: &Image, narrow: bool) -> Image {
    let sizes = [own.size, below.size].map(|size| size.map(f64::from));
    let made = picture(own.size, |u, v| {
        let taps: Vec<(DVec2, f64)> = if narrow {
            let d = 0.5 / DVec2::from_array(sizes[0]);
            [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|(x, y)| (DVec2::new(x, y) * d, 0.25)).to_vec()
        } else {
            let d = 1.0 / DVec2::from_array(sizes[1]);
            let weight = |i: i32| if i == 0 { 0.5 } else { 0.25 };
            let at = |i: i32, j: i32| (DVec2::new(i.into(), j.into()) * d, weight(i) * weight(j));
            (-1..=1).flat_map(|i| (-1..=1).map(move |j| at(i, j))).collect()
        };
        own.sample(u, v) + taps.iter().map(|(d, w)| below.sample(u + d.x, v + d.y) * *w).sum::<DVec3>()
    });
    made.rounded()
}

/// Returns all levels of bloom before they are summed.
pub fn levels(source: &Image, settings: &BloomSettings) -> Vec<Image> {
    let chain = BloomChain::new(settings, source.size);
    let (mut sifted, mut from) = (Some(settings), source.clone());
    for half in &chain.halves {
        from = first(&from, *half, sifted.take());
    }
    let mut levels = vec![first(&from, chain.size, sifted)];
    for level in 1..chain.levels {
        let above = &levels[usize::from(level) - 1];
        levels.push(down(above, chain.level_size(level)));
    }
    levels
}

/// Returns the sum of all levels.
pub fn glow(source: &Image, settings: &BloomSettings) -> Image {
    let mut levels = levels(source, settings);
    let mut sum = levels.pop().expect("there is a level");
    while let Some(own) = levels.pop() {
        sum = up(&own, &sum, settings.narrow);
    }
    sum
}

/// Returns blurred ghosts and halo without rays; the bloom covers a picture of `size_px`.
pub fn flare(glow: &Image, size_px: [u32; 2], settings: &FlareSettings) -> Image {
    let own = DVec2::new(size_px[0].into(), size_px[1].into());
    let multiple = f64::from(settings.multiple_px);
    // The picture is at the bottom left of the padded area.
    let span = (own / multiple).ceil() * multiple;
    let above = DVec2::new(0.0, span.y - own.y);
    let aspect = f64::from(glow.size[0]) / f64::from(glow.size[1]) * (span.x / own.x) / (span.y / own.y);
    let toward_middle = |uv: DVec2, aspect: f64| {
        let v = (DVec2::splat(0.5001) - uv) * DVec2::new(aspect, 1.0);
        v.normalize() / DVec2::new(aspect, 1.0)
    };
    let parted = |uv: DVec2, threshold: f32| {
        let d = toward_middle(uv, 1.0) * f64::from(settings.aberration);
        let [r, g, b] = [uv + d, uv, uv - d].map(|at| {
            let at = (at * span - above) / own;
            glow.sample(at.x, at.y)
        });
        (DVec3::new(r.x, g.y, b.z) - f64::from(threshold)).clamp(DVec3::ZERO, DVec3::ONE)
    };
    let sharp = picture(glow.size.map(|side| (side / 2).max(1)), |u, v| {
        let uv = (DVec2::new(u, v) * own + above) / span;
        let ghost = |i: u8| {
            let mirrored = 1.0 - uv;
            let at = mirrored + (0.5 - mirrored) * f64::from(settings.ghost_spacing) * f64::from(i);
            parted(at - at.floor(), settings.ghost_threshold)
        };
        let ghosts: DVec3 = (0..settings.ghosts).map(ghost).sum();
        let radius = f64::from(settings.halo_radius);
        let from = parted(uv + toward_middle(uv, aspect) * radius, settings.halo_threshold);
        let d = ((uv - 0.5) * DVec2::new(aspect, 1.0)).length();
        let t = ((d - radius).abs() / f64::from(settings.halo_thickness).max(1e-9)).min(1.0);
        ghosts + from * (1.0 - t * t * (3.0 - 2.0 * t))
    })
    .rounded();
    let bell = |i: i64| (-0.5 * (i as f64 / (10.0 / 6.0)).powi(2)).exp();
    let whole: f64 = (-4..=4).map(bell).sum();
    let blur = |image: &Image, across: bool| {
        let at = |x: u32, y: u32, i: i64| {
            if across { image.at(i64::from(x) + i, y.into()) } else { image.at(x.into(), i64::from(y) + i) }
        };
        Image::from_fn(image.size, |x, y| (-4..=4).map(|i| at(x, y, i) * bell(i)).sum::<DVec3>() / whole).rounded()
    };
    blur(&blur(&sharp, true), false)
}
