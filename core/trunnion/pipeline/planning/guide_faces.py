"""What leads an operation, changed by a person: faces that its guide lines are on, or that its passes go over, added and left out.

Sessions go in and come out; the engine makes the guides.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from trunnion import registry
from trunnion.findings import BadCall, BadInput
from trunnion.geometry.facegraph import FaceGraph
from trunnion.model.guides import GuideChain, GuideKind
from trunnion.model.operation import Operation
from trunnion.model.session import Session
from trunnion.plan.contract import GuideDrive
from trunnion.plan.manual.operation_change import check_known
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.registry import STRATEGIES

if TYPE_CHECKING:
    from trunnion.pipeline.engine import Engine

FACES_RULE = "faces: chosen by a person"
"""What an operation's rule says of faces that a person gave it."""
MOST_NAMED = 8
"""Faces that a refusal names at most."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _GuideFaces:
    """The faces that may lead an operation, and those that are finished along with one of them: the fillets at its foot."""

    leading: frozenset[int]
    at_feet: frozenset[int]

    @staticmethod
    def of(chains: Sequence[GuideChain], faces: Collection[int]) -> _GuideFaces:
        """Return the faces of the guide lines of an operation that has some faces: of its walls where one of these is a wall, else of
        its areas and axes."""
        walls = [c for c in chains if c.kind is GuideKind.WALL]
        leading = {t for c in walls for t in c.on if t}
        if leading.intersection(faces):
            at_feet = {t for c in walls for t in c.faces} - leading
            return _GuideFaces(leading=frozenset(leading), at_feet=frozenset(at_feet))
        others = (c for c in chains if c.kind in (GuideKind.AREA, GuideKind.AXIS))
        return _GuideFaces(
            leading=frozenset(t for c in others for t in c.faces), at_feet=frozenset()
        )


def with_guide_faces(
    engine: Engine,
    session: Session,
    id: str,
    *,
    add: Iterable[int] = (),
    leave_out: Iterable[int] = (),
    progress: Progress = NO_PROGRESS,
) -> Session:
    """Return the session with an operation led by other faces, to be computed and proven again; where its guide lines are on walls, the
    fillets at their feet come and go with them.

    Raises `BadInput` for an operation or a face that is not there, and for one that can't lead it.
    """
    process, part = session.process, session.part
    if process is None or part is None:
        raise BadCall("no operations yet: generate the route first")
    check_known(process, id)
    operation = process.operation(id)
    strategy = registry.get(STRATEGIES, operation.strategy)
    if not (strategy.own_faces and operation.faces):
        raise BadInput(
            f"{id}: {operation.strategy} works on areas, not along faces of its own; keep its cutter out of an area, or suppress it"
        )
    gone, more = set(leave_out), [t for t in dict.fromkeys(add) if t not in operation.faces]
    strange = sorted(gone - set(operation.faces))
    if strange:
        raise BadInput(f"{id}: face {strange[0]} is not one of its faces")
    if issubclass(strategy.drive, GuideDrive):
        planned = engine.operation_guides(session, replace(operation, own_faces=False), progress)
        if planned.refused:
            raise BadInput(planned.refused)
        known = _GuideFaces.of([line.chain for line in planned.lines], operation.faces)
        _check_leading(id, more, known.leading)
        faces = _followed(engine, session, operation, gone, more, known)
        leads = known.leading.intersection(faces)
    else:
        _check_there(engine, session, more)
        faces = (*(t for t in operation.faces if t not in gone), *more)
        leads = frozenset(faces)
    if not leads:
        raise BadInput(f"{id}: no face would lead it any more; suppress it instead")
    if faces == operation.faces:
        return session
    changed = replace(
        operation,
        faces=faces,
        own_faces=True,
        by_hand=True,
        rules=tuple(dict.fromkeys((*operation.rules, FACES_RULE))),
    )
    return replace(session, process=process.with_operation(changed))


def _check_leading(id: str, faces: Iterable[int], leading: frozenset[int]) -> None:
    strange = next((t for t in faces if t not in leading), None)
    if strange is not None:
        named = [str(t) for t in sorted(leading)]
        others = f", … ({len(named)} in all)" if len(named) > MOST_NAMED else ""
        raise BadInput(
            f"{id}: none of its guide lines can be on face {strange}; they are on faces {', '.join(named[:MOST_NAMED])}{others}"
        )


def _check_there(engine: Engine, session: Session, faces: Iterable[int]) -> None:
    n_faces = engine.context_of(session).part.n_faces
    strange = next((t for t in faces if not 1 <= t <= n_faces), None)
    if strange is not None:
        raise BadInput(f"there is no face {strange}: the part has faces 1 to {n_faces}")


def _followed(
    engine: Engine,
    session: Session,
    operation: Operation,
    gone: set[int],
    more: Collection[int],
    known: _GuideFaces,
) -> tuple[int, ...]:
    """Return an operation's faces without those that are gone and the fillets at their feet, and with more of them and theirs."""
    graph = engine.context_of(session).part.graph()
    faces = [*(t for t in operation.faces if t not in gone), *more]
    wall = {t: _wall_over(graph, t, known.leading) for t in known.at_feet}
    stay = [t for t in faces if wall.get(t, 0) not in gone]
    come = [t for t in sorted(known.at_feet - gone) if wall[t] in more]
    return tuple(dict.fromkeys((*stay, *come)))


def _wall_over(graph: FaceGraph, fillet: int, walls: Collection[int]) -> int:
    """Return which of some walls a fillet is at the foot of: the one that it shares the longest edge with; 0 where it is beside none."""
    edges = [
        (float(graph.length[e]), other)
        for e in graph.edges_of[fillet - 1]
        for other in (graph.across(e, fillet - 1) + 1,)
        if other in walls
    ]
    return max(edges, default=(0.0, 0))[1]
