"""Indexable inserts and the turning tools that hold them, with the names of ISO 13399 and the designations of ISO 1832."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.settings import added

CORNERS = {
    "C": (80.0, 100.0, 80.0, 100.0),
    "D": (55.0, 125.0, 55.0, 125.0),
    "S": (90.0, 90.0, 90.0, 90.0),
    "T": (60.0, 60.0, 60.0),
    "V": (35.0, 145.0, 35.0, 145.0),
    "W": (80.0, 160.0, 80.0, 160.0, 80.0, 160.0),
    "R": (),
}
"""Angles in degrees at the corners of each shape (ISO 1832, symbol 1), the cutting corner first; R is round."""
CLEARANCES = {"N": 0.0, "B": 5.0, "C": 7.0, "P": 11.0, "D": 15.0, "E": 20.0, "F": 25.0}
"""Clearance angle AN in degrees (ISO 1832, symbol 2)."""
THICKNESSES = {"02": 2.38, "03": 3.18, "T3": 3.97, "04": 4.76, "05": 5.56, "06": 6.35, "07": 7.94}
"""Thickness S in mm (ISO 1832, symbol 6)."""
_NOMINAL = 0.05
"""mm: an edge this little short of whole millimetres is named by them: 10.998 is 11."""
_NOSE = slice(8, 10)
HANDS = ("right", "left")
SEAT = 0.8
"""Share of the way from an insert's middle to its outline that the holder under it takes: it stands back behind all edges."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Insert:
    """An insert: all of its corners are tangent to its inscribed circle and rounded by the nose radius.

    `designation` after ISO 1832 (`CNMG120408`); `inscribed_circle` IC, `thickness` S, `nose_radius` RE in mm; `grade` its maker's word.
    """

    designation: str
    inscribed_circle: float
    thickness: float
    nose_radius: float
    grade: str = ""

    def __post_init__(self) -> None:
        wrong = self._wrong()
        if wrong:
            raise ValueError(f"insert {self.designation}: {wrong}")

    def _wrong(self) -> str:
        """Return what its numbers lack, or how they differ from its designation, or nothing."""
        d = self.designation
        if len(d) < 10 or d[0] not in CORNERS or d[1] not in CLEARANCES:
            return "not a designation after ISO 1832, such as CNMG120408"
        if self.inscribed_circle <= 0.0 or not 0.0 < self.nose_radius <= self.inscribed_circle / 2:
            return "needs an inscribed circle, and a nose radius that fits it"
        if d[4:6] != f"{int(self.edge_length + _NOMINAL):02d}":
            return f"its edge is {self.edge_length:.2f} mm long, its designation says {d[4:6]}"
        if THICKNESSES.get(d[6:8]) != self.thickness:
            return f"its thickness is {self.thickness:g} mm, its designation says {d[6:8]}"
        if CORNERS[d[0]] and d[_NOSE] != f"{round(10.0 * self.nose_radius):02d}":
            return f"its nose radius is {self.nose_radius:g} mm, its designation says {d[_NOSE]}"
        return ""

    @property
    def shape(self) -> str:
        """The letter of its shape, SC of ISO 13399."""
        return self.designation[0]

    @property
    def point_angle(self) -> float:
        """Angle at the cutting corner in degrees, EPSR; 0 of a round one, which has none."""
        return next(iter(CORNERS[self.shape]), 0.0)

    @property
    def clearance_angle(self) -> float:
        """Clearance angle AN in degrees."""
        return CLEARANCES[self.designation[1]]

    @property
    def edge_length(self) -> float:
        """Theoretical length L of a cutting edge in mm, between sharp corners; a round one's diameter."""
        angles = CORNERS[self.shape]
        if not angles:
            return self.inscribed_circle
        return sum(self.inscribed_circle / 2 / math.tan(math.radians(a / 2)) for a in angles[:2])

    def as_dict(self) -> dict[str, Any]:
        """Return the insert with the properties of ISO 13399."""
        return {
            "designation": self.designation,
            "SC": self.shape,
            "IC": self.inscribed_circle,
            "S": self.thickness,
            "RE": self.nose_radius,
            "EPSR": self.point_angle,
            "AN": self.clearance_angle,
            "L": self.edge_length,
            "grade": self.grade,
        }


