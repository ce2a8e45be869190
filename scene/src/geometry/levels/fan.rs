//! The triangles about a point of a surface, and the edges from it.

/// A point with more triangles about it, the tip of a cone, stays where it is, and nothing goes to it: its fan is left empty.
pub(super) const MAX_CORNERS: usize = 64;

/// A triangle about a point: the vertex at the point, then the others in the order of the triangle.
pub(super) type Corner = [u32; 3];

/// An edge from a point.
#[derive(Clone, Copy)]
pub(super) struct Spoke {
    /// The point at its other end.
    pub rim: u32,
    /// Its vertices in the triangle that goes from the point to the rim, and in the one that comes back: at the point, at the rim.
    sides: [Option<[u32; 2]>; 2],
}

impl Spoke {
    pub fn is_border(&self) -> bool {
        self.sides.iter().any(Option::is_none)
    }

    /// Whether the vertices at the point are others on both sides.
    pub fn is_seam(&self) -> bool {
        matches!(self.sides, [Some(out), Some(back)] if out[0] != back[0])
    }

    /// Into which vertex of the rim each vertex of the point goes when the point goes there: the triangles on both sides say.
    pub fn pairs(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        self.sides.into_iter().flatten()
    }
}

/// A point of a surface with what is about it.
#[derive(Default)]
pub(super) struct Fan {
    pub corners: Vec<Corner>,
    pub spokes: Vec<Spoke>,
    /// The triangles are one fan, closed or open, with each edge once on either side.
    whole: bool,
    borders: usize,
    seams: usize,
}

impl Fan {
    /// Takes these corners of a point; `point` is that of a vertex.
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
        // From edge to edge around: fans that meet in the point alone are not all gone through.
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

    /// Whether the point may go to the other end of an edge: of a border or a seam along it, and of what is whole anywhere, as
    /// long as each vertex at the point has one to go into.
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

    /// Whether this point and the one at the other end of an edge, which is about `other`, have no neighbors in common but those of
    /// the edge's own triangles: else the surface would touch itself where the edge was.
    pub fn stays_whole(&self, edge: &Spoke, other: &Self) -> bool {
        let common = self.spokes.iter().filter(|own| other.spokes.iter().any(|theirs| theirs.rim == own.rim)).count();
        common == edge.pairs().count()
    }
}
