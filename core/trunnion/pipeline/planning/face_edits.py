"""Features given other faces by a person: faces added and taken away, features merged, and made of some faces.

Only kinds that the part's family can describe by their faces take part (`recognize.contract.Describing`). Every feature that changes is
described anew and marked as a person's, so that recognition keeps it; one that loses its last face goes, and so does its name. Sessions go
in and come out; the engine gives the part.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from trunnion.findings import BadCall, BadInput, Finding, face_tags, warning
from trunnion.model.feature import FaceRole, Feature, Recognition
from trunnion.model.session import Session
from trunnion.pipeline.planning.manual_edits import free_id, without_faces
from trunnion.recognize.contract import Describing, describable_kinds, registered_family
from trunnion.settings import checked, choose

if TYPE_CHECKING:
    from trunnion.pipeline.engine import Engine

UNDESCRIBED = "face"
"""The role of a face before its feature is described."""


def with_faces(engine: Engine, session: Session, id: str, faces: Iterable[int]) -> Session:
    """Return the session with faces added to a feature, taken from the ones that have them.

    Raises `BadInput` for a feature or a face that is not there, or faces that can't be part of the feature.
    """
    found = _recognition(session)
    feature, wanted = _feature(found, id), tuple(faces)
    _check_faces(engine, session, wanted)
    return _with_changed(engine, session, [_grown(feature, wanted)], wanted)


def with_faces_taken(engine: Engine, session: Session, id: str, faces: Iterable[int]) -> Session:
    """Return the session with faces taken from a feature; they are in no feature then. Raises `BadInput` as `with_faces`."""
    found, gone = _recognition(session), set(faces)
    feature = _feature(found, id)
    strange = sorted(gone - set(feature.tags))
    if strange or not gone:
        raise BadInput(
            f"{id}: face {strange[0]} is not one of its faces"
            if strange
            else "no faces were chosen"
        )
    return _with_changed(engine, session, [without_faces(feature, gone)], ())


def with_merged(engine: Engine, session: Session, ids: Sequence[str]) -> Session:
    """Return the session with features made one, which keeps the name and kind of the first. Raises `BadInput` as `with_faces`."""
    found = _recognition(session)
    features = [_feature(found, id) for id in dict.fromkeys(ids)]
    if len(features) < 2:
        raise BadInput("choose two features or more to make one of them")
    tags = tuple(t for f in features[1:] for t in f.tags)
    return _with_changed(engine, session, [_grown(features[0], tags)], tags)


def with_feature(engine: Engine, session: Session, kind: str, faces: Iterable[int]) -> Session:
    """Return the session with a new feature of a kind made of some faces, taken from the ones that have them."""
    found, wanted = _recognition(session), tuple(faces)
    kinds = describable_kinds(found.family)
    if kind not in kinds:
        raise BadInput(
            f"a feature of kind {kind} can't be made of faces"
            + (f"; {', '.join(kinds)} can" if kinds else f" on a part of the family {found.family}")
        )
    _check_faces(engine, session, wanted)
    made = Feature(
        id=free_id(kind, {*found.retired, *(f.id for f in found.features)}), kind=kind, faces=()
    )
    return _with_changed(engine, session, [_grown(made, wanted)], wanted)


def described_anew(engine: Engine, session: Session, findings: list[Finding]) -> Session:
    """Return the session with the features that a person made or changed described by what their faces are now, as on a revised part; of
    those that can't be so any more `findings` tell, and they stay as they were."""
    found = _recognition(session)
    kinds = describable_kinds(found.family)
    for feature in found.features:
        if not feature.by_hand or feature.kind not in kinds:
            continue
        try:
            session = _with_changed(engine, session, [feature], ())
        except BadInput as reason:
            findings.append(
                warning(
                    "revision.feature-shape",
                    f"{feature.id}, made or changed by hand, keeps its sizes: {reason}",
                    feature.id,
                    *face_tags(feature.tags),
                    remedy="give it other faces, or delete it",
                )
            )
    return session


def _with_changed(
    engine: Engine, session: Session, changed: Sequence[Feature], moved: Sequence[int]
) -> Session:
    """Return the session with changed features in their places, new ones at the end; others lose the faces that moved into these."""
    found, mine = _recognition(session), {f.id: f for f in changed}
    kinds = describable_kinds(found.family)
    losing = []
    for f in found.features:
        if f.id in mine or not set(f.tags) & set(moved):
            continue
        if f.kind not in kinds:
            tag = next(t for t in f.tags if t in moved)
            raise BadInput(
                f"face {tag} belongs to {f.id}, which is more than its faces; delete {f.id} first"
            )
        losing.append(without_faces(f, set(moved)))
    mine |= {f.id: f for f in losing}
    there = {f.id for f in found.features}
    kept = [mine.get(f.id, f) for f in found.features] + [f for f in changed if f.id not in there]
    kept = [f for f in kept if f.faces]
    graph = engine.context_of(session).part.graph()
    family, settings = _describing(session)
    # In the order of their kinds: what stands on a pocket's floor is described by what this has become.
    for f in sorted((f for f in kept if f.id in mine), key=lambda f: kinds.index(f.kind)):
        made = family.described(f, replace(found, features=tuple(kept)), graph, settings)
        kept = [made if other.id == f.id else other for other in kept]
    features = tuple(kept)
    had = {t for f in found.features for t in f.tags}
    loose = ({*found.unexplained} | had) - {t for f in features for t in f.tags}
    named = {f.id for f in features}
    after = replace(
        found.with_unexplained(loose),
        features=features,
        retired=(*found.retired, *(f.id for f in found.features if f.id not in named)),
    )
    return replace(session, recognition=after)


def _describing(session: Session) -> tuple[Describing, Any]:
    found = _recognition(session)
    family = registered_family(found.family)
    if not isinstance(family, Describing):
        raise BadInput(
            f"features of the family {found.family or 'none'} can't be given other faces by hand"
        )
    return family, checked(choose(family.settings, session.choices))


def _grown(feature: Feature, tags: Iterable[int]) -> Feature:
    new = (t for t in dict.fromkeys(tags) if t not in feature.tags)
    return replace(
        feature, faces=(*feature.faces, *(FaceRole(role=UNDESCRIBED, face=t) for t in new))
    )


def _check_faces(engine: Engine, session: Session, tags: Sequence[int]) -> None:
    strange = sorted(set(tags) - set(engine.context_of(session).part.tags))
    if strange or not tags:
        raise BadInput(
            f"face {strange[0]} is not a face of the chosen solid"
            if strange
            else "no faces were chosen"
        )


def _feature(found: Recognition, id: str) -> Feature:
    kinds = describable_kinds(found.family)
    feature = next((f for f in found.features if f.id == id), None)
    if feature is None:
        known = [f.id for f in found.features if f.kind in kinds]
        raise BadInput(
            f"there is no feature {id}" + (f"; known: {', '.join(known)}" if known else "")
        )
    if feature.kind not in kinds:
        raise BadInput(
            f"{id}: features of kind {feature.kind} are more than their faces and can't be given others by hand"
            + (f"; {', '.join(kinds)} can" if kinds else "")
        )
    return feature


def _recognition(session: Session) -> Recognition:
    if session.recognition is None:
        raise BadCall("no features yet: recognize first")
    return session.recognition
