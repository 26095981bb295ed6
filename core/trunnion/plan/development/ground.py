"""Turned ground laid flat, with all of the part that stands on it: where a tool whose axis is the ground's normal may go."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.developed_mesh import developed_triangles
from trunnion.geometry.development import Development
from trunnion.geometry.mesh import Mesh
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.plan_area import plan_area_above
from trunnion.geometry.plane.region import EMPTY_REGION, Region, union_all
from trunnion.model.blank import Blank
from trunnion.model.tool import Tool
from trunnion.progress import NO_PROGRESS, Progress

AROUND = 45.0
"""mm beyond the ground and beyond half a turn that are looked at: two diameters of the largest cutter."""
BELOW = -0.5
"""mm under the ground from where on the part is looked at."""
SKIM = 5e-3
"""mm above a height that what is in a cutter's way begins: the triangles of bent faces are off by as much."""
GROWN = 1e-3
"""mm that each triangle is grown before they are joined."""
STEP = 2.0
"""mm: heights that shank and holder are kept off the part at go in such steps, always down."""
LAP, ROUNDED = 2e-3, 6
"""mm by which bands lap over what makes them, and decimals of mm of their pieces."""
GAP = 0.01
"""rad of a cone's plane that stay free between the two ends of what goes round it."""
LINES = 400
"""Places along the straight lines at which the blank's height is taken."""
RELIEF = 0.099
"""mm on the radius by which a neck is thinner than its cutter, at least, to go along a finished wall."""
END_STEPS = 2.0
"""Steps between places along the straight lines within which of an end the blank is that of what stands beside the ground."""
HALVINGS = 12
"""Times that the height of what stands on ground is halved at most: most of its triangles are those of fillets, close to the ground."""
TURNS = (0.0, 1.0, 2.7)
"""rad about the axis at which a blank must look the same to count as round."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class GroundObstacle:
    """Faces that stand on ground together: corners (t, 3, 3) over its plane, and whether openings in them are no way down to it."""

    corners: Floats
    closed: bool
    _known: dict[int, Region] = field(init=False, repr=False, default_factory=dict)

    def over(self, z: float) -> Region:
        """Return the plane's area over which they reach higher than a height."""
        low, top = self.corners[:, :, 2].min(axis=1), float(self.corners[:, :, 2].max(initial=0.0))
        halvings = _halvings(z, top)
        lower = low < top * 0.5**halvings if halvings else np.ones(len(low), dtype=bool)
        area = self._above(halvings, low, top).union(plan_area_above(self.corners[lower], z, GROWN))
        return area.holes_filled() if self.closed and area else area

    def _above(self, halvings: int, low: Floats, top: float) -> Region:
        """Return the area of the triangles, given how low (t,) they come, that lie wholly above their top halved so often: those above half
        of it, and so on down, each lot worked out once. It depends on no height that was asked for before."""
        if halvings == 0:
            return EMPTY_REGION
        if halvings not in self._known:
            level = top * 0.5**halvings
            some = low >= level
            if halvings > 1:
                some &= low < 2.0 * level
            found = plan_area_above(self.corners[some], level, GROWN)
            self._known[halvings] = self._above(halvings - 1, low, top).union(found)
        return self._known[halvings]


def _halvings(z: float, top: float) -> int:
    """Return how often a top can be halved without coming below a height, up to `HALVINGS`."""
    if z <= 0.0 < top:
        return HALVINGS
    return min(int(math.log2(top / z)), HALVINGS) if 0.0 < z < top else 0