@dataclass(frozen=True, slots=True, kw_only=True)
class TurningTool:
    """An insert in a turning holder.

    `edge_angle` KAPR, degrees, from the direction of feed to the major cutting edge; `hand`; `shank_height` H, `shank_width` B,
    `functional_length` LF and `functional_width` WF in mm, from the shank's end and side to the tool's point. The point is where the
    lines along and across the work's axis touch the nose. The shank lies across the work's axis; that of an `inside` tool, a boring bar of
    diameter B, along it: WF is from the bar's axis, and it cuts outwards. The head is `head_length` LH long, 0: as far as the insert goes.
    """

    number: int
    name: str
    insert: Insert
    edge_angle: float
    hand: str
    shank_height: float
    shank_width: float
    functional_length: float
    functional_width: float
    holder_name: str
    description: str = ""
    inside: bool = added(False, written=False)
    head_length: float = added(0.0, written=False)

    def __post_init__(self) -> None:
        if self.hand not in HANDS:
            raise ValueError(f"tool {self.name}: its hand is one of {', '.join(HANDS)}")
        lengths = (
            self.shank_height,
            self.shank_width,
            self.functional_length,
            self.functional_width,
        )
        if min(lengths) <= 0.0:
            raise ValueError(f"tool {self.name}: shank and functional lengths are above 0")
        if not 0.0 < self.edge_angle < 180.0 or self.end_angle <= 0.0:
            raise ValueError(
                f"tool {self.name}: at {self.edge_angle:g} degrees its {self.insert.point_angle:g} degree corner "
                "rubs behind the cutting edge"
            )

    @property
    def cutter_sizes(self) -> tuple[float, float]:
        """Diameter and radius in mm of the nose, as CUTTER of APT has them."""
        return 2.0 * self.insert.nose_radius, self.insert.nose_radius

    @property
    def rotates(self) -> bool:
        """Whether it turns in the spindle: it stands still, and the work turns."""
        return False

    @property
    def locked(self) -> bool:
        """Whether a milling spindle holds it that stands still: a lathe's turret or ram does."""
        return False

    @property
    def form(self) -> str:
        """The form that tool lists call it."""
        return "turning"

    @property
    def end_angle(self) -> float:
        """Angle in degrees between the direction of feed and the edge behind the nose."""
        return 180.0 - self.edge_angle - self.insert.point_angle

    @property
    def gauge_length(self) -> float:
        """From the shank's end to the point, mm."""
        return self.functional_length

    def outline(self) -> tuple[tuple[float, float, float], ...]:
        """Return the insert as points (z, x, bulge) round it, seen on its rake face, the tool's point at (0, 0).

        A right-hand tool feeds towards -z with the work below it (x < 0); a left-hand one is its mirror image, an inside one has the work
        above it. Bulge is the tangent of a quarter of the arc's angle to the next point, positive where it is rounded outwards, 0 for a
        line.
        """
        along, out = self._senses
        return tuple((along * z, out * x, b) for z, x, b in _rounded(self.insert, self.edge_angle))

    @property
    def _senses(self) -> tuple[float, float]:
        """The senses along z and x that the tool lies in, seen from its point."""
        return (1.0 if self.hand == "right" else -1.0), (-1.0 if self.inside else 1.0)

    def insert_profile(self, chord: float) -> Floats:
        """Return the insert's outline as points (m, 2) of x and z, convex, the tool's point at (0, 0); chords leave its noses by no more
        than `chord` mm."""
        rows = np.array(_rounded(self.insert, self.edge_angle))
        # The way round is clockwise, so arcs that are rounded outwards are too.
        closed = Curve(points=rows[:, :2], bulges=-rows[:, 2], closed=True)
        along, out = self._senses
        # What is turned along and across the axis is as large as the nose's own touching points say.
        nose = (
            self.insert.inscribed_circle / 2
            if not self.insert.point_angle
            else self.insert.nose_radius
        )
        points = np.vstack([closed.sampled(chord)[:-1, ::-1], [[nose, 0.0], [0.0, nose]]])
        # All lie on one convex outline: in the order of their directions from its middle they go round it.
        off = points - points.mean(axis=0)
        order = np.argsort(np.arctan2(off[:, 1], off[:, 0]), kind="stable")
        return points[order] * [out, along]

    def holder_profiles(self) -> tuple[Floats, ...]:
        """Return the holder's head, from under the insert to the shank, and its shank as convex outlines (m, 2) of x and z, the tool's
        point at (0, 0)."""
        insert = self.insert_profile(self.insert.nose_radius)
        middle = 0.5 * (insert.min(axis=0) + insert.max(axis=0))
        seat = middle + SEAT * (insert - middle)
        along, out = self._senses
        head = self.head_length or float(np.abs(insert).max())
        if self.inside:
            near, far = (
                self.functional_width - self.shank_width / 2,
                self.functional_width + self.shank_width / 2,
            )
            ends = np.array(
                [
                    [near, head],
                    [far, head],
                    [far, self.functional_length],
                    [near, self.functional_length],
                ]
            )
        else:
            near, far = self.functional_width - self.shank_width, self.functional_width
            ends = np.array(
                [
                    [head, near],
                    [head, far],
                    [self.functional_length, far],
                    [self.functional_length, near],
                ]
            )
        shank = ends * [out, along]
        return np.vstack([seat, shank[:2]]), shank

    def header_sizes(self) -> tuple[tuple[str, float], ...]:
        """Return the lengths mm that a program's header names, each with the word before it."""
        return (
            ("R", self.insert.nose_radius),
            ("LENGTH ", self.functional_length),
            ("WIDTH ", self.functional_width),
        )

    def as_dict(self) -> dict[str, Any]:
        """Return the tool as `NAME.tools.json` has it, with the properties of ISO 13399."""
        return {
            "number": self.number,
            "name": self.name,
            "form": self.form,
            "insert": self.insert.as_dict(),
            "KAPR": self.edge_angle,
            "hand": self.hand,
            "H": self.shank_height,
            "B": self.shank_width,
            "LF": self.functional_length,
            "WF": self.functional_width,
            "outline": [list(row) for row in self.outline()],
            "gauge_length": self.gauge_length,
            "holder_name": self.holder_name,
            "description": self.description,
            "inside": self.inside,
            "LH": self.head_length,
        }


