//! OpenEXR, decoded by the `exr` crate.

use std::io::{Cursor, Seek, Write};

use exr::math::Vec2;
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use exr::prelude::{ReadChannels, ReadLayers, SpecificChannels, Text, WritableImage, read};

use super::error::CodecError;
use super::picture::{PictureF32, check_size};

/// Maximum number of channels of a layer. Images have four; renderings with many outputs have a few dozen.
const MAX_CHANNELS: u64 = 64;
/// Maximum bytes of a block of rows or a tile before compression.
const MAX_BLOCK_BYTES: u64 = 1 << 28;

/// Returns the size of the image that [`decode`] returns.
pub(crate) fn header(bytes: &[u8], max_texels: [u32; 2]) -> Result<[u32; 2], CodecError> {
    let meta = MetaData::read_from_buffered(bytes, false).map_err(CodecError::other)?;
    meta.headers.iter().try_for_each(|header| check_header(header, max_texels))?;
    picture_size(colored(&meta.headers)?, max_texels)
}

/// Returns the first layer that has colors.
fn colored(headers: &[Header]) -> Result<&Header, CodecError> {
    let has = |header: &Header, name| header.channels.find_index_of_channel(&Text::from(name)).is_some();
    let has_rgb = |header: &&Header| !header.deep && ["R", "G", "B"].into_iter().all(|name| has(header, name));
    headers.iter().find(has_rgb).ok_or(CodecError::NoColor)
}

fn picture_size(header: &Header, max_texels: [u32; 2]) -> Result<[u32; 2], CodecError> {
    let size = header.shared_attributes.display_window.size;
    let size_texels = [size.width() as u32, size.height() as u32];
    check_size(size_texels, max_texels)?;
    Ok(size_texels)
}

/// Decodes the first layer with channels R, G and B to four numbers a texel over the display window. Alpha is 1 without
/// a channel A; texels outside of the data window are 0.
pub(crate) fn decode(bytes: &[u8], max_texels: [u32; 2]) -> Result<PictureF32, CodecError> {
    // The reader trusts the sizes when it is created, so the header is checked before.
    header(bytes, max_texels)?;
    let reader = exr::block::read(Cursor::new(bytes), false).map_err(CodecError::other)?;
    let header = colored(reader.headers())?;
    let window = header.shared_attributes.display_window;
    let size_texels = picture_size(header, max_texels)?;
    let offset = header.own_attributes.layer_position - window.position;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            move |_, _| vec![[0.0_f32; 4]; window.size.area()],
            move |texels, at, (r, g, b, a): (f32, f32, f32, f32)| {
                let at = at.to_i32() + offset;
                let inside = |at: i32, side: usize| usize::try_from(at).ok().filter(|at| *at < side);
                if let (Some(x), Some(y)) = (inside(at.x(), window.size.width()), inside(at.y(), window.size.height()))
                {
                    texels[Vec2(x, y).flat_index_for_size(window.size)] = [r, g, b, a];
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_chunks(reader)
        .map_err(CodecError::other)?;
    Ok(PictureF32 { size_texels, rgba: image.layer_data.channel_data.pixels })
}

/// Rejects a header whose sizes would let the decoder allocate without bound. The size of a block follows from the data
/// window, which may differ from the image size, and from the tiles.
fn check_header(header: &Header, [max_width, max_height]: [u32; 2]) -> Result<(), CodecError> {
    let size = header.layer_size;
    let mut sizes = vec![
        ("width of the data window in texels", size.width(), u64::from(max_width)),
        ("height of the data window in texels", size.height(), u64::from(max_height)),
        ("number of channels", header.channels.list.len(), MAX_CHANNELS),
    ];
    if let BlockDescription::Tiles(tiles) = header.blocks {
        let tile = tiles.tile_size;
        sizes.push(("width of a tile in texels", tile.width(), max_width.into()));
        sizes.push(("height of a tile in texels", tile.height(), max_height.into()));
    }
    let too_large = |what, value: usize, limit| CodecError::TooLarge { what, value: value as u64, limit };
    if let Some((what, value, limit)) = sizes.into_iter().find(|(_, value, limit)| *value as u64 > *limit) {
        return Err(too_large(what, value, limit));
    }
    // Checked last, since the product of sizes within their limits cannot overflow.
    match header.max_block_byte_size() {
        block if block as u64 > MAX_BLOCK_BYTES => Err(too_large("size of a block in bytes", block, MAX_BLOCK_BYTES)),
        _ => Ok(()),
    }
}

/// Encodes four numbers a texel, linear light, as 32-bit floats with lossless compression. The number of texels must
/// match the size.
pub(crate) fn encode(to: impl Write + Seek, size_texels: [u32; 2], rgba: &[[f32; 4]]) -> Result<(), CodecError> {
    let size = Vec2(size_texels[0] as usize, size_texels[1] as usize);
    let channels = SpecificChannels::rgba(|at: Vec2<usize>| {
        let [r, g, b, a] = rgba[at.flat_index_for_size(size)];
        (r, g, b, a)
    });
    exr::prelude::Image::from_channels(size, channels).write().to_buffered(to).map_err(CodecError::other)
}
