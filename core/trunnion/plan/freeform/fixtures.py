"""What fixtures, or areas to avoid, keep an upright cutter from on curved faces: it is cut off their area before passes are laid, and the
fixtures stand in the skin that cutters are dropped on, so that passes and links go over them or end beside them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.mesh import welded
from trunnion.geometry.sheet.skin import Skin
from trunnion.geometry.surface.drop_surface import DropSurface, tops_over
from trunnion.model.blank import Blank
from trunnion.model.fixture import Fixture
from trunnion.model.keep_out import KeepOutBox, plan_boxes
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import level_disc, lower_side
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.plan.freeform.finishing.partition import parted_near
from trunnion.plan.freeform.finishing.rest import AROUND, MET, MOST, upright_tips
from trunnion.progress import NO_PROGRESS, Progress

NO_FACE = 0
"""The tag of triangles that are none of the part's."""
MOST_MITRE = 3.0
"""Of the room: a corner goes no further out than this, however sharp it is."""


@dataclass(frozen=True, slots=True, eq=False)
class OffsetFixture:
    """A fixture in a cutting frame, thicker by its room: corners (t, 3, 3) of its triangles."""

    name: str
    corners: Floats

    @staticmethod
    def of(fixture: Fixture, setup: Setup, blank: Blank) -> OffsetFixture:
        """Return a fixture as it stands in a setup, thicker all round in plan and as much higher where it is over the blank's underside."""
        foot = float(blank.box_in(setup.frame)[0][2]) + tolerance.SEW
        # Corners that coincide are one: then the edges of a box go out as a whole.
        points, triangles = welded(fixture.mesh, tolerance.COINCIDENT)
        points = setup.frame.to_local(points)
        thick = points + _outwards(points, triangles)
        thick[points[:, 2] > foot, 2] += tolerance.FIXTURE_CLEARANCE
        return OffsetFixture(fixture.name, np.concatenate([points[triangles], thick[triangles]]))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class KeepOutArea:
    """What a cutter is kept from: an area in mm2 of faces, the names of fixtures, and a place there (3,) in the cutting frame."""

    area: float
    by: tuple[str, ...]
    at: Floats


def _outwards(points: Floats, triangles: Ints) -> Floats:
    """Return by how much (v, 3) corners go out in plan, so that each side beside them goes out by the room: the least such way."""
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    normal = np.cross(b - a, c - a)
    across = np.hypot(normal[:, 0], normal[:, 1])
    side = across > math.sin(tolerance.TANGENT) * np.linalg.norm(normal, axis=1)
    sides = normal[side, :2] / across[side, None]
    # The least way d with n d = 1 for the normals n of all sides beside a corner, by their normal equations.
    squares, sums = np.zeros((len(points), 2, 2)), np.zeros((len(points), 2))
    for k in range(3):
        np.add.at(squares, triangles[side, k], sides[:, :, None] * sides[:, None, :])
        np.add.at(sums, triangles[side, k], sides)
    inverse = np.linalg.pinv(squares, rcond=tolerance.COINCIDENT, hermitian=True)
    way = np.einsum("vij,vj->vi", inverse, sums)
    size = np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1.0)
    out = np.zeros_like(points)
    out[:, :2] = tolerance.FIXTURE_CLEARANCE * way * np.minimum(1.0, MOST_MITRE / size)
    return out


def off_fixtures(
    skin: Skin,
    tags: tuple[int, ...],
    tool: Tool,
    fixtures: Sequence[OffsetFixture],
    lowest: float,
    height: float,
    progress: Progress = NO_PROGRESS,
) -> tuple[Skin, tuple[int, ...], KeepOutArea | None]:
    """Return the skin and the tags of what of faces an upright tool finishes with all of it beside or over fixtures, and what is left
    out, None where nothing is; `height` is the scallop height in mm that is wanted."""
    surface = _surface(fixtures)

    def top(tip: Floats) -> Floats:
        highest = surface.drop(tip, lower_side(tool), lowest, progress)
        for above, radius in tool.rings()[1:]:
            over = surface.drop(tip, level_disc(radius), lowest, progress)
            highest = np.maximum(highest, over - above)
        return highest

    met_skin, left, area, (low, high) = _above(skin, tags, tool, top, height, progress)
    if not area:
        return skin, tags, None
    wide = max(radius for _, radius in tool.rings())
    by = tuple(
        f.name
        for f in fixtures
        if (f.corners[..., :2] <= high[:2] + wide).all(axis=2).any()
        and (f.corners[..., :2] >= low[:2] - wide).all(axis=2).any()
    )
    return met_skin, left, KeepOutArea(area=area, by=by, at=0.5 * (low + high))