def _rounded(insert: Insert, edge_angle: float) -> tuple[tuple[float, float, float], ...]:
    """Return an insert's outline with its nose circle touching both axes from above; (z, x, bulge), clockwise as z runs right, x up."""
    r, half = insert.nose_radius, insert.inscribed_circle / 2
    angles = CORNERS[insert.shape]
    if not angles:
        return ((0.0, half, 1.0), (2.0 * half, half, 1.0))
    # The bisector of the cutting corner; corners of a tangential polygon lie half / sin(angle / 2) from its middle.
    away = math.radians(180.0 - edge_angle - angles[0] / 2)
    middle = (half - r) / math.sin(math.radians(angles[0] / 2))
    centre = (r + middle * math.cos(away), r + middle * math.sin(away))
    rows, turned = [], away + math.pi
    for k, angle in enumerate(angles):
        # Round a corner the normal turns from one edge's to the next one's, half as much on either side of the corner's direction.
        far = (half - r) / math.sin(math.radians(angle / 2))
        nose = (centre[0] + far * math.cos(turned), centre[1] + far * math.sin(turned))
        open_ = math.radians(90.0 - angle / 2)
        for normal, bulge in ((turned + open_, math.tan(open_ / 2)), (turned - open_, 0.0)):
            rows.append((nose[0] + r * math.cos(normal), nose[1] + r * math.sin(normal), bulge))
        after = angles[(k + 1) % len(angles)]
        turned -= math.radians(180.0 - angle / 2 - after / 2)
    return tuple(rows)
