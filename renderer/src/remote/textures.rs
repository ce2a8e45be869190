//! Textures on demand: one at a time, read without waiting.

use super::mailbox::{Mailbox, Requested};
use super::message::{RemoteTexture, TextureRequest};
use super::wire::MAX_ANSWER_BYTES;
use crate::execute::executor::Executor;
use crate::frame::Frame;
use crate::inspect::{Arrived, Inspector, Request, Started, find};
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
    /// Request, and its readback.
    reading: Option<(Requested, Started)>,
    /// Answer that could not be offered yet, with its request.
    answer: Option<(Requested, RemoteTexture)>,
    begun_at: Option<Instant>,
    /// Viewer that was served last.
    last: usize,
}

impl Textures {
    /// Frees everything. The time of the last readback is kept, so that the minimum interval still holds.
    pub fn reset(&mut self) {
        (self.inspector, self.reading, self.answer) = (None, None, None);
    }

    /// Offers a texture that has arrived, and starts to read the next requested one. Never waits.
    pub fn advance<W: ?Sized>(
        &mut self,
        mailbox: &Mailbox,
        now: Instant,
        (executor, plan, frame, world, imports): (&mut Executor, &Plan, &Frame<W>, &W, &Imports),
    ) {
        let executor = &*executor;
        if let Some((requested, started)) = self.reading.take() {
            let number = requested.request.number;
            match started.try_take(executor.gpu()) {
                Ok(Err(started)) => self.reading = Some((requested, started)),
                Ok(Ok(found)) => self.answer = Some((requested, answer(number, found))),
                Err(error) => self.answer = Some((requested, RemoteTexture::failed(number, error.to_string()))),
            }
        }
        if let Some((requested, texture)) = self.answer.take()
            && let Err(texture) = mailbox.offer_texture(&requested, texture)
        {
            self.answer = Some((requested, texture));
        }
        let due = self.begun_at.is_none_or(|begun| now.duration_since(begun) >= TEXTURE_INTERVAL);
        if self.reading.is_some() || self.answer.is_some() || !due {
            return;
        }
        let Some(requested) = mailbox.take_request(self.last) else { return };
        (self.last, self.begun_at) = (requested.viewer, Some(now));
        match self.start(&requested.request, (executor, plan, frame, world, imports)) {
            Ok(started) => self.reading = Some((requested, started)),
            Err(reason) => {
                let answer = RemoteTexture::failed(requested.request.number, reason);
                self.answer = Some((requested, answer));
            }
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
fn answer(number: u32, found: Arrived) -> RemoteTexture {
    let Arrived { target, size, bits } = found;
    RemoteTexture { number, title: Ok(target.title()), format: target.format, aspect: target.aspect, size, bits }
}
