"""Groups of equal patches as features: their kind and class, and the edit that changes the class. No Qt."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from trunnion.model.feature import Feature
from trunnion.model.session import Session
from trunnion.recognize.surface.kinds import GROUP as GROUP
from trunnion.recognize.surface.kinds import LOCAL as LOCAL
from trunnion_gui.edits import Edit, recognition_of


def is_local(feature: Feature) -> bool:
    """Return whether a group is a local feature, which gets a cutter of its own."""
    return bool(feature.attributes.get(LOCAL))


def with_local(ids: Iterable[str], value: bool) -> Edit:
    """Return the edit that calls groups of patches local features, or not, marked as a person's."""
    wanted = frozenset(ids)

    def edit(session: Session) -> Session:
        found = recognition_of(session)
        changed = tuple(
            replace(f, attributes={**f.attributes, LOCAL: value}, by_hand=True)
            if f.id in wanted and is_local(f) != value
            else f
            for f in found.features
        )
        return (
            session
            if changed == found.features
            else replace(session, recognition=replace(found, features=changed))
        )

    return edit
