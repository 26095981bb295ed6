"""Size analysis of an impeller: what bounds its cutters and what a drawing of it says, each with the faces and the place it is measured at.

Names are those of the field: bore, least channel width, root fillets, blade heights, thickness and lean, outlet diameter, meridians, and
whether the walls are ruled.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import FaceGraph
from trunnion.model.feature import Feature, Recognition
from trunnion.model.session import SizeEntry
from trunnion.progress import Progress
from trunnion.recognize.impeller.kinds import (
    BLADE,
    BORE,
    HUB,
    LEADING_EDGE,
    PRESSURE,
    ROOT_FILLET,
    SHROUD,
    SIDE,
    SPLITTER,
    SUCTION,
    TRAILING_EDGE,
)
from trunnion.recognize.impeller.lines import (
    BladeEnd,
    MeridianCurve,
    camber_end,
    exact_faces,
    fillet_radii,
    meridian_of,
    spread_over,
)
from trunnion.recognize.impeller.walls import (
    RULED,
    SizePoint,
    largest_lean,
    ruling_deviation,
    thickness,
)
from trunnion.units import rounded

if TYPE_CHECKING:
    from trunnion.part.part import Part

PART = "part"
CURVE = 61
"""Points that a meridian is given with."""
CONSTANT = 0.03
"""Share by which the bends of root fillets may differ while the radius is called constant: modellers approximate rolling balls."""
TAILS = (5.0, 50.0, 95.0)
"""Percentiles of the radii over all positions on root fillets: least, middle and largest without the kernel's corner values."""


