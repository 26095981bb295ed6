"""What the worker computes for curved parts: cuts of faces, moved faces, exported patches, errors of sizes, times of areas. No Qt."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trunnion.geometry.cut import Cut
from trunnion.model.session import Session
from trunnion.progress import Progress
from trunnion.units import timed
from trunnion_gui.worker.drawing import DrawnMesh, drawing_of
from trunnion_gui.worker.requests import SendEvent, SessionState, state_of, writes_files

if TYPE_CHECKING:
    from trunnion.plan.freeform.estimate.efficiency import EfficiencyEstimate


@dataclass(frozen=True, slots=True)
class PatchedSession:
    """A session after its part's patches were changed, and what the window draws of the part then."""

    state: SessionState
    drawing: DrawnMesh


@dataclass(frozen=True, slots=True)
class ErrorRow:
    """How exact the feature sizes are with so many points on each edge (-1: the paper's repair, -2: the exact boxes): errors as shares,
    wall time in s."""

    on_edge: int
    points: int
    largest: float
    mean: float
    seconds: float


@dataclass(frozen=True, slots=True)
class Accuracy:
    """Size errors by the number of points, and how far in mm the boundary of a face (the worst) is from its surface."""

    rows: tuple[ErrorRow, ...]
    boundary: float
    face: int


@dataclass(frozen=True, slots=True)
class AreaRow:
    """An operation that finishes an area, or all that finish a feature (then `operation` is empty): mm2, mm2/s, s; a
    rest has no area and no rate."""

    operation: str
    feature: str
    area: float
    rate: float
    seconds: float


@dataclass(frozen=True, slots=True)
class EstimatedTimes:
    """The time of finishing by area rates, s; that of the smallest cutter alone, and what cutters of their own gain and save, as shares.

    `is_measured`: the rates are those of toolpaths, not computed from feed and passes.
    """

    rows: tuple[AreaRow, ...]
    seconds: float
    alone: str
    seconds_alone: float
    gain: float
    saving: float
    is_measured: bool


@dataclass(frozen=True, slots=True)
class CutterFigures:
    """What a person types of a cutter, as words: its areas, and the area (mm2) that it finished in a measured time."""

    areas: str = ""
    measured_area: str = ""
    measured_time: str = ""


@dataclass(frozen=True, slots=True)
class EfficiencyFigures:
    """What a large cutter for some areas gains over the small one for all: s with both and with the small one alone, shares."""

    name: str
    title: str
    large: CutterFigures
    small: CutterFigures
    seconds: float
    seconds_alone: float
    gain: float
    saving: float


def cut(
    engine: Any, progress: Progress, _send_event: SendEvent, session: Session, cut: Cut
) -> PatchedSession:
    """Return the session after a face was cut in two."""
    from trunnion.pipeline.planning.patches import with_cut

    return _patched(
        engine,
        session,
        with_cut(engine, session, cut, progress.part(0.0, 0.5)),
        progress.part(0.5, 1.0),
    )


def uncut(
    engine: Any, progress: Progress, _send_event: SendEvent, session: Session, number: int
) -> PatchedSession:
    """Return the session after a cut was taken back, counted from 0."""
    from trunnion.pipeline.planning.patches import without_cut

    return _patched(
        engine,
        session,
        without_cut(engine, session, number, progress.part(0.0, 0.5)),
        progress.part(0.5, 1.0),
    )


def _patched(engine: Any, before: Session, after: Session, progress: Progress) -> PatchedSession:
    """Return a session whose part has other faces with its features found anew, where they had been found before."""
    if engine.states(before)["recognize"] in ("done", "problem"):
        after = engine.run(after, until="recognize", progress=progress)
    return PatchedSession(state_of(engine, after), drawing_of(engine.mesh(after, progress)))


def move(
    engine: Any,
    _progress: Progress,
    _send_event: SendEvent,
    session: Session,
    faces: tuple[int, ...],
    group: str,
) -> SessionState:
    """Return the session after faces went to a group by its id, or to a new one."""
    from trunnion.pipeline.planning.patches import with_moved

    after = with_moved(engine, session, faces, group)
    return state_of(engine, after)


@writes_files
def export(
    engine: Any,
    _progress: Progress,
    _send_event: SendEvent,
    session: Session,
    what: tuple[str, ...],
    path: str,
) -> int:
    """Write `local`, `remaining` or groups by their ids as STEP or IGES; return the number of faces."""
    from trunnion.pipeline.planning.patches import export as export_patches

    return export_patches(engine, session, what, path)


def accuracy(engine: Any, progress: Progress, _send_event: SendEvent, session: Session) -> Accuracy:
    """Return how exact the feature sizes are by the number of points on each edge."""
    from trunnion.recognize.surface.accuracy import COUNTS, size_errors

    part = engine.context_of(session).part
    rows = tuple(
        ErrorRow(r.on_edge, r.points, r.largest, r.mean, r.seconds)
        for r in size_errors(part, part.tags, COUNTS, progress)
    )
    errors = part.boundary_error()
    worst = max(errors, key=lambda tag: errors[tag])
    return Accuracy(rows, errors[worst], worst)


def estimate(
    engine: Any, _progress: Progress, _send_event: SendEvent, session: Session
) -> EstimatedTimes | None:
    """Return the time of finishing by area rates, None where no areas are finished."""
    from trunnion.pipeline.planning.finishing_estimate import estimate as estimated

    found = estimated(session, engine.context_of(session))
    if found is None:
        return None
    rows = tuple(
        AreaRow(a.operation, a.feature, a.area, a.rate, a.seconds) for a in found.areas
    ) + tuple(AreaRow("", t.feature, t.area, 0.0, t.seconds) for t in found.totals)
    return EstimatedTimes(
        rows,
        found.seconds,
        found.alone,
        found.seconds_alone,
        found.gain,
        found.saving,
        bool(session.paths),
    )


def example_efficiencies(
    _engine: Any, _progress: Progress, _send_event: SendEvent
) -> tuple[EfficiencyFigures, ...]:
    """Return the estimates that are shipped."""
    from trunnion.plan.freeform.estimate.efficiency_file import example_estimates

    return tuple(map(_figures, example_estimates()))


def read_efficiencies(
    _engine: Any, _progress: Progress, _send_event: SendEvent, path: str
) -> tuple[EfficiencyFigures, ...]:
    """Return the estimates of a file."""
    from trunnion.plan.freeform.estimate.efficiency_file import read_estimates

    return tuple(map(_figures, read_estimates(Path(path))))


def efficiency(
    _engine: Any,
    _progress: Progress,
    _send_event: SendEvent,
    large: CutterFigures,
    small: CutterFigures,
) -> EfficiencyFigures:
    """Return the gain that figures give which a person typed."""
    from trunnion.plan.freeform.estimate.efficiency_file import typed_estimate

    return _figures(typed_estimate(asdict(large), asdict(small)))


def _figures(found: EfficiencyEstimate) -> EfficiencyFigures:
    large, small = (
        CutterFigures(
            areas=", ".join(map(repr, cutter.areas)),
            measured_area=repr(cutter.rate.area),
            measured_time=timed(cutter.rate.time),
        )
        for cutter in (found.large, found.small)
    )
    return EfficiencyFigures(
        found.name,
        found.title,
        large,
        small,
        found.seconds,
        found.seconds_alone,
        found.gain,
        found.saving,
    )