@dataclass(frozen=True, slots=True, kw_only=True)
class GroundBounds:
    """What of ground is milled: only the plan area of the faces with `tags`, holes in it filled, and where there is a
    `ceiling`, only up to the straight line through two points, each a place along the straight lines and a height (mm): what is higher goes
    with other ground."""

    tags: tuple[int, ...]
    ceiling: tuple[tuple[float, float], tuple[float, float]] | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DevelopedGround:
    """Ground between two places (mm) along its straight lines, with what stands on it and around it.

    `rings` (k, 4): pieces of the meridians of what runs round, each from a place and a height to another one. `profile` (k, 2): the height
    mm of the blank over the plane at places along the straight lines. `found`: what the part has above heights, each worked out once, with
    looks at `progress`. `limit`: the area of the plane that alone is milled, where it is not all of the ground; `ceiling` (k,): the heights
    mm at the profile's places above which the blank is cut with other ground.
    """

    development: Development
    ends: tuple[float, float]
    obstacles: tuple[GroundObstacle, ...]
    rings: Floats
    profile: Floats
    progress: Progress = NO_PROGRESS
    found: dict[float, Region] = field(repr=False, default_factory=dict)
    limit: Region | None = None
    ceiling: Floats | None = None

    @property
    def least_radius(self) -> float:
        """The least radius (mm) of the ground."""
        return float(self.development.radius_at(np.array(self.ends)).min())

    @property
    def top(self) -> float:
        """How high (mm) the blank is over the ground, up to the ceiling."""
        return self.top_with(0.0)

    def top_with(self, allowance: float) -> float:
        """Return how high (mm) the blank is over the ground once what is above the ceiling is cut down to an allowance over it."""
        v = self.profile[:, 0]
        inside = (v >= self.ends[0]) & (v <= self.ends[1])
        return float(self._heights(allowance)[inside].max())

    def _heights(self, allowance: float) -> Floats:
        """Return how high (k,) mm the blank is at the profile's places, at most an allowance over the ceiling."""
        high = self.profile[:, 1]
        return high if self.ceiling is None else np.minimum(high, self.ceiling + allowance)

    @property
    def ring(self) -> Floats:
        """Places along the straight lines and heights (k, 2) mm of the blank away from both ends, where flanges beside it begin."""
        v = self.profile[:, 0]
        # The profile is as high as the higher one of two neighbours.
        within = END_STEPS * float(v[1] - v[0])
        inside = (v > self.ends[0] + within) & (v < self.ends[1] - within)
        return self.profile[inside]

    @property
    def ring_top(self) -> float:
        """How high (mm) the blank is over the ground away from its ends."""
        return float(self.ring[:, 1].max(initial=0.0))

    @property
    def widths(self) -> float:
        """The share of its width that a straight cutter still has over the plane at the top of the ring, where it has least of it."""
        return self.development.least_width(*self.ring.T) if len(self.ring) else 1.0

    def watched(self, progress: Progress) -> DevelopedGround:
        """Return the same ground, which looks at another progress."""
        return replace(self, progress=progress)

    def band(self, low: float, high: float, beyond: float = 0.0) -> Region:
        """Return the plane's area between two places along the straight lines, once around and `beyond` mm on either side."""
        half = math.pi + beyond / self.least_radius
        return sector(self.development, low, high, half)

    def around(self) -> Region:
        """Return the plane's area of the ground, or of its limit, and of what is looked at around it."""
        around = self.band(self.ends[0] - AROUND, self.ends[1] + AROUND, AROUND)
        if self.limit is None:
            return around
        low, high = self.limit.box()
        return around.intersect(
            Region.rectangle(low[0] - AROUND, low[1] - AROUND, high[0] + AROUND, high[1] + AROUND)
        )

    def milled(self) -> Region:
        """Return the plane's area of the ground that is milled, once around."""
        band = self.band(*self.ends)
        return band if self.limit is None else band.intersect(self.limit)

    @property
    def known(self) -> tuple[float, float]:
        """The places along the straight lines between which a tool meets nothing that is not known, shank and holder included."""
        return self.ends[0] - 0.5 * AROUND, self.ends[1] + 0.5 * AROUND

    def blank_over(self, z: float) -> Region:
        """Return the plane's area of the ground, once around, that the blank up to the ceiling is over a height on."""
        v, high = self.profile[:, 0], self._heights(0.0)
        over = (high > z) & (v >= self.ends[0]) & (v <= self.ends[1])
        edges = np.flatnonzero(np.diff(np.concatenate([[False], over, [False]]).astype(int)))
        step = float(v[1] - v[0])
        found = union_all(
            [
                self.band(
                    max(float(v[a]) - step, self.ends[0]), min(float(v[b - 1]) + step, self.ends[1])
                )
                for a, b in edges.reshape(-1, 2).tolist()
            ]
        )
        return found if self.limit is None else found.intersect(self.limit)

    def over(self, z: float) -> Region:
        """Return the plane's area over which the part reaches higher than a height."""
        if z not in self.found:
            self.progress.check()
            self.found[z] = self.progress.aside(
                lambda _: union_all(
                    [*self._rings_over(z), *(each.over(z) for each in self.obstacles)]
                )
            )
        return self.found[z]

    def _rings_over(self, z: float) -> list[Region]:
        """Return the bands over which what runs round reaches higher than a height."""
        v0, h0, v1, h1 = self.rings[np.maximum(self.rings[:, 1], self.rings[:, 3]) > z].T
        rise = np.where(h1 != h0, h1 - h0, 1.0)
        at = v0 + (v1 - v0) * np.clip((z - h0) / rise, 0.0, 1.0)
        start, end = np.where(h0 > z, v0, at), np.where(h1 > z, v1, at)
        low, high = np.minimum(start, end), np.maximum(start, end)
        order = np.argsort(low, kind="stable")
        bands: list[tuple[float, float]] = []
        for a, b in zip(low[order].tolist(), high[order].tolist(), strict=True):
            if bands and a <= bands[-1][1] + LAP:
                bands[-1] = (bands[-1][0], max(bands[-1][1], b))
            else:
                bands.append((a, b))
        inside = [
            (max(a, self.ends[0] - 2.0 * AROUND), min(b, self.ends[1] + 2.0 * AROUND))
            for a, b in bands
        ]
        return [
            self.band(a - LAP, b + LAP, 2.0 * AROUND) for a, b in inside if b > a - tolerance.SEW
        ]

    def free(
        self, z: float, tool: Tool, around: float, above: float, within: Region | None = None
    ) -> Region:
        """Return the area that the envelope of a cutter may be in, its tip at a height: shank and holder keep `around` mm from the part
        beside and `above` mm over it, but for a relieved neck where the flutes reach over the ring: what is beside it there came finished.
        Nothing outside `within` is looked at, nor anything in its way there (None: all the ground)."""
        within = self.limit if within is None else within
        obstacles = [self._near(z + SKIM, within, 0.0)]
        over_ring = z + tool.flute_length >= self.ring_top
        for z0, r0, _, r1 in tool.profile():
            more = max(r0, r1) - tool.radius
            if over_ring and more <= -RELIEF:
                continue
            height = z + max(SKIM, STEP * math.floor((z0 - above) / STEP))
            if more > -around:
                grown = max(more + around, 0.0)
                obstacles.append(self._near(height, within, grown).offset(grown))
        return self._free_of(obstacles, within)

    def free_for_tip(self, z: float) -> Region:
        """Return the area that a cutter may be in, its tip at a height, whatever is in the way of its shank and holder: no less than
        `free`."""
        return self._free_of([self._near(z + SKIM, self.limit, 0.0)], self.limit)

    def _free_of(self, obstacles: Sequence[Region], within: Region | None) -> Region:
        """Return what of an area, of all that is looked at where it is None, is free of obstacles."""
        area = self.around() if within is None else within
        if self.limit is not None:
            area = area.intersect(self.limit)
        return area.minus(union_all(obstacles))

    def _near(self, z: float, within: Region | None, beside: float) -> Region:
        """Return what the part has over a height, of an area and some mm beside it alone where one is given."""
        over = self.over(z)
        if within is None or not over:
            return over
        low, high = within.box()
        near = Region.rectangle(
            low[0] - beside, low[1] - beside, high[0] + beside, high[1] + beside
        )
        return over.intersect(near)


