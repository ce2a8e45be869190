//! HTML page of a record in a single file: plots of error against time, tables, and pictures.

use super::answers;
use super::markdown::number;
use super::record::{Record, TechniqueRecord};
use super::run::file_name;
use super::technique::Outcome;
use crate::reference::picture::Picture;
use framegraph_passes::quality::Measured;
use image::{ImageEncoder as _, codecs::png::PngEncoder};
use std::fmt::Write as _;
use std::path::Path;

/// Returns a PNG with reference, picture, and sixteen times their difference around gray, side by side.
///
/// # Errors
/// The encoder fails.
pub fn strip(ours: &Picture, truth: &Picture) -> Outcome<Vec<u8>> {
    let [width, height] = ours.size_px;
    let code = |x: f32| (255.0 * x).round().clamp(0.0, 255.0) as u8;
    let mut pixels = Vec::with_capacity((width * height * 9) as usize);
    for y in 0..height {
        let row = (y * width) as usize..((y + 1) * width) as usize;
        pixels.extend(truth.encoded[row.clone()].iter().flatten().map(|c| code(*c)));
        pixels.extend(ours.encoded[row.clone()].iter().flatten().map(|c| code(*c)));
        let pairs = ours.encoded[row.clone()].iter().flatten().zip(truth.encoded[row].iter().flatten());
        pixels.extend(pairs.map(|(a, b)| code(0.5 + 16.0 * (a - b))));
    }
    let mut file = Vec::new();
    PngEncoder::new(&mut file).write_image(&pixels, 3 * width, height, image::ExtendedColorType::Rgb8)?;
    Ok(file)
}

/// Returns the page; pictures are read from `pictures`, if they exist.
pub fn page(record: &Record, pictures: &Path) -> String {
    let mut text = String::from(
        "<!doctype html><meta charset=utf-8><title>Error and cost of approximations</title><style>\
        body{font:15px/1.4 sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#222}\
        table{border-collapse:collapse;margin:1em 0}td,th{padding:.2em .7em;border-bottom:1px solid #ddd;text-align:left}\
        svg{background:#fafafa;border:1px solid #ddd}img{image-rendering:pixelated;width:100%;max-width:60em}\
        .dim{color:#999}</style><h1>Error and cost of approximations</h1>",
    );
    let Record { adapter, size_px, repeats, .. } = record;
    let _ = write!(
        text,
        "<p>{}, frames of {} × {} pixels, {repeats} repeats. Plots show error against the time of a whole frame, \
        both on logarithmic scales. Gray options are not Pareto-optimal, and the preset <i>high</i> is ringed. Pictures show \
        the reference, the option, and sixteen times their difference around gray.</p>",
        escaped(adapter),
        size_px[0],
        size_px[1]
    );
    // The sentence of the document, without Markdown and link.
    let taps = answers::taps(record).replace(['*', '`'], "");
    let taps = taps.split(" More under").next().unwrap_or_default();
    let _ = write!(text, "<p>{}</p>", escaped(taps));
    if let Some(measured) = &record.budget {
        text.push_str(&budget(measured));
    }
    for technique in &record.techniques {
        let TechniqueRecord { name, what, truth, .. } = technique;
        let _ = write!(text, "<h2 id={name}>{name}</h2><p>{} Reference: {}</p>", escaped(what), escaped(truth));
        text.push_str(&plot(technique));
        text.push_str(&table(technique));
        for choice in technique.choices.iter().filter(|choice| choice.picture.is_some()) {
            let file = pictures.join(format!("{name}.{}.png", file_name(&choice.name)));
            if let Ok(bytes) = std::fs::read(&file) {
                let _ = write!(
                    text,
                    "<details><summary>{}</summary><img src=\"data:image/png;base64,{}\"></details>",
                    escaped(&choice.name),
                    base64(&bytes)
                );
            }
        }
    }
    text
}

/// Returns a table of options as parts of one frame, with a bar per group. The bar is the additional time of its finest
/// option over its cheapest, relative to the reference.
fn budget(measured: &Measured) -> String {
    let mut text = format!(
        "<h2 id=budget>budget</h2><p>Options as parts of one frame, each changed alone from the reference, which takes {} ms. \
        Bars show the time beyond the group's fastest option, relative to the reference.</p><table><tr><th>group<th>option\
        <th>8-bit steps, RMS<th>ms<th>",
        number(measured.reference_ms)
    );
    for group in &measured.groups {
        let least = group.options.iter().map(|option| option.ms).fold(f64::INFINITY, f64::min);
        for option in &group.options {
            let share = 100.0 * (option.ms - least) / measured.reference_ms;
            let _ = write!(
                text,
                "<tr><td>{}<td>{}<td>{}<td>{}<td><svg width=200 height=10 style=border:0><rect width={:.1} height=10 fill=#06c \
                /></svg>",
                escaped(&group.name),
                escaped(&option.name),
                number(option.codes),
                number(option.ms),
                2.0 * share.clamp(0.0, 100.0)
            );
        }
    }
    text + "</table>"
}

