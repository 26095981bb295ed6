"""What a person did by hand, kept when a step runs again: features and operations that were made, changed or deleted."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace

from trunnion.findings import face_tags, info
from trunnion.model.feature import Feature, Recognition
from trunnion.recognize.contract import exclusive_kinds


def with_manual_features(before: Recognition | None, found: Recognition) -> Recognition:
    """Return what was found with the features that a person made or changed in place of those that claim most of their faces, and
    without those that claim most of the faces of a deleted one. Faces that lose their feature become unexplained.

    Features of kinds that share out faces (`exclusive_kinds`) only lose the faces that a person put elsewhere, and faces that the part has
    no more leave every one of them. None of them gets a name that a feature made by hand has, or that one had which is no more.
    """
    if before is None or not (
        before.removed or before.retired or any(f.by_hand for f in before.features)
    ):
        return found
    sharing = frozenset((*exclusive_kinds(before.family), *exclusive_kinds(found.family)))
    there = {*found.unexplained, *(tag for f in found.features for tag in f.tags)}
    by_hand = tuple(
        kept for f in before.features if f.by_hand for kept in _within(f, there, sharing)
    )
    kept_names = {f.id for f in by_hand}
    retired = (
        *before.retired,
        *(f.id for f in before.features if f.by_hand and f.id not in kept_names),
    )
    taken = [set(f.tags) for f in by_hand if f.kind not in sharing] + [
        set(tags) for tags in before.removed
    ]
    # A feature that a person parted has most of its faces in several: none of them alone claims it.
    taken.append({tag for tags in taken for tag in tags})
    others = [
        f
        for f in _renamed(_shared_out(found.features, by_hand, sharing), by_hand, retired, sharing)
        if not _claims_most(f, taken)
    ]
    kept = (*others, *by_hand)
    if any(f.kind in sharing for f in kept):
        kept = tuple(sorted(kept, key=lambda f: f.id))
    loose = there - {tag for f in kept for tag in f.tags}
    deleted = [f for f in found.features if _claims_most(f, [set(tags) for tags in before.removed])]
    notes = [
        info(
            "recognize.deleted",
            f"{f.id} was deleted by hand and is not taken up again",
            *face_tags(f.tags),
            remedy="undo the deletion, or open the part anew, to have it back",
        )
        for f in deleted
    ]
    return replace(
        found.with_unexplained(loose),
        features=kept,
        findings=(*found.findings, *notes),
        removed=before.removed,
        retired=retired,
    )


def _within(feature: Feature, there: set[int], sharing: Collection[str]) -> tuple[Feature, ...]:
    """Return a feature that shares out faces with those that are there, nothing when there is none; other features as they are."""
    if feature.kind not in sharing:
        return (feature,)
    return tuple(f for f in (without_faces(feature, set(feature.tags) - there),) if f.faces)


def _shared_out(
    features: Iterable[Feature], by_hand: Iterable[Feature], sharing: Collection[str]
) -> tuple[Feature, ...]:
    """Return features, those that share out faces without what a person has put in another one; empty ones of them go."""
    taken = {tag for f in by_hand if f.kind in sharing for tag in f.tags}
    return tuple(
        f
        for f in (without_faces(f, taken) if f.kind in sharing else f for f in features)
        if f.faces or f.kind not in sharing
    )


def _renamed(
    features: tuple[Feature, ...],
    by_hand: Iterable[Feature],
    retired: Iterable[str],
    sharing: Collection[str],
) -> tuple[Feature, ...]:
    """Return features without those that bear a name of one made by hand; those that share out faces get a free name instead, also of a
    retired one."""
    names, spent = {f.id for f in by_hand}, set(retired)
    kept = []
    for f in features:
        if f.kind in sharing and f.id in names | spent:
            taken = {*names, *spent, *(other.id for other in features)}
            f = replace(f, id=free_id(f.kind, taken))
            names.add(f.id)
        if f.id not in names or f.kind in sharing:
            kept.append(f)
    return tuple(kept)


def without_faces(feature: Feature, tags: set[int]) -> Feature:
    """Return a feature without some of its faces."""
    return (
        replace(feature, faces=tuple(f for f in feature.faces if f.face not in tags))
        if tags & set(feature.tags)
        else feature
    )


def free_id(kind: str, taken: set[str]) -> str:
    """Return the first name of a feature of a kind that is not taken.

    >>> free_id("group", {"group-01", "group-03"})
    'group-02'
    """
    number = 1
    while f"{kind}-{number:02}" in taken:
        number += 1
    return f"{kind}-{number:02}"


def _claims_most(feature: Feature, taken: Iterable[set[int]]) -> bool:
    return any(2 * len(tags & set(feature.tags)) > len(feature.tags) for tags in taken)
