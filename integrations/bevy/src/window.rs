//! Cuts one frame out of a trace, and finds which contents outlive it.

use crate::observed::{Effect, Load, Observed, ObservedPass, Use, Used, Work};
use crate::record::Recorder;
use crate::trace::{Action, FRAME_MARK, TraceError};
use framegraph::{Entry, Exit};
use std::collections::HashSet;

/// Returns frame `frame` of a trace. The next frame must be complete too.
///
/// # Errors
/// Fails if the trace ends before.
pub(crate) fn observe(actions: &[Action], frame: u32) -> Result<Observed, TraceError> {
    let mut recorder = Recorder::default();
    let mut windows: [Vec<ObservedPass>; 2] = Default::default();
    let mut left_out = Vec::new();
    let mut current = None;
    for action in actions {
        if let Some(started) = mark(action) {
            let passes = std::mem::take(&mut recorder.passes);
            let gone = std::mem::take(&mut recorder.left_out);
            match current {
                Some(ended) if ended == frame => (windows[0], left_out) = (passes, gone),
                Some(ended) if ended == frame + 1 => {
                    windows[1] = passes;
                    return Ok(frame_of(recorder, windows, left_out));
                }
                _ => {}
            }
            current = Some(started);
        }
        recorder.apply(action);
    }
    Err(TraceError::NoFrame { frame })
}

/// Returns the index of the frame that a call marks.
fn mark(action: &Action) -> Option<u32> {
    let Action::CreateBuffer(_, desc) = action else { return None };
    desc.label.as_deref()?.strip_prefix(FRAME_MARK)?.parse().ok()
}

fn frame_of(recorder: Recorder, [own, next]: [Vec<ObservedPass>; 2], left_out: Vec<String>) -> Observed {
    let state = recorder.state;
    let mut frame = Observed {
        textures: state.textures,
        buffers: state.buffers,
        passes: own,
        output: state.outputs.last().copied(),
        left_out,
    };
    let (needed, _) = contents(&frame.passes);
    let (needed_later, touched_later) = contents(&next);
    for (index, texture) in frame.textures.iter_mut().enumerate() {
        if needed.contains(&index) {
            texture.entry = Entry::Defined;
        }
        let maybe = !touched_later.contains(&index) && !state.dropped[index];
        if needed_later.contains(&index) || maybe || frame.output == Some(index) {
            texture.exit = Exit::Keep;
        }
    }
    simplify(&mut frame, &next);
    frame
}

/// Returns the textures of which a pass uses earlier contents, and all used textures.
fn contents(passes: &[ObservedPass]) -> (HashSet<usize>, HashSet<usize>) {
    let (mut needed, mut touched, mut written) = (HashSet::new(), HashSet::new(), HashSet::new());
    for pass in passes {
        let mut use_of = |region: crate::observed::Region, effect: Effect| {
            touched.insert(region.texture);
            for part in region.subresources() {
                if effect != Effect::Overwrite && !written.contains(&part) {
                    needed.insert(region.texture);
                }
                if effect != Effect::Read {
                    written.insert(part);
                }
            }
        };
        for own in &pass.uses {
            if let Used::Texture(region) = own.of {
                use_of(region, own.effect);
            }
        }
        for own in &pass.attachments {
            match own.load {
                // Nothing is drawn, so the contents pass through.
                Load::Load if !own.written && pass.draws == 0 => {}
                Load::Load if !own.written => use_of(own.region, Effect::Read),
                Load::Load if !pass.full_screen => use_of(own.region, Effect::Modify),
                _ => use_of(own.region, Effect::Overwrite),
            }
        }
    }
    (needed, touched)
}

/// Drops uses of buffers that only the CPU writes, and passes that are left without uses. Joins uploads, and makes names
/// unique.
fn simplify(frame: &mut Observed, next: &[ObservedPass]) {
    let by_gpu = frame.passes.iter().chain(next).filter(|pass| pass.work != Work::Upload);
    let written = by_gpu.flat_map(|pass| &pass.uses);
    let written = written.filter(|own| own.effect != Effect::Read);
    let written: HashSet<usize> = written.filter_map(buffer_of).collect();
    for pass in &mut frame.passes {
        pass.uses.retain(|own| buffer_of(own).is_none_or(|buffer| written.contains(&buffer)));
    }
    frame.passes.retain(|pass| pass.work == Work::Raster || !pass.uses.is_empty());
    join_uploads(&mut frame.passes);
    let mut names = HashSet::new();
    for pass in &mut frame.passes {
        pass.name = unique(&pass.name, &mut names);
    }
    let mut names = HashSet::new();
    for texture in &mut frame.textures {
        texture.name = unique(&texture.name, &mut names);
    }
}

/// Joins consecutive uploads into one pass. A target that is uploaded again keeps the effect of its first upload.
fn join_uploads(passes: &mut Vec<ObservedPass>) {
    let mut joined: Vec<ObservedPass> = Vec::with_capacity(passes.len());
    for pass in passes.drain(..) {
        match joined.last_mut() {
            Some(last) if last.work == Work::Upload && pass.work == Work::Upload => {
                let new = |own: &&Use| !last.uses.iter().any(|known| known.of == own.of);
                let new: Vec<Use> = pass.uses.iter().filter(new).copied().collect();
                last.uses.extend(new);
            }
            _ => joined.push(pass),
        }
    }
    *passes = joined;
}

const fn buffer_of(own: &Use) -> Option<usize> {
    match own.of {
        Used::Buffer(buffer) => Some(buffer),
        Used::Texture(_) => None,
    }
}

fn unique(name: &str, known: &mut HashSet<String>) -> String {
    let numbered = (2..).map(|number| format!("{name} {number}"));
    let name = std::iter::once(name.to_owned()).chain(numbered).find(|name| !known.contains(name));
    let name = name.unwrap_or_default();
    known.insert(name.clone());
    name
}
