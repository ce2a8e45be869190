//! Indices of triangle lists (appendix A, mode 1).

use super::error::MeshoptError;
use super::indices::push;
use super::input::{Input, unzigzag};
use super::layout::Layout;

const HEADER: u8 = 0xe1;
/// Length of the code table at the end.
const TABLE_BYTES: usize = 16;

/// Decodes triangles from one code byte each, with additional data after the codes where a code requires it.
pub(super) fn decode(layout: &Layout, bytes: &[u8]) -> Result<Vec<u8>, MeshoptError> {
    if bytes[0] != HEADER {
        return Err(MeshoptError::Header { found: bytes[0], expected: "0xe1" });
    }
    let (codes, rest) = bytes[1..].split_at(layout.count / 3);
    let (data, table) = rest.split_at(rest.len() - TABLE_BYTES);
    check_table(table)?;
    let mut decoder = Decoder { input: Input::new(data), next: 0, last: 0, edges: Fifo::new(), vertices: Fifo::new() };
    let mut decoded = Vec::with_capacity(layout.count * layout.stride);
    for (triangle, code) in codes.iter().enumerate() {
        decoder.input.element = 3 * triangle;
        let corners = decoder.triangle(*code, table)?;
        let corners = corners.ok_or(MeshoptError::BeforeFirst { triangle })?;
        corners.into_iter().for_each(|corner| push(&mut decoded, corner, layout.stride));
    }
    decoder.input.finish()?;
    Ok(decoded)
}

/// Checks that the last two bytes are zero and that no half of a byte is 15.
fn check_table(table: &[u8]) -> Result<(), MeshoptError> {
    let wrong = |(place, byte): &(usize, &u8)| {
        let unused = *place >= TABLE_BYTES - 2 && **byte != 0;
        unused || **byte >> 4 == 15 || **byte & 15 == 15
    };
    match table.iter().enumerate().find(wrong) {
        Some((place, byte)) => Err(MeshoptError::Table { place, byte: *byte }),
        None => Ok(()),
    }
}

/// State between triangles.
struct Decoder<'a> {
    input: Input<'a>,
    /// Next new vertex, after the highest so far.
    next: u32,
    /// Last vertex that was encoded as a difference.
    last: u32,
    edges: Fifo<[u32; 2]>,
    vertices: Fifo<u32>,
}

impl Decoder<'_> {
    /// Decodes a triangle; `None` if it refers to an edge or a vertex that does not exist yet.
    fn triangle(&mut self, code: u8, table: &[u8]) -> Result<Option<[u32; 3]>, MeshoptError> {
        let (high, low) = (code >> 4, code & 15);
        if high < 15 {
            return self.beside_edge(high, low);
        }
        match low {
            // No half of a table byte is 15, so no data is read.
            0..14 => self.free(0, table[usize::from(low)]),
            _ => {
                let halves = self.input.byte()?;
                if halves == 0 {
                    self.next = 0;
                }
                self.free(if low == 14 { 0 } else { 15 }, halves)
            }
        }
    }

    /// Decodes a triangle of a recent edge and a third vertex.
    fn beside_edge(&mut self, edge: u8, third: u8) -> Result<Option<[u32; 3]>, MeshoptError> {
        let Some([a, b]) = self.edges.get(edge) else {
            return Ok(None);
        };
        let c = match third {
            0 => self.take_next(),
            1..13 => match self.vertices.get(third) {
                Some(vertex) => vertex,
                None => return Ok(None),
            },
            13 => self.add_to_last(u32::MAX),
            14 => self.add_to_last(1),
            _ => self.difference()?,
        };
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        if !(1..13).contains(&third) {
            self.vertices.push(c);
        }
        Ok(Some([a, b, c]))
    }

    /// Decodes a triangle without a recent edge: `first` and the halves of `others` each select a vertex.
    fn free(&mut self, first: u8, others: u8) -> Result<Option<[u32; 3]>, MeshoptError> {
        let names = [first, others >> 4, others & 15];
        let mut corners = [0; 3];
        for (corner, name) in corners.iter_mut().zip(names) {
            *corner = match name {
                0 => self.take_next(),
                15 => self.difference()?,
                _ => match self.vertices.get(name - 1) {
                    Some(vertex) => vertex,
                    None => return Ok(None),
                },
            };
        }
        let [a, b, c] = corners;
        self.edges.push([b, a]);
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        for (corner, name) in corners.into_iter().zip(names) {
            if matches!(name, 0 | 15) {
                self.vertices.push(corner);
            }
        }
        Ok(Some(corners))
    }

    fn take_next(&mut self) -> u32 {
        let vertex = self.next;
        self.next = vertex.wrapping_add(1);
        vertex
    }

    fn difference(&mut self) -> Result<u32, MeshoptError> {
        let number = self.input.number()?;
        Ok(self.add_to_last(unzigzag(number)))
    }

    fn add_to_last(&mut self, difference: u32) -> u32 {
        self.last = self.last.wrapping_add(difference);
        self.last
    }
}

/// Last 16 pushed values.
struct Fifo<T> {
    values: [T; 16],
    /// Number of pushed values.
    pushed: usize,
}

impl<T: Copy + Default> Fifo<T> {
    fn new() -> Self {
        Self { values: [T::default(); 16], pushed: 0 }
    }

    fn push(&mut self, value: T) {
        self.values[self.pushed % 16] = value;
        self.pushed += 1;
    }

    /// Returns a value by its age: 0 is the last one, 15 the oldest.
    fn get(&self, age: u8) -> Option<T> {
        let place = self.pushed.checked_sub(1 + usize::from(age))?;
        Some(self.values[place % 16])
    }
}
