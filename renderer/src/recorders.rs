//! Storage for the recorders of a frame, grouped by type.
//!
//! Each recorder type has its own vector (column). Resetting a frame empties the vectors but keeps their memory, so
//! redeclaring a frame allocates nothing after the first frames.

use crate::execute::cx::Cx;
use crate::execute::epilogue::Epilogue;
use crate::execute::error::RecordError;
use framegraph::{Pass, PassId};
use std::any::{Any, TypeId};

use crate::record::Record;

/// Records one pass. Implemented for passes and for closures, each with the handles that the declaration returned.
pub(crate) trait Recorder<W: ?Sized>: Send + Sync + 'static {
    fn record(&self, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError>;

    /// Returns the epilogue of an inlined pass. Closures have none.
    fn epilogue(&self, _world: &W, _cx: &mut Cx<'_>) -> Result<Option<Epilogue>, RecordError> {
        Ok(None)
    }
}

/// A pass and the handles that its declaration returned.
pub(crate) struct PassRecorder<P: Pass> {
    pub(crate) pass: P,
    pub(crate) io: P::Io,
}

impl<W, P> Recorder<W> for PassRecorder<P>
where
    W: ?Sized,
    P: Record<W> + Send + Sync + 'static,
    P::Io: Send + Sync + 'static,
{
    fn record(&self, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        self.pass.record(&self.io, world, cx)
    }

    fn epilogue(&self, world: &W, cx: &mut Cx<'_>) -> Result<Option<Epilogue>, RecordError> {
        self.pass.epilogue(&self.io, world, cx)
    }
}

/// A closure and the handles that its declaration returned.
pub(crate) struct ClosureRecorder<Io, R> {
    pub(crate) io: Io,
    pub(crate) record: R,
}

impl<W, Io, R> Recorder<W> for ClosureRecorder<Io, R>
where
    W: ?Sized,
    Io: Send + Sync + 'static,
    R: Fn(&Io, &W, &mut Cx<'_>) -> Result<(), RecordError> + Send + Sync + 'static,
{
    fn record(&self, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        (self.record)(&self.io, world, cx)
    }
}

/// All recorders of one type.
trait Column<W: ?Sized>: Send + Sync {
    fn record(&self, row: usize, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError>;
    fn epilogue(&self, row: usize, world: &W, cx: &mut Cx<'_>) -> Result<Option<Epilogue>, RecordError>;
    fn clear(&mut self);
    fn as_any(&mut self) -> &mut dyn Any;
}

impl<W: ?Sized, T: Recorder<W>> Column<W> for Vec<T> {
    fn record(&self, row: usize, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        self[row].record(world, cx)
    }

    fn epilogue(&self, row: usize, world: &W, cx: &mut Cx<'_>) -> Result<Option<Epilogue>, RecordError> {
        self[row].epilogue(world, cx)
    }

    fn clear(&mut self) {
        self.clear();
    }

    fn as_any(&mut self) -> &mut dyn Any {
        self
    }
}

/// Recorders of the passes of one frame. See the [module documentation](self).
pub(crate) struct Recorders<W: ?Sized + 'static> {
    columns: Vec<(TypeId, Box<dyn Column<W>>)>,
    /// Column and row of each pass; `None` for a pass that was declared without a recorder.
    places: Vec<Option<(usize, usize)>>,
}

impl<W: ?Sized + 'static> Default for Recorders<W> {
    fn default() -> Self {
        Self { columns: Vec::new(), places: Vec::new() }
    }
}

impl<W: ?Sized + 'static> Recorders<W> {
    /// Stores the recorder of `pass`.
    pub(crate) fn insert<T: Recorder<W>>(&mut self, pass: PassId, recorder: T) {
        let wanted = TypeId::of::<Vec<T>>();
        let known = self.columns.iter().position(|(t, _)| *t == wanted);
        let column = known.unwrap_or_else(|| {
            self.columns.push((wanted, Box::new(Vec::<T>::new())));
            self.columns.len() - 1
        });
        let Some(rows) = self.columns[column].1.as_any().downcast_mut::<Vec<T>>() else {
            unreachable!("a column has the type of its type ID");
        };
        rows.push(recorder);
        let row = rows.len() - 1;
        if self.places.len() <= pass.index() {
            self.places.resize(pass.index() + 1, None);
        }
        self.places[pass.index()] = Some((column, row));
    }

    /// Removes all recorders but keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.columns.iter_mut().for_each(|(_, c)| c.clear());
        self.places.clear();
    }

    /// Returns whether `pass` has a recorder.
    pub(crate) fn has(&self, pass: PassId) -> bool {
        self.places.get(pass.index()).is_some_and(Option::is_some)
    }

    /// Runs the recorder of `pass`. Returns `None` if it has none.
    pub(crate) fn record(&self, pass: PassId, world: &W, cx: &mut Cx<'_>) -> Option<Result<(), RecordError>> {
        let (column, row) = (*self.places.get(pass.index())?)?;
        Some(self.columns[column].1.record(row, world, cx))
    }

    /// Returns the epilogue of `pass`, or `None` if it has no recorder or no epilogue.
    pub(crate) fn epilogue(&self, pass: PassId, world: &W, cx: &mut Cx<'_>) -> Result<Option<Epilogue>, RecordError> {
        let place = self.places.get(pass.index()).copied().flatten();
        place.map_or(Ok(None), |(column, row)| self.columns[column].1.epilogue(row, world, cx))
    }
}
