"""What a person may choose about the segmentation of curved surfaces."""

from __future__ import annotations

from trunnion.settings import setting, settings

SLIVER_WIDTH, SMALLEST = 0.05, 0.5
"""mm: the limits on small patches that nobody has changed."""
SMALL_PART = 0.01
"""Share of the largest patch's size that these limits don't exceed: a part of half a millimetre has patches of its own."""
INVARIANT, ALIGNED = "invariant", "aligned"
EXACT, POINTS = "exact", "points"


@settings("recognize.surface")
class SurfaceSettings:
    """How patches are measured, which ones are equal, and which are local features."""

    grouping: str = setting(
        INVARIANT,
        label="Feature size",
        choices=(INVARIANT, ALIGNED),
        help="invariant: largest distance of two boundary points, then area, then boundary length, which don't turn "
        "with the part. aligned: diagonal of the box along the axes, as in the paper.",
    )
    boundary: str = setting(
        EXACT,
        label="Boundary",
        choices=(EXACT, POINTS),
        help="exact: boxes of the true boundary. points: the paper's repair, up to seven points on each edge.",
    )
    tolerance: float = setting(
        0.05,
        unit="mm",
        low=0.0,
        high=100.0,
        label="Similarity",
        help="A patch whose size is within this of the one before it, sorted by size, is of the same group.",
    )
    relative: bool = setting(
        False,
        label="Relative similarity",
        help="The similarity is a share of the size instead of mm.",
    )
    subdivide: bool = setting(
        False,
        label="Subdivide",
        help="Divide groups of equal diagonal by the sides of their boxes (aligned only).",
    )
    local_ratio: float = setting(
        0.0,
        unit="of the largest",
        low=0.0,
        high=1.0,
        label="Local feature below",
        help="A group is a local feature when its size over the largest patch's is below this; 0: connected faces are judged together, "
        "and those below the gap in the part's own sizes are proposed.",
    )
    sliver_width: float = setting(
        SLIVER_WIDTH,
        unit="mm",
        low=0.0,
        high=10.0,
        label="Sliver",
        help="A patch narrower than this on average (twice its area over its boundary) joins no group. "
        "As it stands, at most 1 % of the largest patch's size.",
    )
    smallest: float = setting(
        SMALLEST,
        unit="mm",
        low=0.0,
        high=1000.0,
        label="Smallest feature size",
        help="A patch whose feature size is below this joins no group and is machined with the area around it. "
        "As it stands, at most 1 % of the largest patch's size.",
    )

    def limits(self, largest: float) -> tuple[float, float]:
        """Return the width of slivers and the smallest size (mm) on a part by the size of its largest patch: what a person chose
        holds as it is."""
        most = SMALL_PART * largest
        return (
            min(self.sliver_width, most)
            if self.sliver_width == SLIVER_WIDTH
            else self.sliver_width,
            min(self.smallest, most) if self.smallest == SMALLEST else self.smallest,
        )
