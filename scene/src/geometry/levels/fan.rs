//! Triangle fan around a point of a surface, and its edges.

/// Maximum number of triangles around a point. A point with more, such as the tip of a cone, is never collapsed: its
/// fan is left empty.
pub(super) const MAX_CORNERS: usize = 64;

/// A triangle about a point: the vertex at the point, then the others in the order of the triangle.
pub(super) type Corner = [u32; 3];

/// Edge from a point.
#[derive(Clone, Copy)]
pub(super) struct Spoke {
    /// Point at the other end.
    pub rim: u32,
    /// Vertices of the edge, at the point and at the rim, in the triangle that traverses it outward and in the one that
    /// returns.
    sides: [Option<[u32; 2]>; 2],
}

impl Spoke {
    pub fn is_border(&self) -> bool {
        self.sides.iter().any(Option::is_none)
    }

    /// Returns true if the two sides of the edge use different vertices at the point.
    pub fn is_seam(&self) -> bool {
        matches!(self.sides, [Some(out), Some(back)] if out[0] != back[0])
    }

    /// Returns the pairs of vertices that merge if the point collapses to the rim, according to the triangles on both
    /// sides.
    pub fn pairs(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        self.sides.into_iter().flatten()
    }
}

/// A point of a surface with its adjacent triangles and edges.
#[derive(Default)]
pub(super) struct Fan {
    pub corners: Vec<Corner>,
    pub spokes: Vec<Spoke>,
    /// True if the triangles form one fan, closed or open, with each edge once per side.
    whole: bool,
    borders: usize,
    seams: usize,
}

impl Fan {
    /// Fills the fan with these corners of a point; `point` maps vertices to points.
    pub fn fill(&mut self, corners: impl Iterator<Item = Corner>, point: &[u32]) {
        let Self { corners: own, spokes, .. } = self;
        own.clear();
        spokes.clear();
        own.extend(corners);
        self.whole = true;
        for &[hub, next, last] in &*own {
            for (side, rim) in [next, last].into_iter().enumerate() {
                let of = point[rim as usize];
                let at = spokes.iter().position(|spoke| spoke.rim == of).unwrap_or_else(|| {
                    spokes.push(Spoke { rim: of, sides: [None; 2] });
                    spokes.len() - 1
                });
                self.whole &= spokes[at].sides[side].replace([hub, rim]).is_none();
            }
        }
        // Walks from edge to edge; fans that touch only at the point are not reached from each other.
        let open = spokes.iter().find(|spoke| spoke.sides[1].is_none());
        let start = open.or(spokes.first()).map(|spoke| spoke.rim);
        let (mut at, mut reached) = (start, 0);
        while let Some(rim) = at.filter(|_| reached <= own.len()) {
            reached += 1;
            let next = own.iter().find(|[_, next, _]| point[*next as usize] == rim);
            at = next.map(|[_, _, last]| point[*last as usize]).filter(|next| Some(*next) != start);
        }
        self.whole &= reached == spokes.len();
        self.borders = spokes.iter().filter(|spoke| spoke.is_border()).count();
        self.seams = spokes.iter().filter(|spoke| spoke.is_seam()).count();
    }

    /// Returns true if the point may collapse to the other end of an edge. Points on a border or seam may only move
    /// along it; inner points may move anywhere. Each vertex at the point needs one to merge into.
    pub fn may_go(&self, to: &Spoke) -> bool {
        let along = match (self.borders, self.seams) {
            (0, 0) => true,
            (2, 0) => to.is_border(),
            (0, 2) => to.is_seam(),
            _ => false,
        };
        let each_goes = |[hub, ..]: &Corner| to.pairs().any(|[from, _]| from == *hub);
        let mut pairs = to.pairs();
        let (first, second) = (pairs.next(), pairs.next());
        let to_one = |([from, to], [other, there]): ([u32; 2], [u32; 2])| from != other || to == there;
        along && self.whole && self.corners.iter().all(each_goes) && first.zip(second).is_none_or(to_one)
    }

    /// Returns true if this point and the other end of the edge share no neighbors except those of the edge's own
    /// triangles. `other` is the fan of the other end. A collapse with further common neighbors would make the surface
    /// touch itself.
    pub fn stays_whole(&self, edge: &Spoke, other: &Self) -> bool {
        let common = self.spokes.iter().filter(|own| other.spokes.iter().any(|theirs| theirs.rim == own.rim)).count();
        common == edge.pairs().count()
    }
}
