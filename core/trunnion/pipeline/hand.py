"""What a person did by hand, kept when a step runs again: features and operations that were made, changed or deleted."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from trunnion.findings import face_tags, info
from trunnion.model.feature import Feature, Recognition
from trunnion.model.process import ProcessTree

GROUP = "group"
"""The kind of the features that share out patches: each patch is in one at most, whoever put it there."""


def with_features_by_hand(before: Recognition | None, found: Recognition) -> Recognition:
    """Return what was found with the features that a person made or changed in place of those that claim most of their faces, and
    without those that claim most of the faces of a deleted one. Faces that lose their feature become unexplained.

    Groups of patches only lose the faces that a person put elsewhere, and faces that the part has no more leave every group.
    """
    if before is None or not (before.removed or any(f.by_hand for f in before.features)):
        return found
    there = {*found.unexplained, *(tag for f in found.features for tag in f.tags)}
    by_hand = tuple(kept for f in before.features if f.by_hand for kept in _within(f, there))
    taken = [set(f.tags) for f in by_hand if f.kind != GROUP] + [set(tags) for tags in before.removed]
    others = [f for f in _renamed(_shared_out(found.features, by_hand), by_hand) if not _claims_most(f, taken)]
    kept = (*others, *by_hand)
    if any(f.kind == GROUP for f in kept):
        kept = tuple(sorted(kept, key=lambda f: f.id))
    loose = there - {tag for f in kept for tag in f.tags}
    deleted = [f for f in found.features if _claims_most(f, [set(tags) for tags in before.removed])]
    told = [info("recognize.deleted", f"{f.id} was deleted by hand and is not taken up again", *face_tags(f.tags),
                 remedy="undo the deletion, or open the part anew, to have it back") for f in deleted]
    return replace(found.with_unexplained(loose), features=kept, findings=(*found.findings, *told), removed=before.removed)


def _within(feature: Feature, there: set[int]) -> tuple[Feature, ...]:
    """Return a group with the faces that are there, nothing when there is none; other features as they are."""
    if feature.kind != GROUP:
        return (feature,)
    return tuple(f for f in (without_faces(feature, set(feature.tags) - there),) if f.faces)


def _shared_out(features: Iterable[Feature], by_hand: Iterable[Feature]) -> tuple[Feature, ...]:
    """Return features, groups among them without the faces that a person has put in another one; empty groups go."""
    taken = {tag for f in by_hand if f.kind == GROUP for tag in f.tags}
    return tuple(f for f in (without_faces(f, taken) if f.kind == GROUP else f for f in features) if f.faces or f.kind != GROUP)


def _renamed(features: tuple[Feature, ...], by_hand: Iterable[Feature]) -> tuple[Feature, ...]:
    """Return features without those that bear a name of one made by hand; groups of that name get a free one."""
    names = {f.id for f in by_hand}
    kept = []
    for f in features:
        if f.kind == GROUP and f.id in names:
            f = replace(f, id=free_id({*names, *(other.id for other in features)}))
            names.add(f.id)
        if f.id not in names or f.kind == GROUP:
            kept.append(f)
    return tuple(kept)


def without_faces(feature: Feature, tags: set[int]) -> Feature:
    """Return a feature without some of its faces."""
    return replace(feature, faces=tuple(f for f in feature.faces if f.face not in tags)) if tags & set(feature.tags) else feature


def free_id(taken: set[str]) -> str:
    """Return the first name of a group that is not taken.

    >>> free_id({"group-01", "group-03"})
    'group-02'
    """
    number = 1
    while f"{GROUP}-{number:02}" in taken:
        number += 1
    return f"{GROUP}-{number:02}"


def with_operations_by_hand(before: ProcessTree | None, made: ProcessTree) -> ProcessTree:
    """Return the plan that was made with the operations that a person changed as they were, and without those that were deleted."""
    if before is None:
        return made
    by_hand = {o.id: o for o in before.operations if o.by_hand}
    kept = replace(made, operations=tuple(by_hand.get(o.id, o) for o in made.operations))
    return kept.without(*before.removed) if before.removed else kept


def _claims_most(feature: Feature, taken: Iterable[set[int]]) -> bool:
    return any(2 * len(tags & set(feature.tags)) > len(feature.tags) for tags in taken)
