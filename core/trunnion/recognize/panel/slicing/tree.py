"""The relationship tree: the spaces of neighbouring slices that overlap, from the top of the part down (rule 4 of the design)."""

from __future__ import annotations

from dataclasses import dataclass

import shapely

from trunnion.geometry.arrays import Floats
from trunnion.recognize.panel.slicing.slices import Slices, SliceSpace
from trunnion.tolerance import SLIVER

COVER = 0.02
"""Share of a space that a slice above may cover before it counts as overhung: fillets and chords stay below it."""

Node = tuple[int, int]
"""A space: number of its slice, number in the slice."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SpaceTree:
    """Every space with the one above that it opens into. A space with no parent opens at the top of the part, or is covered there."""

    slices: Slices
    parent: dict[Node, Node]
    children: dict[Node, tuple[Node, ...]]

    def space(self, node: Node) -> SliceSpace:
        """Return the space of a node."""
        return self.slices.layers[node[0]].spaces[node[1]]

    def over(self, point: Floats, z: float) -> Node | None:
        """Return the space just above a point (x, y) at a height, None when material or the top of the part is there."""
        for n, layer in enumerate(self.slices.layers):
            if layer.z > z + SLIVER and layer.top > z + SLIVER:
                k = layer.space_at(point)
                return None if k is None else (n, k)
        return None

    def covered(self, node: Node) -> float:
        """Return the largest share of a space that material stands over: 0 when a cutter can look at all of it from above."""
        own = self.space(node).plan
        return max(
            (
                float(own.intersection(layer.material).area / own.area)
                for layer in self.slices.layers[node[0] + 1 :]
            ),
            default=0.0,
        )


def build_tree(slices: Slices) -> SpaceTree:
    """Return the tree of the spaces; a space belongs to the one above that it shares the largest area with."""
    parent: dict[Node, Node] = {}
    children: dict[Node, list[Node]] = {}
    for n, layer in enumerate(slices.layers[:-1]):
        above = slices.layers[n + 1].spaces
        if not above:
            continue
        index = shapely.STRtree([s.plan for s in above])
        for k, space in enumerate(layer.spaces):
            shares = [
                (space.plan.intersection(above[j].plan).area, -int(j))
                for j in index.query(space.plan)
            ]
            best = max(shares, default=(0.0, 0))
            if best[0] > COVER * space.plan.area:
                up = (n + 1, -best[1])
                parent[(n, k)] = up
                children.setdefault(up, []).append((n, k))
    return SpaceTree(
        slices=slices, parent=parent, children={node: tuple(c) for node, c in children.items()}
    )