def sector(development: Development, low: float, high: float, half: float) -> Region:
    """Return the plane's area between two places along the straight lines and two angles (rad) about the axis, left and right of its
    middle; of a cone's plane at most all but a narrow gap."""
    return sector_between(development, low, high, -half, half)


def sector_between(
    development: Development, low: float, high: float, start: float, end: float
) -> Region:
    """Return the plane's area between two places along the straight lines and two angles (rad) about the axis from its middle, the second
    one above the first; of a cone's plane at most all but a narrow gap."""
    if development.half_turn == 0.0:
        return Region.rectangle(start * development.radius, low, end * development.radius, high)
    share = development.half_turn / math.pi
    most = (math.pi - GAP) / share
    start, end = max(start, -most), min(end, most)
    points = development.at(np.array([low, low, high, high]), np.array([start, end, end, start]))
    # Circles about the axis are arcs about the cone's tip, which lies beyond the narrow end.
    bulge = math.copysign(math.tan(0.25 * (end - start) * share), -development.slope)
    return Region.of(
        [Curve(points=points, bulges=np.array([bulge, 0.0, -bulge, 0.0]), closed=True)]
    )


def ground_of(
    development: Development,
    ends: tuple[float, float],
    mesh: Mesh,
    obstacles: Sequence[tuple[tuple[int, ...], bool]],
    rings: tuple[int, ...],
    blank: Blank,
    progress: Progress,
    limited: GroundBounds | None = None,
) -> DevelopedGround:
    """Return ground with what stands on it: sets of faces by their tags, and whether openings in them are no way down; `rings` are faces of
    revolution that run round. Sets too far beyond its ends to be in a cutter's way on it are left out, and triangles too far beside its
    limit, where it has one."""
    limit = None if limited is None else _plan_area_of(limited.tags, mesh, development)
    margin = AROUND / float(development.radius_at(np.array(ends)).min())
    made = []
    for tags, closed in progress.each(obstacles):
        corners = mesh.points[mesh.triangles[np.isin(mesh.face, tags)]]
        along = development.along_and_turn(development.to_local(corners.reshape(-1, 3)))[0]
        low, high = along.min(initial=math.inf), along.max(initial=-math.inf)
        if low > ends[1] + 2.0 * AROUND or high < ends[0] - 2.0 * AROUND:
            continue
        flat = developed_triangles(corners, development, BELOW, margin)
        made.append(GroundObstacle(corners=_near_to(limit, flat), closed=closed))
    profile = blank_profile(development, ends, blank)
    return DevelopedGround(
        development=development,
        ends=ends,
        obstacles=tuple(made),
        rings=_meridians(development, mesh, rings),
        profile=profile,
        progress=progress,
        limit=limit,
        ceiling=_line_at(limited.ceiling, profile[:, 0]) if limited and limited.ceiling else None,
    )


