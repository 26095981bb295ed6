"""Requests that the worker knows: each verb calls the engine and replies with plain data that the window draws or shows. No Qt.

Verbs take the engine, a progress, a function that sends what is done so far, and their own arguments; `COMMANDS` lists those of every part.
A family's own ones are requested by the function itself, which the worker imports.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from trunnion.findings import Cancelled, Fix, TrunnionError
from trunnion.model.session import PostedFile, Session
from trunnion.post.release import release
from trunnion.progress import Progress
from trunnion.settings import Declared, Value, checked, choose, declared
from trunnion_gui.worker.drawing import DrawnMesh, drawing_of, drawn_map
from trunnion_gui.worker.steps import share, until


@dataclass(frozen=True, slots=True)
class SessionState:
    """A session, the state of each step, its programs with the stamps and names that they would leave with now, and the line of the step
    that refused after others were done."""

    session: Session
    steps: dict[str, str]
    programs: tuple[PostedFile, ...] = ()
    refusal: str = ""


@dataclass(frozen=True, slots=True)
class OpenedSession:
    """A session as opened, with what the window draws, and the part file's bytes and suffix for a worker that must take over."""

    state: SessionState
    drawing: DrawnMesh
    kept: tuple[bytes, str]


@dataclass(frozen=True, slots=True)
class SettingsGroup:
    """The declared settings of one group, as the window's forms need them (the class stays in the worker)."""

    name: str
    title: str
    settings: tuple[Declared, ...]


OPERATION = "operation"
"""Among the groups of settings by step: what may be changed of a single operation."""
DEMAND = "demand"
"""Among the groups of settings by step: what may be demanded of holes."""
ALLOWANCE = "allowance"
"""Among the groups of settings by step: what features may be made to keep."""
SendEvent = Callable[[str, Any], None]
Work = Callable[..., Any]
_writing: set[Work] = set()


def writes_files(work: Work) -> Work:
    """Mark what writes files: it is given more time to stop after a cancel."""
    _writing.add(work)
    return work


def work_of(command: str | Work) -> Work:
    """Return the function behind a verb's name, or a family's own function itself."""
    return COMMANDS[command] if isinstance(command, str) else command


def is_writing(command: str | Work) -> bool:
    """Return whether a verb writes files."""
    return work_of(command) in _writing


def state_of(engine: Any, session: Session, refusal: str = "") -> SessionState:
    """Return a session with what the window shows of its steps and programs."""
    return SessionState(session, engine.states(session), _as_they_leave(session), refusal)


def _as_they_leave(session: Session) -> tuple[PostedFile, ...]:
    """Return the programs with the stamp of their proof; what is not proven keeps the one that forbids running."""
    try:
        return release(session)
    except TrunnionError:
        return session.posted


def _open(
    engine: Any, progress: Progress, send_event: SendEvent, path: str, solid: int | None
) -> OpenedSession:
    session = engine.open(path, solid=solid, progress=progress.part(0.0, 0.8))
    send_event("progress", (0.85, "preparing the picture"))
    mesh = engine.mesh(session, progress.part(0.85, 1.0))
    return OpenedSession(state_of(engine, session), drawing_of(mesh), engine.keep())


def _revise(
    engine: Any, progress: Progress, send_event: SendEvent, session: Session, path: str
) -> OpenedSession:
    from trunnion.pipeline.revision import revised

    made = revised(engine, session, path, progress.part(0.0, 0.8))
    send_event("progress", (0.85, "preparing the picture"))
    mesh = engine.mesh(made, progress.part(0.85, 1.0))
    return OpenedSession(state_of(engine, made), drawing_of(mesh), engine.keep())


def _run(
    engine: Any, progress: Progress, send_event: SendEvent, session: Session, last: str
) -> SessionState:
    before = engine.states(session)
    steps = [s for s in until(last) if before[s] in ("empty", "stale")] or [last]
    for step in steps:
        send_event("stage", (step, None))
        try:
            session = engine.run(
                session, until=step, progress=_own_share(progress.part(*share(step, steps)), step)
            )
        except TrunnionError as reason:
            if step == steps[0]:
                raise
            return state_of(engine, session, str(reason))
        if step != steps[-1]:
            send_event("stage", (step, state_of(engine, session)))
    return state_of(engine, session)


def _own_share(progress: Progress, step: str) -> Progress:
    """Return the progress of one step whose engine counts the steps before it, done long ago, as so many equal shares."""
    done = len(until(step)) - 1

    def is_cancelled() -> bool:
        try:
            progress.check()
        except Cancelled:
            return True
        return False

    return Progress(
        lambda fraction, text: progress.at(fraction * (done + 1) - done, text), is_cancelled
    )


