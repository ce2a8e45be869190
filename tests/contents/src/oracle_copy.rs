//! Copy passes of the oracle.

use super::code::{bytes_of, coding, planes, texel_hash, word};
use super::copy::{Copy, Spot, copies};
use super::oracle::{Contents, Machine, part_index, places};
use super::spec;
use framegraph::{Access, Aspect, Desc, Mode, PassId, ResourceId};

impl Machine<'_> {
    /// Runs a copy pass.
    pub fn copy(&mut self, pass: PassId) {
        let accesses = self.graph.accesses_of(pass);
        let salt = spec::salt(pass, self.frame);
        // Clears run before all copies.
        for access in accesses.iter().filter(|a| a.mode == Mode::Clear) {
            self.clear(access);
        }
        for copy in copies(self.graph, pass).unwrap_or_default() {
            match copy {
                Copy::Pattern { into, plane } => {
                    let access = &accesses[into.access];
                    let Desc::Texture(desc) = self.graph.resources()[access.resource.index()].desc else { continue };
                    let tag =
                        spec::tag(into.access, spec::plane_index(desc.format, plane), into.mip) + u32::from(into.layer);
                    let coding = coding(desc.format, plane);
                    let [width, height] = spec::texels(self.graph, access.resource, into.mip);
                    let painted = |(x, y)| coding.painted(texel_hash(salt, tag, x, y));
                    let at = part_index(self.graph, access.resource, into.mip, into.layer, plane);
                    *self.part_mut(access.resource, at) = Some(places(width, height).map(painted).collect());
                }
                Copy::Zero { into } => {
                    let access = &accesses[into.access];
                    let Desc::Texture(desc) = self.graph.resources()[access.resource.index()].desc else { continue };
                    let [width, height] = spec::texels(self.graph, access.resource, into.mip);
                    for plane in planes(desc.format) {
                        let at = part_index(self.graph, access.resource, into.mip, into.layer, plane);
                        *self.part_mut(access.resource, at) = Some(vec![[0; 4]; (width * height) as usize]);
                    }
                }
                Copy::Texture { from, into, texels } => self.copy_texture(accesses, from, into, texels),
                Copy::PatternBuffer { into, bytes } => {
                    let resource = accesses[into].resource;
                    let length = self.graph.resources()[resource.index()].desc.bytes(super::FRAME);
                    if bytes == length {
                        self.contents[resource.index()] = Contents::Buffer(Some(vec![0; length as usize]));
                    }
                    let tag = spec::tag(into, 0, 0);
                    let words = (0..bytes as u32 / 4).flat_map(|i| word(salt, tag, i).to_le_bytes()).collect();
                    self.put_into_buffer(resource, Some(vec![(0, words)]));
                }
                Copy::Buffer { from, into, bytes } => {
                    let source = self.bytes(accesses[from].resource).map(|b| b[..bytes as usize].to_vec());
                    self.put_into_buffer(accesses[into].resource, source.map(|s| vec![(0, s)]));
                }
                Copy::Rows { from, into, offset, pitch, texels } => {
                    let rows = self.rows(accesses[from.access].resource, from, Aspect::All, (offset, pitch), texels);
                    self.put_into_buffer(accesses[into].resource, rows);
                }
                Copy::Note { note, from, plane, pitch, texels } => {
                    let rows = self.rows(accesses[from.access].resource, from, plane, (0, pitch), texels);
                    self.notes[pass.index()][note] = rows.map(|rows| {
                        let mut noted = vec![0; (pitch * texels[1]) as usize];
                        rows.into_iter().for_each(|(first, row)| noted[first..first + row.len()].copy_from_slice(&row));
                        noted
                    });
                }
                Copy::NoteBuffer { note, from, bytes } => {
                    let noted = self.bytes(accesses[from].resource).map(|b| b[..bytes as usize].to_vec());
                    self.notes[pass.index()][note] = noted;
                }
            }
        }
    }

    fn clear(&mut self, access: &Access) {
        let Desc::Texture(desc) = self.graph.resources()[access.resource.index()].desc else {
            let length = self.graph.resources()[access.resource.index()].desc.bytes(super::FRAME);
            self.contents[access.resource.index()] = Contents::Buffer(Some(vec![0; length as usize]));
            return;
        };
        for plane in spec::planes_of(desc.format, access.range.aspect) {
            let value = coding(desc.format, plane).cleared(self.graph.clears()[access.clear as usize]);
            for mip in spec::mips(self.graph, access) {
                let [width, height] = spec::texels(self.graph, access.resource, mip);
                for layer in spec::layers(self.graph, access) {
                    let at = part_index(self.graph, access.resource, mip, layer, plane);
                    *self.part_mut(access.resource, at) = Some(vec![value; (width * height) as usize]);
                }
            }
        }
    }

    fn copy_texture(&mut self, accesses: &[Access], from: Spot, into: Spot, [width, height]: [u32; 2]) {
        let (source, target) = (accesses[from.access].resource, accesses[into.access].resource);
        let Desc::Texture(desc) = self.graph.resources()[source.index()].desc else { return };
        let pitch = |resource, mip| spec::texels(self.graph, resource, mip)[0];
        let (from_pitch, into_pitch) = (pitch(source, from.mip), pitch(target, into.mip));
        for plane in planes(desc.format) {
            let at = part_index(self.graph, source, from.mip, from.layer, plane);
            let read = self.part(source, at).clone();
            let at = part_index(self.graph, target, into.mip, into.layer, plane);
            let part = self.part_mut(target, at);
            *part = part.take().zip(read).map(|(mut texels, read)| {
                for (x, y) in places(width, height) {
                    texels[(y * into_pitch + x) as usize] = read[(y * from_pitch + x) as usize];
                }
                texels
            });
        }
    }

    /// Returns the rows of a plane as they are copied to a buffer, each with its offset in bytes.
    fn rows(
        &self,
        resource: ResourceId,
        from: Spot,
        plane: Aspect,
        (offset, pitch): (u64, u32),
        [width, rows]: [u32; 2],
    ) -> Option<Vec<(usize, Vec<u8>)>> {
        let format = self.graph.resources()[resource.index()].desc.texture()?.format;
        let texels = self.part(resource, part_index(self.graph, resource, from.mip, from.layer, plane)).as_ref()?;
        let row = |y: u32| {
            let row = &texels[(y * width) as usize..((y + 1) * width) as usize];
            let bytes = row.iter().flat_map(|t| bytes_of(format, plane, *t)).collect();
            ((offset + u64::from(y * pitch)) as usize, bytes)
        };
        Some((0..rows).map(row).collect())
    }

    /// Writes pieces to a buffer; undefined pieces make the buffer undefined.
    fn put_into_buffer(&mut self, resource: ResourceId, pieces: Option<Vec<(usize, Vec<u8>)>>) {
        let Contents::Buffer(bytes) = &mut self.contents[resource.index()] else { return };
        *bytes = bytes.take().zip(pieces).map(|(mut bytes, pieces)| {
            for (first, piece) in pieces {
                bytes[first..first + piece.len()].copy_from_slice(&piece);
            }
            bytes
        });
    }
}
