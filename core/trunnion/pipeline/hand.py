"""What a person did by hand, kept when a step runs again: features and operations that were made, changed or deleted."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from trunnion.findings import face_tags, info
from trunnion.model.feature import Feature, Recognition
from trunnion.model.process import ProcessTree


def with_features_by_hand(before: Recognition | None, found: Recognition) -> Recognition:
    """Return what was found with the features that a person made or changed in place of those that claim most of their faces, and
    without those that claim most of the faces of a deleted one. Faces that lose their feature become unexplained.
    """
    if before is None or not (before.removed or any(f.by_hand for f in before.features)):
        return found
    by_hand = tuple(f for f in before.features if f.by_hand)
    taken = [set(f.tags) for f in by_hand] + [set(tags) for tags in before.removed]
    names = {f.id for f in by_hand}
    kept = (*(f for f in found.features if f.id not in names and not _claims_most(f, taken)), *by_hand)
    loose = {*found.unexplained, *(tag for f in found.features for tag in f.tags)} - {tag for f in kept for tag in f.tags}
    deleted = [f for f in found.features if _claims_most(f, [set(tags) for tags in before.removed])]
    told = [info("recognize.deleted", f"{f.id} was deleted by hand and is not taken up again", *face_tags(f.tags),
                 remedy="undo the deletion, or open the part anew, to have it back") for f in deleted]
    return replace(found, features=kept, unexplained=tuple(sorted(loose)), findings=(*found.findings, *told), removed=before.removed)


def with_operations_by_hand(before: ProcessTree | None, made: ProcessTree) -> ProcessTree:
    """Return the plan that was made with the operations that a person changed as they were, and without those that were deleted."""
    if before is None:
        return made
    by_hand = {o.id: o for o in before.operations if o.by_hand}
    kept = replace(made, operations=tuple(by_hand.get(o.id, o) for o in made.operations))
    return kept.without(*before.removed) if before.removed else kept


def _claims_most(feature: Feature, taken: Iterable[set[int]]) -> bool:
    return any(2 * len(tags & set(feature.tags)) > len(feature.tags) for tags in taken)