@dataclass(frozen=True, eq=False, kw_only=True)
class ImpellerSizes:
    """The sizes of one recognised wheel."""

    found: Recognition
    graph: FaceGraph
    part: Part
    progress: Progress

    def entries(self) -> Iterator[SizeEntry]:
        """Yield the sizes of the whole wheel, then those of its representative blades."""
        blades = self.found.of_kind(BLADE, SPLITTER)
        yield from self._bore()
        if not blades or not len(self.hub.point):
            return
        yield self._entry("outlet_diameter", 2.0 * self.outlet, self._all(blades, TRAILING_EDGE))
        yield from self._channels(blades)
        yield from self._fillets(blades)
        for blade in self._examples:
            yield from self._heights(blade)
            yield from self._thickness(blade)
        yield from self._walls()
        yield from self._meridians()

    @cached_property
    def hub(self) -> MeridianCurve:
        """The hub's meridian."""
        tags = [t for f in self.found.of_kind(HUB) for t in f.tags]
        return MeridianCurve.of(exact_faces(self.part, self.found.frame, tags), self.progress)

    @cached_property
    def shroud(self) -> MeridianCurve:
        """The meridian of the main blades' tips from their leading edge on, as the first of them has it."""
        blade = self.found.of_kind(BLADE)[0]
        faces = exact_faces(self.part, self.found.frame, blade.with_role(SHROUD))
        curve = MeridianCurve.of(faces, self.progress)
        ends = self._camber_end(blade, LEADING_EDGE) if len(curve.point) > 1 else None
        return curve if ends is None else curve.from_point(ends[1])

    @cached_property
    def outlet(self) -> float:
        """Largest radius (mm) of the blades."""
        rows = [t - 1 for f in self.found.of_kind(BLADE) for t in f.tags]
        edges = sorted({e for r in rows for e in self.graph.edges_of[r]})
        ends = np.concatenate([self.graph.start[edges], self.graph.end[edges]])
        return float(meridian_of(self.found.frame.to_local(ends))[:, 0].max())

    @cached_property
    def _examples(self) -> tuple[Feature, ...]:
        """The first blade of each row: the others are copies of it."""
        first: dict[Any, Feature] = {}
        for f in self.found.of_kind(BLADE, SPLITTER):
            first.setdefault(f.attributes.get("row", f.kind), f)
        return tuple(first.values())

    def _bore(self) -> Iterator[SizeEntry]:
        for bore in self.found.of_kind(BORE):
            for name in ("diameter", "depth"):
                value = bore.sizes.get(name)
                if isinstance(value, (int, float)):
                    yield self._entry(f"bore_{name}", float(value), bore.with_role(SIDE))

    def _channels(self, blades: Sequence[Feature]) -> Iterator[SizeEntry]:
        """Yield the least width of all channels, then of each channel of one pitch (of all where the wheel is uneven)."""
        from trunnion.part.shape.gap import least_gap

        by_id = {f.id: f for f in blades}
        ordered = sorted(blades, key=lambda f: float(f.attributes.get("order", 0)))  # type: ignore[arg-type]
        uneven = any(f.code == "impeller.uneven" for f in self.found.findings)
        entries = []
        for n, blade in enumerate(ordered):
            if n and blade.kind == BLADE and not uneven:
                break
            after = by_id.get(str(blade.attributes.get("next", "")))
            if after is None or after is blade:
                continue
            sides = self._facing(blade, after)
            if not all(sides):
                continue
            gap = least_gap(self.part, *sides, self.progress)
            entries.append(
                SizeEntry(
                    name="width_to_next",
                    value=rounded(gap.distance),
                    unit="mm",
                    feature=blade.id,
                    faces=gap.faces,
                    at=_point(gap.first),
                    to=_point(gap.second),
                )
            )
        if entries:
            least = min(entries, key=lambda e: e.value)
            yield SizeEntry(
                name="channel_width",
                value=least.value,
                unit="mm",
                feature=PART,
                faces=least.faces,
                at=least.at,
                to=least.to,
            )
        yield from entries

    def _facing(self, blade: Feature, after: Feature) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Return the walls (tags) that face each other over the channel between a blade and the next one round the axis."""
        points, _ = self._samples(blade.with_role(PRESSURE))
        ahead = self._around(blade.with_role(PRESSURE)) >= 0.0 if len(points) else True
        roles = (PRESSURE, SUCTION) if ahead else (SUCTION, PRESSURE)
        return blade.with_role(roles[0]), after.with_role(roles[1])

    def _around(self, tags: Sequence[int]) -> float:
        """Return the mean sense round the axis in which faces look."""
        points, normals = self._samples(tags)
        local = self.found.frame.to_local(points)
        n = self.found.frame.local_direction(normals)
        return float((n[:, 1] * local[:, 0] - n[:, 0] * local[:, 1]).sum())

    def _samples(self, tags: Sequence[int]) -> tuple[Floats, Floats]:
        mine = np.isin(self.graph.sample_face, [t - 1 for t in tags])
        return self.graph.sample_point[mine], self.graph.sample_normal[mine]

    def _fillets(self, blades: Sequence[Feature]) -> Iterator[SizeEntry]:
        """Yield the radius of the root fillets: one where it is constant, the least and the largest where it isn't."""
        tags = [t for f in self._examples for t in f.with_role(ROOT_FILLET)]
        radii = []
        for face in self.progress.each(exact_faces(self.part, self.found.frame, tags)):
            radii.append(fillet_radii(face))
        spread = np.concatenate(radii) if radii else np.zeros(0)
        if not len(spread):
            return
        least, middle, most = np.percentile(spread, TAILS)
        if most - least <= CONSTANT * middle:
            yield self._entry("root_fillet_radius", float(middle), tags)
        else:
            yield self._entry("root_fillet_radius", float(least), tags)
            yield self._entry("root_fillet_radius_max", float(most), tags)

    def _heights(self, blade: Feature) -> Iterator[SizeEntry]:
        """Yield the heights of a blade from hub to shroud at its inlet and outlet, in the meridian."""
        for name, role in (
            ("blade_height_inlet", LEADING_EDGE),
            ("blade_height_outlet", TRAILING_EDGE),
        ):
            if ends := self._camber_end(blade, role):
                faces = blade.with_role(role) or blade.with_role(SHROUD)
                height = float(np.linalg.norm(ends[1] - ends[0]))
                yield self._entry(name, height, faces, blade.id)

    def _camber_end(self, blade: Feature, role: str) -> tuple[Floats, Floats] | None:
        edge, pressure, suction = (
            tuple(t - 1 for t in blade.with_role(r)) for r in (role, PRESSURE, SUCTION)
        )
        self.progress.check()
        faces = exact_faces(self.part, self.found.frame, blade.with_role(role))
        end = BladeEnd(edge=edge, sides=(pressure, suction))
        return camber_end(self.graph, self.found.frame, end, faces, self.hub)

    def _thickness(self, blade: Feature) -> Iterator[SizeEntry]:
        frame = self.found.frame
        sides = [
            spread_over(exact_faces(self.part, frame, blade.with_role(role)), self.progress)
            for role in (PRESSURE, SUCTION)
        ]
        if all(len(side.point) for side in sides):
            walls = blade.with_role(PRESSURE, SUCTION)
            for name, position in zip(
                ("blade_thickness", "blade_thickness_max"), thickness(*sides), strict=True
            ):
                yield self._point_entry(name, position, walls, blade.id)

    def _walls(self) -> Iterator[SizeEntry]:
        walls = [t for f in self._examples for t in f.with_role(PRESSURE, SUCTION)]
        faces = exact_faces(self.part, self.found.frame, walls)
        lean = largest_lean(spread_over(faces, self.progress), self.hub)
        yield self._point_entry("largest_lean", lean, walls, PART)
        worst = ruling_deviation(faces, self.hub, self.progress)
        yield self._point_entry("ruling_deviation", worst, walls, PART)
        yield self._entry("ruled", float(worst.value <= RULED), walls)

    def _meridians(self) -> Iterator[SizeEntry]:
        for name, curve, faces in (
            ("hub_curve", self.hub, [t for f in self.found.of_kind(HUB) for t in f.tags]),
            ("shroud_curve", self.shroud, self._all(self._examples[:1], SHROUD)),
        ):
            if len(curve.point) > 1:
                yield SizeEntry(
                    name=name,
                    value=rounded(curve.length),
                    unit="mm",
                    feature=PART,
                    faces=tuple(faces),
                    at=self._at(faces),
                    curve=tuple(rounded(v) for v in curve.thinned(CURVE).ravel().tolist()),
                )

    def _point_entry(
        self, name: str, position: SizePoint, faces: Sequence[int], feature: str
    ) -> SizeEntry:
        world = self.found.frame.to_world(np.array(position.at)) if position.at else None
        at = self._at(faces) if world is None else _point(world)
        unit = "degrees" if name.endswith("lean") else "mm"
        return SizeEntry(
            name=name,
            value=rounded(position.value),
            unit=unit,
            feature=feature,
            faces=tuple(faces),
            at=at,
        )

    def _entry(
        self, name: str, value: float, faces: Sequence[int], feature: str = PART
    ) -> SizeEntry:
        return SizeEntry(
            name=name,
            value=rounded(value),
            unit="" if name == "ruled" else "mm",
            feature=feature,
            faces=tuple(faces),
            at=self._at(faces),
        )

    def _at(self, faces: Sequence[int]) -> tuple[float, ...]:
        return _point(self.graph.centre[faces[0] - 1]) if faces else ()

    @staticmethod
    def _all(features: Sequence[Feature], role: str) -> tuple[int, ...]:
        return tuple(t for f in features for t in f.with_role(role))


def _point(point: Floats) -> tuple[float, ...]:
    return tuple(rounded(v) for v in point.tolist())
