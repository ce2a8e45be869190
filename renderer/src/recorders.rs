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

/// All recorders of one type, without the type of the world.
trait Rows: Send + Sync {
    fn clear(&mut self);
    fn as_any(&self) -> &dyn Any;
    fn as_any_mut(&mut self) -> &mut dyn Any;
}

impl<T: Send + Sync + 'static> Rows for Vec<T> {
    fn clear(&mut self) {
        self.clear();
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }
}

/// Functions that call the recorders of one type.
struct Calls<W: ?Sized> {
    record: fn(&dyn Rows, usize, &W, &mut Cx<'_>) -> Result<(), RecordError>,
    epilogue: fn(&dyn Rows, usize, &W, &mut Cx<'_>) -> Result<Option<Epilogue>, RecordError>,
}

impl<W: ?Sized> Calls<W> {
    fn of<T: Recorder<W>>() -> Self {
        Self {
            record: |rows, row, world, cx| rows_of::<T>(rows)[row].record(world, cx),
            epilogue: |rows, row, world, cx| rows_of::<T>(rows)[row].epilogue(world, cx),
        }
    }
}

/// Returns the recorders of a column whose type is known to be `T`.
fn rows_of<T: 'static>(rows: &dyn Rows) -> &Vec<T> {
    rows.as_any().downcast_ref().unwrap_or_else(|| unreachable!("{WRONG_TYPE}"))
}

const WRONG_TYPE: &str = "a column has the type of its type ID";

/// Recorders of the passes of one frame. See the [module documentation](self).
pub(crate) struct Recorders<W: ?Sized> {
    columns: Vec<(TypeId, Box<dyn Rows>)>,
    /// Functions of each column; `None` if no recorder of the type was stored for this world.
    calls: Vec<Option<Calls<W>>>,
    /// Column and row of each pass; `None` for a pass that was declared without a recorder.
    places: Vec<Option<(usize, usize)>>,
}

impl<W: ?Sized> Default for Recorders<W> {
    fn default() -> Self {
        Self { columns: Vec::new(), calls: Vec::new(), places: Vec::new() }
    }
}

impl<W: ?Sized> Recorders<W> {
    /// Stores the recorder of `pass`.
    pub(crate) fn insert<T: Recorder<W>>(&mut self, pass: PassId, recorder: T) {
        let wanted = TypeId::of::<T>();
        let known = self.columns.iter().position(|(t, _)| *t == wanted);
        let column = known.unwrap_or_else(|| {
            self.columns.push((wanted, Box::new(Vec::<T>::new())));
            self.calls.push(None);
            self.columns.len() - 1
        });
        self.calls[column].get_or_insert_with(Calls::of::<T>);
        let rows: Option<&mut Vec<T>> = self.columns[column].1.as_any_mut().downcast_mut();
        let rows = rows.unwrap_or_else(|| unreachable!("{WRONG_TYPE}"));
        rows.push(recorder);
        let row = rows.len() - 1;
        if self.places.len() <= pass.index() {
            self.places.resize(pass.index() + 1, None);
        }
        self.places[pass.index()] = Some((column, row));
    }

    /// Removes all recorders but keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.columns.iter_mut().for_each(|(_, rows)| rows.clear());
        self.places.clear();
    }

    /// Removes all recorders, and keeps the memory for recorders of another world.
    pub(crate) fn for_world<V: ?Sized>(mut self) -> Recorders<V> {
        self.clear();
        let Self { columns, calls, places } = self;
        // Collecting an iterator of a vector reuses its memory.
        Recorders { columns, calls: calls.into_iter().map(|_| None).collect(), places }
    }

    /// Returns whether `pass` has a recorder.
    pub(crate) fn has(&self, pass: PassId) -> bool {
        self.places.get(pass.index()).is_some_and(Option::is_some)
    }

    /// Runs the recorder of `pass`. Returns `None` if it has none.
    pub(crate) fn record(&self, pass: PassId, world: &W, cx: &mut Cx<'_>) -> Option<Result<(), RecordError>> {
        let (rows, row, calls) = self.find(pass)?;
        Some((calls.record)(rows, row, world, cx))
    }

    /// Returns the epilogue of `pass`, or `None` if it has no recorder or no epilogue.
    pub(crate) fn epilogue(&self, pass: PassId, world: &W, cx: &mut Cx<'_>) -> Result<Option<Epilogue>, RecordError> {
        self.find(pass).map_or(Ok(None), |(rows, row, calls)| (calls.epilogue)(rows, row, world, cx))
    }

    fn find(&self, pass: PassId) -> Option<(&dyn Rows, usize, &Calls<W>)> {
        let (column, row) = (*self.places.get(pass.index())?)?;
        Some((&*self.columns[column].1, row, self.calls[column].as_ref()?))
    }
}
