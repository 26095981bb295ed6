"""What the worker can be asked for: each verb calls the engine and answers with plain data that the window draws or shows. No Qt.

Verbs take the engine, a progress, a way to tell of what is done so far, and their own arguments; `VERBS` lists them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from trunnion.findings import Cancelled, TrunnionError
from trunnion.geometry.cut import Cut
from trunnion.model.session import Session
from trunnion.progress import Progress
from trunnion.settings import Declared, declared
from trunnion_gui.drawing import Drawing, drawing_of, drawn_map
from trunnion_gui.steps import share, until


@dataclass(frozen=True, slots=True)
class State:
    """A session, the state of each step, and the line of the step that refused after others were done."""

    session: Session
    steps: dict[str, str]
    refusal: str = ""


@dataclass(frozen=True, slots=True)
class Opened:
    """A session as opened, with what the window draws, and the part file's bytes and suffix for a worker that must take over."""

    state: State
    drawing: Drawing
    kept: tuple[bytes, str]


@dataclass(frozen=True, slots=True)
class Patched:
    """A session after its part's patches were changed, and what the window draws of the part then."""

    state: State
    drawing: Drawing


@dataclass(frozen=True, slots=True)
class ErrorRow:
    """How exact the feature sizes are with so many points on each edge (-1: the paper's repair): errors as shares, wall time in s."""

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
    """An operation that finishes an area: mm2, mm2/s, s."""

    operation: str
    tool: str
    area: float
    rate: float
    seconds: float


@dataclass(frozen=True, slots=True)
class Estimated:
    """The time of finishing by area rates, s; that of the slowest cutter alone, and what cutters of their own gain and save, as shares.

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
class Group:
    """The declared settings of one group, as the window's forms need them (the class stays in the worker)."""

    name: str
    title: str
    settings: tuple[Declared, ...]


Tell = Callable[[str, Any], None]


def _open(engine: Any, progress: Progress, tell: Tell, path: str, solid: int | None) -> Opened:
    session = engine.open(path, solid=solid, progress=progress.part(0.0, 0.8))
    tell("progress", (0.85, "preparing the picture"))
    mesh = engine.mesh(session, progress.part(0.85, 1.0))
    return Opened(State(session, engine.states(session)), drawing_of(mesh), engine.keep())


def _run(engine: Any, progress: Progress, tell: Tell, session: Session, last: str) -> State:
    before = engine.states(session)
    steps = [s for s in until(last) if before[s] in ("empty", "stale")] or [last]
    for step in steps:
        tell("stage", (step, None))
        try:
            session = engine.run(session, until=step, progress=_own_share(progress.part(*share(step, steps)), step))
        except TrunnionError as reason:
            if step == steps[0]:
                raise
            return State(session, engine.states(session), str(reason))
        if step != steps[-1]:
            tell("stage", (step, State(session, engine.states(session))))
    return State(session, engine.states(session))


def _own_share(progress: Progress, step: str) -> Progress:
    """Return the progress of one step whose engine counts the steps before it, done long ago, as so many equal shares."""
    done = len(until(step)) - 1

    def is_cancelled() -> bool:
        try:
            progress.check()
        except Cancelled:
            return True
        return False

    return Progress(lambda fraction, text: progress.at(fraction * (done + 1) - done, text), is_cancelled)


def _states(engine: Any, _progress: Progress, _tell: Tell, session: Session) -> State:
    return State(session, engine.states(session))


def _attach(engine: Any, progress: Progress, _tell: Tell, session: Session, data: bytes, suffix: str) -> State:
    engine.attach(session, data, suffix, progress=progress)
    return State(session, engine.states(session))


def _save(engine: Any, progress: Progress, _tell: Tell, session: Session, path: str) -> str:
    engine.save(session, path, progress)
    return path


def _write(engine: Any, progress: Progress, _tell: Tell, session: Session, folder: str) -> tuple[str, ...]:
    return tuple(str(name) for name in engine.write(session, folder, progress=progress))


def _playback(engine: Any, progress: Progress, _tell: Tell, session: Session) -> Any:
    return engine.playback(session, progress=progress)


def _moment(engine: Any, progress: Progress, _tell: Tell, key: str, position: float, seconds: float) -> Any:
    return engine.moment(key, position, seconds, progress)


