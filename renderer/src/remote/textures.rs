//! Textures on demand: one at a time, read without waiting.

use super::mailbox::Mailbox;
use super::message::{RemoteTexture, TextureRequest};
use super::wire::MAX_ANSWER_BYTES;
use crate::execute::executor::Executor;
use crate::frame::Frame;
use crate::inspect::{Inspection, Inspector, Request, Started, find};
use crate::resources::imports::Imports;
use framegraph::Plan;
use std::time::{Duration, Instant};

/// Minimum time between the starts of two readbacks.
pub const TEXTURE_INTERVAL: Duration = Duration::from_millis(100);
/// Maximum size of a texture that is sent, in bytes at 16 bytes per texel. Leaves room for the title.
const MAX_TEXTURE_BYTES: u64 = MAX_ANSWER_BYTES as u64 - 4096;

/// Frame to inspect: executor, plan, recorders, world and imports.
type Inspected<'f, W> = (&'f Executor, &'f Plan, &'f Frame<W>, &'f W, &'f Imports);

/// Readbacks of the server.
#[derive(Debug, Default)]
pub(super) struct Textures {
    inspector: Option<Inspector>,
    /// Viewer, number of its request, and the readback.
    reading: Option<(usize, u32, Started)>,
    /// Answer that could not be offered yet.
    answer: Option<(usize, RemoteTexture)>,
    begun_at: Option<Instant>,
    /// Viewer that was served last.
    last: usize,
}

impl Textures {
    /// Offers a texture that has arrived, and starts to read the next requested one. Never waits.
    pub fn advance<W: ?Sized>(
        &mut self,
        mailbox: &Mailbox,
        now: Instant,
        (executor, plan, frame, world, imports): (&mut Executor, &Plan, &Frame<W>, &W, &Imports),
    ) {
        let executor = &*executor;
        if let Some((viewer, number, started)) = self.reading.take() {
            match started.try_take(executor.gpu()) {
                Ok(Err(started)) => self.reading = Some((viewer, number, started)),
                Ok(Ok(found)) => self.answer = Some((viewer, answer(number, &found))),
                Err(error) => self.answer = Some((viewer, RemoteTexture::failed(number, error.to_string()))),
            }
        }
        if let Some((viewer, texture)) = self.answer.take()
            && let Err(texture) = mailbox.offer_texture(viewer, texture)
        {
            self.answer = Some((viewer, texture));
        }
        let due = self.begun_at.is_none_or(|begun| now.duration_since(begun) >= TEXTURE_INTERVAL);
        if self.reading.is_some() || self.answer.is_some() || !due {
            return;
        }
        let Some((viewer, request)) = mailbox.take_request(self.last) else { return };
        (self.last, self.begun_at) = (viewer, Some(now));
        match self.start(&request, (executor, plan, frame, world, imports)) {
            Ok(started) => self.reading = Some((viewer, request.number, started)),
            Err(reason) => self.answer = Some((viewer, RemoteTexture::failed(request.number, reason))),
        }
    }

    /// Submits the passes that lead to a texture, and a copy of it.
    fn start<W: ?Sized>(
        &mut self,
        request: &TextureRequest,
        (executor, plan, frame, world, imports): Inspected<'_, W>,
    ) -> Result<Started, String> {
        let TextureRequest { text, aspect, sample, .. } = request;
        let parsed: Request = text.parse().map_err(|error: crate::inspect::RequestError| error.to_string())?;
        let request = Request { aspect: *aspect, sample: *sample, ..parsed };
        let target = find(plan, &request).map_err(|error| error.to_string())?;
        let [width, height] = target.size(plan.frame());
        let bytes = 16 * u64::from(width) * u64::from(height);
        if bytes > MAX_TEXTURE_BYTES {
            let max = MAX_TEXTURE_BYTES >> 20;
            return Err(format!(
                "`{text}` has {} MiB; the limit is {max} MiB, select a smaller mip level",
                bytes >> 20
            ));
        }
        let inspector = self.inspector.get_or_insert_with(|| Inspector::new(executor.gpu()));
        inspector.start_target(executor, plan, frame, world, imports, target).map_err(|error| error.to_string())
    }
}

/// Returns an inspected texture as an answer.
fn answer(number: u32, found: &Inspection) -> RemoteTexture {
    let texels = &found.texels;
    RemoteTexture {
        number,
        title: Ok(found.title()),
        format: texels.format,
        aspect: texels.aspect,
        size: texels.size,
        bits: texels.bits.iter().flatten().flat_map(|bits| bits.to_le_bytes()).collect(),
    }
}
