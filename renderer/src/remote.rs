//! Server in an engine that viewers attach to over TCP (feature `remote`).
//!
//! An attached viewer receives the plan of the running frame with its declared graph, and the times of each step. It
//! requests the contents of textures. Start a [`Server`] once, and call [`Server::after_frame`] after each frame:
//!
//! ```
//! # use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, TextureDesc};
//! # use framegraph_wgpu::{FrameLoop, Gpu, remote};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let gpu = Gpu::noop()?;
//! let mut frames = FrameLoop::<()>::new(&gpu);
//! let mut server = remote::Server::start("127.0.0.1:0", "my engine")?;
//! for _ in 0..3 {
//!     frames.run([64, 36], &(), |frame, _| {
//!         let sky = frame.graph_mut().texture("sky", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
//!         let clear = Intent::Clear(ClearValue::BLACK);
//!         let sky = frame.add_fn("clear", |pass| pass.color(sky, clear), |_, _, _| Ok(()))?;
//!         frame.graph_mut().readback(sky)?;
//!         Ok::<_, DeclareError>(())
//!     })?;
//!     server.after_frame(&mut frames, &());
//! }
//! println!("viewer --attach {}", server.address());
//! # Ok(())
//! # }
//! ```
//!
//! # Cost
//!
//! The frame never waits for a viewer. [`Server::after_frame`] only tries locks, and puts its data into one slot of each
//! kind: a newer plan or sample of times replaces one that no viewer took. Other threads encode and send. Without a
//! viewer, the call reads one atomic number. A texture costs a second execution of the passes that lead to it; the
//! minimum interval between two of them is [`TEXTURE_INTERVAL`].
//!
//! # Protocol
//!
//! Each side begins with [`MAGIC`] and its [`VERSION`] (`u32`, little-endian). Then messages follow: the number of bytes
//! (`u32`, little-endian) and a [`FromEngine`] or [`FromViewer`] in the format of the crate `postcard`. The server closes
//! a connection after a wrong beginning, a message that is invalid or longer than [`MAX_REQUEST_BYTES`], or half a
//! message followed by [`PATIENCE`] of silence. It reports the reason first. At most [`MAX_VIEWERS`] are attached.
//!
//! The protocol has neither encryption nor authentication. Addresses other than loopback are open to the network.

mod connection;
mod error;
mod mailbox;
mod message;
mod peer;
mod server;
mod textures;
mod wire;

pub use connection::Connection;
pub use error::RemoteError;
pub use mailbox::{MAX_VIEWERS, RemoteCounts};
pub use message::{FrameSample, FromEngine, FromViewer, RemotePlan, RemoteTexture, StepSample, TextureRequest};
pub use server::{DEFAULT_ADDRESS, Server};
pub use textures::TEXTURE_INTERVAL;
pub use wire::{MAGIC, MAX_ANSWER_BYTES, MAX_REQUEST_BYTES, PATIENCE, VERSION};