def _deviation(engine: Any, progress: Progress, _tell: Tell, session: Session) -> Any:
    return drawn_map(engine.deviation_map(session, progress))


def _cut(engine: Any, progress: Progress, _tell: Tell, session: Session, cut: Cut) -> Patched:
    from trunnion.pipeline.patches import with_cut

    return _patched(engine, session, with_cut(engine, session, cut, progress.part(0.0, 0.5)), progress.part(0.5, 1.0))


def _uncut(engine: Any, progress: Progress, _tell: Tell, session: Session, number: int) -> Patched:
    from trunnion.pipeline.patches import without_cut

    return _patched(engine, session, without_cut(engine, session, number, progress.part(0.0, 0.5)), progress.part(0.5, 1.0))


def _patched(engine: Any, before: Session, after: Session, progress: Progress) -> Patched:
    """Return a session whose part has other faces with its features found anew, where they had been found before."""
    if engine.states(before)["recognize"] in ("done", "problem"):
        after = engine.run(after, until="recognize", progress=progress)
    return Patched(State(after, engine.states(after)), drawing_of(engine.mesh(after, progress)))


def _move(engine: Any, _progress: Progress, _tell: Tell, session: Session, faces: tuple[int, ...], group: str) -> State:
    from trunnion.pipeline.patches import with_moved

    after = with_moved(engine, session, faces, group)
    return State(after, engine.states(after))


def _export(engine: Any, _progress: Progress, _tell: Tell, session: Session, what: tuple[str, ...], path: str) -> int:
    from trunnion.pipeline.patches import export

    return export(engine, session, what, path)


def _accuracy(engine: Any, progress: Progress, _tell: Tell, session: Session) -> Accuracy:
    from trunnion.pipeline.patches import boundary_errors, size_errors

    rows = tuple(ErrorRow(r.on_edge, r.points, r.largest, r.mean, r.seconds) for r in size_errors(engine, session, progress=progress))
    errors = boundary_errors(engine, session)
    worst = max(errors, key=lambda tag: errors[tag])
    return Accuracy(rows, errors[worst], worst)


def _estimate(engine: Any, _progress: Progress, _tell: Tell, session: Session) -> Estimated | None:
    from trunnion.pipeline.estimating import estimate

    found = estimate(session, engine.bench_of(session))
    if found is None:
        return None
    rows = tuple(AreaRow(a.operation, a.tool, a.area, a.rate, a.seconds) for a in found.areas)
    return Estimated(rows, found.seconds, found.alone, found.seconds_alone, found.gain, found.saving, bool(session.paths))


def _settings(engine: Any, _progress: Progress, _tell: Tell) -> dict[str, tuple[Group, ...]]:
    return {step: tuple(Group(c.GROUP, _title(c), tuple(_offered(d) for d in declared(c))) for c in classes)
            for step, classes in engine.settings().items()}


def _offered(setting: Declared) -> Declared:
    """Return a setting with the catalogue's names as its choices where it names a material or a machine."""
    catalogue = _CATALOGUES.get(setting.key)
    if catalogue is None or setting.choices:
        return setting
    from trunnion.shop import load_shop

    shop = load_shop()
    known = [tool.name for tool in shop.tools] if catalogue == "tools" else sorted(getattr(shop, catalogue))
    return replace(setting, choices=tuple(dict.fromkeys((str(setting.default), *known))))


_CATALOGUES = {"blank.material": "materials", "setup.machine": "machines", "route.plan": "plans",
               "surface.cutter": "tools", "surface.local_cutter": "tools", "surface.rough_cutter": "tools"}
"""Settings that name a thing of a catalogue: the form offers what there is."""
VERBS: dict[str, Callable[..., Any]] = {
    "open": _open, "run": _run, "states": _states, "attach": _attach, "save": _save, "write": _write, "settings": _settings,
    "playback": _playback, "moment": _moment, "deviation": _deviation, "cut": _cut, "uncut": _uncut, "move": _move, "export": _export,
    "accuracy": _accuracy, "estimate": _estimate}


def _title(group: Any) -> str:
    words = group.GROUP.split(".")[-1].replace("_", " ")
    return str(words[:1].upper() + words[1:])