fn table(technique: &TechniqueRecord) -> String {
    let head = "<th>option<th>error<th>bias<th>ms<th>operations<th>presets";
    let mut text = format!("<table><tr>{head} <!-- {} -->", technique.unit);
    for (choice, best) in technique.choices.iter().zip(technique.front()) {
        let optional = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), number);
        let error = if choice.is_void() { "below the reference's own".to_owned() } else { number(choice.error) };
        let operations = choice.operations.map(|parts| f64::from(parts.iter().sum::<u32>()));
        let _ = write!(
            text,
            "<tr{}><td>{}<td>{error} {}<td>{}<td>{}<td>{}<td>{}",
            if best { "" } else { " class=dim" },
            escaped(&choice.name),
            escaped(&technique.unit),
            optional(choice.bias),
            optional(choice.ms.map(|ms| ms.median)),
            optional(operations),
            choice.presets.join(", ")
        );
    }
    text + "</table>"
}

/// Returns a plot of error against time; empty if fewer than two options were timed.
fn plot(technique: &TechniqueRecord) -> String {
    let timed = technique.choices.iter().zip(technique.front());
    let points: Vec<_> = timed.filter_map(|(choice, best)| Some((choice, best, choice.ms?))).collect();
    if points.len() < 2 {
        return String::new();
    }
    let (width, height, margin) = (560.0, 300.0, 50.0);
    // An error of 0 has no logarithm; it is drawn at a hundredth of the smallest other error.
    let least = points.iter().map(|(c, ..)| c.error).filter(|e| *e > 0.0).fold(f64::INFINITY, f64::min);
    let least = if least.is_finite() { 0.01 * least } else { 1e-6 };
    let scale = |values: Vec<f64>| {
        let [low, high] = [f64::min, f64::max].map(|pick| values.iter().copied().reduce(pick).unwrap_or(0.0));
        let room = (0.1 * (high - low)).max(0.05);
        (low - room, high + room)
    };
    let xs = scale(points.iter().flat_map(|(.., ms)| [ms.low.ln(), ms.high.ln()]).collect());
    let ys = scale(points.iter().map(|(choice, ..)| choice.error.max(least).ln()).collect());
    let at_x = |ms: f64| margin + (ms.ln() - xs.0) / (xs.1 - xs.0) * (width - 2.0 * margin);
    let at_y = |error: f64| height - margin - (error.max(least).ln() - ys.0) / (ys.1 - ys.0) * (height - 2.0 * margin);
    let mut text = format!("<svg viewBox=\"0 0 {width} {height}\" width={width} height={height} font-size=11>");
    let _ = write!(
        text,
        "<text x={} y={} text-anchor=middle>ms of a frame</text><text x=12 y=16>error, {}</text>",
        width / 2.0,
        height - 8.0,
        escaped(&technique.unit)
    );
    let mut front: Vec<_> = points.iter().filter(|(_, best, _)| *best).collect();
    front.sort_by(|a, b| a.2.median.total_cmp(&b.2.median));
    let line: Vec<String> =
        front.iter().map(|(c, _, ms)| format!("{:.1},{:.1}", at_x(ms.median), at_y(c.error))).collect();
    let _ = write!(text, "<polyline points=\"{}\" fill=none stroke=#888 />", line.join(" "));
    for (choice, best, ms) in &points {
        let (x, y) = (at_x(ms.median), at_y(choice.error));
        let color = if *best { "#06c" } else { "#aaa" };
        let _ = write!(
            text,
            "<line x1={:.1} x2={:.1} y1={y:.1} y2={y:.1} stroke={color} /><circle cx={x:.1} cy={y:.1} r=4 fill={color} />",
            at_x(ms.low),
            at_x(ms.high)
        );
        if choice.presets.iter().any(|preset| preset == "high") {
            let _ = write!(text, "<circle cx={x:.1} cy={y:.1} r=8 fill=none stroke=#c00 />");
        }
    }
    // Labels are placed from top to bottom without overlap; those on the right end at their points.
    let mut labels: Vec<_> = points.iter().collect();
    labels.sort_by(|a, b| b.0.error.total_cmp(&a.0.error));
    let mut above = 20.0_f64;
    for (choice, best, ms) in labels {
        let x = at_x(ms.median);
        let (from, anchor) = if x > 0.55 * width { (x - 8.0, "end") } else { (x + 8.0, "start") };
        above = (at_y(choice.error) - 6.0).max(above + 13.0);
        let _ = write!(
            text,
            "<text x={from:.1} y={above:.1} text-anchor={anchor} fill={}>{}: {}, {} ms</text>",
            if *best { "#06c" } else { "#777" },
            escaped(&choice.name),
            number(choice.error),
            number(ms.median)
        );
    }
    text + "</svg>"
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Encodes bytes as base64 (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let bits = (0..3).fold(0_u32, |bits, i| bits << 8 | u32::from(group.get(i).copied().unwrap_or(0)));
        for digit in 0..4 {
            let value = DIGITS[(bits >> (18 - 6 * digit) & 63) as usize];
            text.push(if digit <= group.len() { char::from(value) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::base64;

    #[test]
    fn bytes_become_letters() {
        for (bytes, text) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }
}