def _plan_area_of(tags: tuple[int, ...], mesh: Mesh, development: Development) -> Region:
    """Return the plane's area that faces are over, holes in it filled."""
    corners = mesh.points[mesh.triangles[np.isin(mesh.face, tags)]]
    flat = developed_triangles(corners, development, BELOW, 0.0)
    return plan_area_above(flat, BELOW, GROWN).holes_filled()


def _near_to(limit: Region | None, flat: Floats) -> Floats:
    """Return the triangles (m, 3, 3) over the plane that a cutter within a limit comes near to."""
    if limit is None:
        return flat
    low, high = limit.box()
    near = (flat[:, :, :2].max(axis=1) > np.asarray(low) - 2.0 * AROUND) & (
        flat[:, :, :2].min(axis=1) < np.asarray(high) + 2.0 * AROUND
    )
    return flat[near.all(axis=1)]


def _line_at(line: tuple[tuple[float, float], tuple[float, float]], v: Floats) -> Floats:
    """Return the heights (k,) of a straight line through two points at places (k,)."""
    (v0, h0), (v1, h1) = line
    return np.asarray(h0 + (h1 - h0) * (v - v0) / (v1 - v0))


def _meridians(development: Development, mesh: Mesh, tags: tuple[int, ...]) -> Floats:
    """Return the edges of faces that run round as pieces (k, 4) over the straight lines, each once."""
    triangles = mesh.triangles[np.isin(mesh.face, tags)]
    flat = development.to_local(mesh.points)
    along = development.along_and_turn(flat)[0]
    at = np.column_stack([along, flat[:, 2]]).round(ROUNDED)
    edges = np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    pieces = np.hstack([at[edges[:, 0]], at[edges[:, 1]]])
    return np.unique(pieces[np.maximum(pieces[:, 1], pieces[:, 3]) > BELOW], axis=0)


def blank_profile(development: Development, ends: tuple[float, float], blank: Blank) -> Floats:
    """Return places along the straight lines and how high (k, 2) mm the blank is over the plane there; where it is not round about the
    axis, everywhere as high as it gets."""
    v = np.linspace(ends[0] - AROUND, ends[1] + AROUND, LINES)
    seen = [_heights(development, v, blank, turn) for turn in TURNS]
    if max(float(np.abs(s - seen[0]).max()) for s in seen) > SKIM:
        shell = development.to_local(blank.frame.to_world(blank.shell()[0]))
        return np.column_stack([v, np.full(len(v), float(shell[:, 2].max()))])
    # Between two places the blank is at most as high as at the higher one of their neighbours.
    near = np.pad(seen[0], 1, mode="edge")
    return np.column_stack([v, np.maximum(np.maximum(near[:-2], near[2:]), seen[0])])


def _heights(development: Development, v: Floats, blank: Blank, turn: float) -> Floats:
    on = np.column_stack([np.zeros(len(v)), v, np.full(len(v), BELOW)])
    local = development.frame.to_local(development.to_world(on))
    flat = development.from_cylindrical(
        np.hypot(local[:, 0], local[:, 1]), np.full(len(v), turn), local[:, 2]
    )
    start, out = development.to_world(flat), development.normals(flat)[0]
    met = blank.intervals(blank.frame.to_local(start), blank.frame.local_direction(out))
    ahead = met.clipped(0.0, math.inf)
    return np.asarray(BELOW + ahead.tops(0.0))
