"""What a person does to faces that features share out: cuts them in two, moves them between groups, calls groups local, exports them.

Sessions go in and come out; the engine gives the part. Steps that read what was changed are stale afterwards.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.findings import BadCall, BadInput
from trunnion.geometry.cut import Cut
from trunnion.model.feature import FaceRole, Feature, Recognition
from trunnion.model.session import Session
from trunnion.pipeline.planning.manual_edits import free_id, without_faces
from trunnion.pipeline.steps import measured_anew
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.recognize.contract import exclusive_kinds, sharing_families

if TYPE_CHECKING:
    from trunnion.pipeline.engine import Engine

LOCAL, REMAINING, DROPPED = "local", "remaining", "dropped"
"""What may be exported beside groups by their id: all local features, all other faces but what recognition dropped, and that."""


def with_cut(
    engine: Engine, session: Session, cut: Cut, progress: Progress = NO_PROGRESS
) -> Session:
    """Return the session after one more cut of a face: recognition is stale, and the engine's mesh of it has the new faces.

    Raises `BadInput` when the part has no such face or the cut doesn't divide it.
    """
    return engine.with_cuts(session, (*session.cuts, cut), progress)


def without_cut(
    engine: Engine, session: Session, number: int, progress: Progress = NO_PROGRESS
) -> Session:
    """Return the session without one of its cuts, counted from 0; raise `BadInput` when a later cut needs it."""
    if not 0 <= number < len(session.cuts):
        raise BadInput(f"there is no cut {number + 1}; the part has {len(session.cuts)}")
    return engine.with_cuts(session, session.cuts[:number] + session.cuts[number + 1 :], progress)


def with_local(session: Session, ids: Iterable[str], value: bool) -> Session:
    """Return the session with groups called local features by hand, or not; raise `BadInput` for an id that no group has."""
    found = _recognition(session)
    wanted = {_group(found, id).id for id in ids}
    changed = tuple(
        replace(f, attributes={**f.attributes, "local": value}, by_hand=True)
        if f.id in wanted
        else f
        for f in found.features
    )
    return replace(session, recognition=replace(found, features=changed))


def with_moved(engine: Engine, session: Session, faces: Iterable[int], group: str = "") -> Session:
    """Return the session with faces moved by hand to a group, or to a new one that is as local as the first face's was.

    All groups that change are measured anew, those that lose their last face go, and so do their names: no other group gets them.

    Raises `BadInput` for a face that the part doesn't have or an id that no group has.
    """
    found, moved = _recognition(session), set(faces)
    strange = sorted(moved - set(engine.context_of(session).part.tags))
    if strange or not moved:
        raise BadInput(
            f"face {strange[0]} is not a face of the chosen solid"
            if strange
            else "no faces were chosen to be moved"
        )
    sharing = exclusive_kinds(found.family)
    into = _group(found, group) if group else _new_group(found, min(moved))
    features = tuple(
        f if f.id == into.id or f.kind not in sharing else without_faces(f, moved)
        for f in found.features
    )
    into = replace(into, faces=_faces(moved.union(into.tags)), by_hand=True)
    features = tuple(into if f.id == into.id else f for f in features if f.faces)
    features = features if into in features else (*features, into)
    loose = tuple(t for t in found.unexplained if t not in moved)
    there = {f.id for f in features}
    after = replace(
        found.with_unexplained(loose),
        features=features,
        retired=(*found.retired, *(f.id for f in found.features if f.id not in there)),
    )
    return measured_anew(replace(session, recognition=after), engine.context_of(session))


def tags_of(session: Session, what: Sequence[str]) -> tuple[int, ...]:
    """Return the tags that words mean: `local`, `remaining`, `dropped`, or ids of groups. Raises `BadInput` when they mean no face."""
    found = _recognition(session)
    tags: set[int] = set()
    for word in what:
        if word == LOCAL:
            tags.update(_local(found))
        elif word == REMAINING:
            explained = {t for f in found.features for t in f.tags}
            tags.update({*found.unexplained, *explained} - _local(found) - set(dropped(found)))
        elif word == DROPPED:
            tags.update(dropped(found))
        else:
            tags.update(_group(found, word).tags)
    if not what:
        raise BadInput(f"no faces were chosen; name {LOCAL}, {REMAINING} or groups by their ids")
    if not tags:
        raise BadInput(
            f"{' and '.join(what)}: no face of the part belongs to it; name other groups, or call some local features"
        )
    return tuple(sorted(tags))


def dropped(found: Recognition) -> tuple[int, ...]:
    """Return the tags of the patches that are in no group because they are too narrow or too small; none of families without groups."""
    return found.dropped if exclusive_kinds(found.family) else ()


def export(engine: Engine, session: Session, what: Sequence[str], path: str | Path) -> int:
    """Write the faces that words mean (`tags_of`), and no others, as IGES or STEP by the file's suffix; return how many they are.

    Raises `BadInput` for another suffix, and when the file can't be written.
    """
    from trunnion.part.write import write_faces

    part, tags = engine.context_of(session).part, tags_of(session, what)
    write_faces([part.face_shape(t) for t in tags], path)
    return len(tags)


def _recognition(session: Session) -> Recognition:
    if session.recognition is None:
        raise BadCall("no groups yet: recognize first")
    return session.recognition


def _group(found: Recognition, id: str) -> Feature:
    groups = groups_of(found)
    for f in groups:
        if f.id == id:
            return f
    known = [f.id for f in groups]
    raise BadInput(
        f"there is no group {id}; "
        + (f"known: {known[0]} to {known[-1]}" if known else _no_groups())
    )


def _no_groups() -> str:
    families = " or ".join(sharing_families())
    return f"the part's family has no groups of patches; choose recognize.family = {families}"


def groups_of(found: Recognition) -> tuple[Feature, ...]:
    """Return the groups of patches that were recognised; none in families without them."""
    return found.of_kind(*exclusive_kinds(found.family))


def _new_group(found: Recognition, face: int) -> Feature:
    from_group = next((f for f in groups_of(found) if face in f.tags), None)
    if from_group is None and not exclusive_kinds(found.family):
        raise BadInput(_no_groups())
    kind = exclusive_kinds(found.family)[0]
    local = from_group is not None and bool(from_group.attributes.get("local"))
    return Feature(
        id=free_id(kind, {*found.retired, *(f.id for f in found.features)}),
        kind=kind,
        faces=(),
        attributes={"local": local},
    )


def _faces(tags: Iterable[int]) -> tuple[FaceRole, ...]:
    return tuple(FaceRole(role="face", face=t) for t in sorted(tags))


def _local(found: Recognition) -> set[int]:
    return {t for f in groups_of(found) if f.attributes.get("local") for t in f.tags}