def _states(
    engine: Any, _progress: Progress, _send_event: SendEvent, session: Session
) -> SessionState:
    return state_of(engine, session)


def _attach(
    engine: Any,
    progress: Progress,
    _send_event: SendEvent,
    session: Session,
    data: bytes,
    suffix: str,
) -> SessionState:
    engine.attach(session, data, suffix, progress=progress)
    return state_of(engine, session)


def _fix(
    engine: Any, _progress: Progress, _send_event: SendEvent, session: Session, fix: Fix
) -> SessionState:
    return state_of(engine, engine.with_fix(session, fix))


def _change(
    engine: Any,
    _progress: Progress,
    _send_event: SendEvent,
    session: Session,
    operation: str,
    values: dict[str, Value],
) -> SessionState:
    from trunnion.plan.manual.operation_change import OperationChange

    change = choose(OperationChange, values)
    return state_of(engine, engine.with_operation_change(session, operation, change))


def _demand(
    engine: Any,
    _progress: Progress,
    _send_event: SendEvent,
    session: Session,
    ids: tuple[str, ...],
    values: dict[str, Value],
) -> SessionState:
    from trunnion.pipeline.planning.hole_demands import with_hole_demand
    from trunnion.plan.holes.settings import HoleDemand

    demand = checked(choose(HoleDemand, values))
    return state_of(engine, with_hole_demand(engine, session, ids, demand))


def _allowance(
    engine: Any,
    _progress: Progress,
    _send_event: SendEvent,
    session: Session,
    ids: tuple[str, ...],
    amounts: dict[str, float],
) -> SessionState:
    from trunnion.pipeline.planning.allowances import with_feature_allowance

    return state_of(engine, with_feature_allowance(session, ids, **amounts))


@writes_files
def _save(
    engine: Any, progress: Progress, _send_event: SendEvent, session: Session, path: str
) -> str:
    engine.save(session, path, progress)
    return path


@writes_files
def _write(
    engine: Any, progress: Progress, _send_event: SendEvent, session: Session, folder: str
) -> tuple[str, ...]:
    return tuple(str(name) for name in engine.write(session, folder, progress=progress))


def _playback(engine: Any, progress: Progress, _send_event: SendEvent, session: Session) -> Any:
    return engine.playback(session, progress=progress)


def _moment(
    engine: Any,
    progress: Progress,
    _send_event: SendEvent,
    key: str,
    position: float,
    seconds: float,
) -> Any:
    return engine.moment(key, position, seconds, progress)


def _deviation(engine: Any, progress: Progress, _send_event: SendEvent, session: Session) -> Any:
    return drawn_map(engine.deviation_map(session, progress))


def _guides(
    engine: Any, progress: Progress, _send_event: SendEvent, session: Session, id: str
) -> Any:
    return engine.guides(session, id, progress)


def _settings(
    engine: Any, _progress: Progress, _send_event: SendEvent
) -> dict[str, tuple[SettingsGroup, ...]]:
    from trunnion.plan.allowances import FeatureAllowance
    from trunnion.plan.holes.settings import HoleDemand
    from trunnion.plan.manual.operation_change import OperationChange

    return {
        step: tuple(
            SettingsGroup(c.GROUP, _title(c), tuple(_offered(d) for d in declared(c)))
            for c in classes
        )
        for step, classes in (
            *engine.settings().items(),
            (OPERATION, (OperationChange,)),
            (DEMAND, (HoleDemand,)),
            (ALLOWANCE, (FeatureAllowance,)),
        )
    }


def _offered(setting: Declared) -> Declared:
    """Return a setting with the names of its catalogue as its choices, where it names a thing of one."""
    if not setting.catalogue or setting.choices:
        return setting
    from trunnion.shop import load_shop
    from trunnion.shop.user_folder import user_folder

    shop = load_shop(user_folder())
    known = (
        [tool.name for tool in shop.tools if not tool.locked]
        if setting.catalogue == "tools"
        else sorted(getattr(shop, setting.catalogue))
    )
    return replace(setting, choices=tuple(dict.fromkeys((str(setting.default), *known))))


COMMANDS: dict[str, Callable[..., Any]] = {
    "open": _open,
    "revise": _revise,
    "run": _run,
    "states": _states,
    "attach": _attach,
    "fix": _fix,
    "change": _change,
    DEMAND: _demand,
    ALLOWANCE: _allowance,
    "save": _save,
    "write": _write,
    "settings": _settings,
    "playback": _playback,
    "moment": _moment,
    "deviation": _deviation,
    "guides": _guides,
}


def _title(group: Any) -> str:
    words = group.GROUP.split(".")[-1].replace("_", " ")
    return str(words[:1].upper() + words[1:])