def off_boxes(
    skin: Skin,
    tags: tuple[int, ...],
    tool: Tool,
    boxes: Sequence[KeepOutBox],
    height: float,
    progress: Progress = NO_PROGRESS,
) -> tuple[Skin, tuple[int, ...], KeepOutArea | None]:
    """Return the skin and the tags of what of faces an upright tool finishes with its tip outside boxes of the skin's frame, and what is
    left out, None where nothing is; `height` is the scallop height in mm that is wanted. No tip is dropped into a box of the skin."""
    avoid = plan_boxes(boxes)
    met_skin, left, area, (low, high) = _above(
        skin, tags, tool, lambda tip: tops_over(tip, avoid), height, progress, everywhere=True
    )
    lost = KeepOutArea(area=area, by=(), at=0.5 * (low + high)) if area else None
    return replace(met_skin, avoid=avoid), left, lost


def _above(
    skin: Skin,
    tags: tuple[int, ...],
    tool: Tool,
    top: Callable[[Floats], Floats],
    height: float,
    progress: Progress,
    everywhere: bool = False,
) -> tuple[Skin, tuple[int, ...], float, tuple[Floats, Floats]]:
    """Return the skin and the tags of what of faces an upright tool finishes with its tip above tops (n,) over plan points (n, 2), and
    what is left out: its area in mm2 and the corners (3,) of the box around it; the given skin and tags, 0 and zeros where nothing is."""

    def over(position: Floats, normal: Floats) -> Floats:
        met = np.full(len(position), -np.inf)
        up = normal[:, 2] > -math.sin(tolerance.ANGLE)
        tip = upright_tips(skin, position[up], normal[up], tool)
        met[up] = top(tip[:, :2]) - tip[:, 2]
        return met

    around = 2.0 * max(AROUND, stepover_on_plane(max(tool.corner_radius, height), height))
    whole = float(skin.areas(skin.of(tags)).sum())
    longest = max(MET, math.sqrt(whole / MOST))
    met_skin, met = parted_near(skin, tags, over, around, longest, progress, everywhere)
    if not met:
        return skin, tags, 0.0, (np.zeros(3), np.zeros(3))
    left = tuple(t for t in tags if met_skin.of((t,)).any())
    points = met_skin.points[met_skin.triangles[met_skin.of(met)]].reshape(-1, 3)
    area = whole - float(met_skin.areas(met_skin.of(left)).sum())
    return met_skin, left, area, (points.min(axis=0), points.max(axis=0))


def with_fixtures(skin: Skin, fixtures: Sequence[OffsetFixture]) -> Skin:
    """Return a skin with fixtures that stand in it: cutters are lifted over them, and they are no face's."""
    corners = np.concatenate([f.corners for f in fixtures])
    points = corners.reshape(-1, 3)
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(across, axis=1, keepdims=True)
    normal = np.divide(
        across, size, out=np.tile([0.0, 0.0, 1.0], (len(across), 1)), where=size > 0.0
    )
    return replace(
        skin,
        points=np.concatenate([skin.points, points]),
        normals=np.concatenate([skin.normals, np.repeat(normal, 3, axis=0)]),
        triangles=np.concatenate(
            [skin.triangles, len(skin.points) + np.arange(len(points)).reshape(-1, 3)]
        ),
        face=np.concatenate([skin.face, np.full(len(corners), NO_FACE)]),
    )


def _surface(fixtures: Sequence[OffsetFixture]) -> DropSurface:
    points = np.concatenate([f.corners.reshape(-1, 3) for f in fixtures])
    return DropSurface.of(points, np.arange(len(points)).reshape(-1, 3))
