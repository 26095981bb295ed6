"""Holes of panels: which of a part's holes are features of their own, numbered like the others, with what they open in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.model.feature import Feature, Size
from trunnion.recognize.holes.features import (
    HOLE,
    direction_in,
    hole_feature,
    pattern_attributes,
)
from trunnion.recognize.holes.hole import Hole
from trunnion.recognize.holes.patterns import hole_patterns
from trunnion.recognize.panel.features import FeatureNumbers, in_rows

POCKETS = ("pocket", "open_pocket")
"""Features that a hole in their floor or wall is nested in; on others it stands."""
ROUNDED = 3
"""Decimals of mm that heights of holes above each other are ordered by: beyond is noise of the file."""
CARRIERS = (*POCKETS, "island", "rib", "boss", HOLE)
"""Features that are said of a hole that opens in one of their faces; the outline and the datum faces are not."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PanelHoles:
    """The holes of a part in the coordinates of its graph, and the frame of recognition."""

    graph: FaceGraph
    frame: Frame
    holes: tuple[Hole, ...]

    @property
    def rows(self) -> frozenset[int]:
        """The rows of all their faces."""
        return frozenset(f for h in self.holes for f in h.faces)

    def features(self, others: Sequence[Feature], numbers: FeatureNumbers) -> tuple[Feature, ...]:
        """Return the features of holes: those from above first, then those from below, then those from the sides, each in rows."""
        own = self._ordered()
        named = [(hole, numbers.next(HOLE)) for hole in own]
        owners: dict[int, Feature] = {}
        made = [hole_feature(hole, id, self.frame) for hole, id in named]
        for feature in (*others, *made):
            if feature.kind in CARRIERS:
                for tag in feature.tags:
                    owners.setdefault(tag - 1, feature)
        patterns = pattern_attributes(hole_patterns(self.graph, own, self.frame))
        return tuple(
            replace(
                feature,
                attributes={
                    **feature.attributes,
                    **_surroundings(hole, owners),
                    **patterns.get(n, {}),
                },
            )
            for n, (hole, feature) in enumerate(zip(own, made, strict=True))
        )

    def _ordered(self) -> list[Hole]:
        groups: dict[float, list[Hole]] = {1.0: [], -1.0: [], 0.0: []}
        for hole in sorted(self.holes, key=lambda h: -round(self._at(h)[2], ROUNDED)):
            z = direction_in(hole, self.frame)[2]
            groups[z if abs(z) == 1.0 else 0.0].append(hole)
        return [
            hole
            for group in groups.values()
            for hole in in_rows(group, lambda h: (self._at(h)[0], self._at(h)[1]))
        ]

    def _at(self, hole: Hole) -> tuple[float, float, float]:
        x, y, z = self.frame.to_local(hole.mouth).tolist()
        return x, y, z


def _surroundings(hole: Hole, owners: dict[int, Feature]) -> dict[str, Size]:
    """Return what a hole opens in, `nested_in` a pocket or a wider hole, `on` an island, rib or boss, and the holes it `crosses`."""
    found: dict[str, Size] = {}
    carrier = next((owners[f] for f in hole.opens_in if f in owners), None)
    if carrier is not None:
        found["nested_in" if carrier.kind in (*POCKETS, HOLE) else "on"] = carrier.id
    crossed = {owners[f].id for f in hole.crosses if f in owners}
    if crossed:
        found["crosses"] = " ".join(sorted(crossed, key=lambda id: (len(id), id)))
    return found
