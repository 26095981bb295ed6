"""Rotating tools with shank and holder, as the catalogue, the plan and the proof see them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from trunnion import tolerance
from trunnion.model.tool.drill import point_height, wrong_drill
from trunnion.model.tool.holder import Holder
from trunnion.model.tool.lead import (
    BORING_BAR,
    FINISHING,
    REAMER,
    REAMER_EDGE,
    TAP,
    basic_minor_diameter,
    wrong_boring_bar,
    wrong_reamer,
    wrong_tap,
)
from trunnion.model.tool.mill import MILLS, T_SLOT
from trunnion.model.tool.thread_mill import THREAD_MILL, mill_core, wrong_thread_mill
from trunnion.settings import added

CHECKS: Mapping[str, Callable[[Tool], str]] = {
    **MILLS,
    "drill": wrong_drill,
    REAMER: wrong_reamer,
    BORING_BAR: wrong_boring_bar,
    TAP: wrong_tap,
    THREAD_MILL: wrong_thread_mill,
}
"""What the numbers of each form lack, in words, or nothing."""
FORMS = tuple(CHECKS)
BUTTON = "button"
"""The form of a round turning insert in a neutral holder."""
PLAIN_FORMS = ("flat", "bull", "ball", BUTTON)
"""Forms that are an end of a radius and a corner radius, and nothing else."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tool:
    """A rotating tool in its holder. Heights are from the tip (the lowest point, on the axis), mm.

    `flute_length` cuts; above it a neck of `neck_diameter` up to `neck_length` (equal to the flute's when there is none), then the shank of
    `shank_diameter` up to `stickout`, where the holder's nose is. `gauge_length` is from tip to spindle face.

    What cuts, by `form`:

    - flat, bull, ball: `diameter`, `corner_radius`.
    - taper: a bull end of `diameter` and `corner_radius`, and above its corner a flank that leans out by `taper_angle` (degrees).
    - barrel: a round tip of `corner_radius`, tangent to a flank of `barrel_radius` whose widest circle is `diameter`.
    - t-slot: a disc of `diameter`, as thick as the flutes are long, rounded below and above by `corner_radius`; it cuts upwards too.
    - drill: a cone of `point_angle` (degrees, over both sides) and a cylinder of `diameter`.
    - reamer: a cylinder of `diameter` below which a `lead` (mm high) is chamfered at 45 degrees; `fit` is the tolerance class (ISO 286-1,
      "H7") of the holes that it makes.
    - boring-bar: one edge that is set to `diameter`, in the catalogue the largest of its range, from `smallest` on (mm); taken for a
      cylinder with a `lead` as a reamer is. Once set, `fit` is what it is set for.
    - tap: a thread of the nominal `diameter` and of `pitch` (mm), whose lowest threads are chamfered over the height `lead`. What it is
      taken to cut is the cylinder of its `core_diameter`: in a bore of that size it takes nothing off.
    - thread-mill: thread teeth of `diameter` over a height of `flute_length`: a comb of one `pitch` (mm), or (pitch 0) a single tooth that
      cuts pitches from `pitch_low` to `pitch_high`. What it is taken to cut is the cylinder of its core, inside its teeth.
    - button: a round turning insert of `diameter` in a neutral holder, which the locked spindle holds while the table brings the work past:
      what is kept clear of it, and what it is taken to cut, is a ball end of `diameter`.
    - form: `outline`, points (r, z, bulge) from the tip to the top of the flutes; the bulge (tan of a quarter of the arc's angle, positive
      where the cutter is rounded outwards) belongs to the way to the next point.
    """

    number: int
    name: str
    form: str
    diameter: float
    corner_radius: float
    flute_length: float
    neck_diameter: float
    neck_length: float
    shank_diameter: float
    stickout: float
    gauge_length: float
    teeth: int
    centre_cutting: bool
    helix_angle: float
    holder: Holder
    description: str = ""
    taper_angle: float = 0.0
    barrel_radius: float = 0.0
    point_angle: float = 180.0
    outline: tuple[tuple[float, float, float], ...] = ()
    pitch: float = added(0.0, written=False)
    lead: float = added(0.0, written=False)
    fit: str = added("", written=False)
    smallest: float = added(0.0, written=False)
    pitch_low: float = added(0.0, written=False)
    pitch_high: float = added(0.0, written=False)

    def __post_init__(self) -> None:
        if self.form not in FORMS:
            raise ValueError(f"tool {self.name}: form {self.form} is none of {', '.join(FORMS)}")
        if not 0.0 <= self.corner_radius <= self.diameter / 2:
            raise ValueError(
                f"tool {self.name}: corner radius {self.corner_radius} does not fit diameter {self.diameter}"
            )
        if not 0.0 < self.flute_length <= self.neck_length <= self.stickout <= self.gauge_length:
            raise ValueError(
                f"tool {self.name}: flute, neck, stickout and gauge length must grow in this order"
            )
        if self.form not in (*FINISHING, TAP, THREAD_MILL) and (
            self.pitch or self.lead or self.fit
        ):
            raise ValueError(
                f"tool {self.name}: pitch, lead and fit are of tools for threads and fits, not of the form {self.form}"
            )
        if self.smallest and self.form != BORING_BAR:
            raise ValueError(f"tool {self.name}: only boring bars have a smallest diameter")
        if self.form != THREAD_MILL and (self.pitch_low or self.pitch_high):
            raise ValueError(f"tool {self.name}: only thread mills have a range of pitches")
        wrong = CHECKS[self.form](self)
        if wrong:
            raise ValueError(f"tool {self.name}: {wrong}")

    @property
    def cutter_sizes(self) -> tuple[float, float]:
        """Diameter and corner radius in mm, as CUTTER of APT has them."""
        return self.diameter, self.corner_radius

    @property
    def rotates(self) -> bool:
        """Whether it is moved as milling tools are, the work held by the machine's axes, and not as a lathe's tool is."""
        return True

    @property
    def locked(self) -> bool:
        """Whether the spindle that holds it stands still."""
        return self.form == BUTTON

    @property
    def cuts_threads(self) -> bool:
        """Whether it cuts a thread: its core alone is taken to take anything off."""
        return self.form in (TAP, THREAD_MILL)

    @property
    def point_length(self) -> float:
        """Height above the tip from which on the tool makes its whole diameter: a drill's point, the lead of a reamer or tap; 0 for other
        forms."""
        if self.form == "drill":
            return point_height(self.diameter, self.point_angle)
        return self.lead

    @property
    def full_width_height(self) -> float:
        """Height above the tip from which on a cylinder of its radius is all inside of it: a drill's point, a lead, a form's widest
        place."""
        if self.form == "form":
            widest = max(r for r, _, _ in self.outline)
            return next(z for r, z, _ in self.outline if r == widest)
        return self.point_length

    @property
    def widest_height(self) -> float:
        """Height of a barrel's widest circle: its tip's and its flank's arcs touch, one inside the other. 0 for other forms."""
        if self.form != "barrel":
            return 0.0
        between, across = self.barrel_radius - self.corner_radius, self.barrel_radius - self.radius
        return self.corner_radius + math.sqrt(max(between**2 - across**2, 0.0))

    @property
    def radius(self) -> float:
        """Half the diameter."""
        return self.diameter / 2

    @property
    def core_diameter(self) -> float:
        """Diameter of what the tool is taken to cut: of a tap the basic minor diameter of its thread, of a thread mill what is inside its
        teeth, of others their diameter."""
        if self.form == TAP:
            return basic_minor_diameter(self.diameter, self.pitch)
        if self.form == THREAD_MILL:
            return mill_core(self)
        return self.diameter

    @property
    def core_radius(self) -> float:
        """Half the core's diameter."""
        return self.core_diameter / 2

    @property
    def column_radius(self) -> float:
        """Radius in mm within which nothing stays over the tip where the tool has been: of a T-slot cutter, over whose disc material
        stays, that of what carries the disc; of others the core's."""
        if self.form != T_SLOT:
            return self.core_radius
        carrier = (
            self.neck_diameter if self.neck_length > self.flute_length else self.shank_diameter
        )
        return min(carrier / 2, self.core_radius)

    @property
    def edge_angle(self) -> float:
        """Angle in degrees between the cutting edges and the axis of a tool that cuts along it: half a drill's point angle, 45 on the lead
        of a reamer or boring bar; 0 for other forms."""
        if self.form == "drill":
            return 0.5 * self.point_angle
        return REAMER_EDGE if self.form in FINISHING else 0.0

    @property
    def reach(self) -> float:
        """How deep below the surroundings the cutter may go before something thicker than it follows."""
        if max(self.shank_diameter, self.neck_diameter) <= self.core_diameter:
            return self.stickout
        return self.neck_length

    def flank_step(self, height: float) -> float:
        """Return how deep the layers along a wall of a height may be, mm: the flutes reach over what the layer above left.

        One layer takes all that the flutes are long. Of several, each leaves the fillet of the corner radius R at its foot, and the neck of
        the next comes as high as its flutes: they have to pass the height h at which that fillet is as wide as the neck stands back, e:
        R - sqrt(R^2 - (R - h)^2) = e.
        """
        if height <= self.flute_length:
            return self.flute_length
        fillet = self.corner_radius
        back = min(max(self.radius - self.neck_diameter / 2, 0.0), fillet)
        return self.flute_length - (fillet - math.sqrt(fillet**2 - (fillet - back) ** 2))

    def profile(self) -> tuple[tuple[float, float, float, float], ...]:
        """Return what is above the flutes (neck, shank, holder) as truncated cones (z0, r0, z1, r1) from the tip."""
        rows = []
        if self.neck_length > self.flute_length:
            rows.append(
                (
                    self.flute_length,
                    self.neck_diameter / 2,
                    self.neck_length,
                    self.neck_diameter / 2,
                )
            )
        if self.stickout > self.neck_length:
            rows.append(
                (self.neck_length, self.shank_diameter / 2, self.stickout, self.shank_diameter / 2)
            )
        rows += [
            (self.stickout + z0, r0, self.stickout + z1, r1) for z0, r0, z1, r1 in self.holder.rows
        ]
        return tuple(rows)

    def rings(self) -> list[tuple[float, float]]:
        """Return from which height above the tip the tool is how wide: (mm, radius in mm) of the cutter and of all above the flutes that is
        wider."""
        wider = [
            (z0, max(r0, r1))
            for z0, r0, _, r1 in self.profile()
            if max(r0, r1) > self.core_radius + tolerance.COINCIDENT
        ]
        return [(0.0, self.core_radius), *wider]

    def radius_at(self, height: float) -> float:
        """Return the radius of the cutting part at a height above the tip."""
        if height >= self.corner_radius:
            return self.radius
        depth = self.corner_radius - max(height, 0.0)
        return (
            self.radius - self.corner_radius + math.sqrt(max(self.corner_radius**2 - depth**2, 0.0))
        )

    def header_sizes(self) -> tuple[tuple[str, float], ...]:
        """Return the lengths mm that a program's header names, each with the word before it: of a tap and of a thread mill's comb its
        pitch in the place of a corner radius."""
        return (
            ("D", self.diameter),
            ("PITCH ", self.pitch) if self.pitch else ("R", self.corner_radius),
            ("LENGTH ", self.gauge_length),
            ("STICKOUT ", self.stickout),
        )

    @property
    def holder_name(self) -> str:
        """What holds it."""
        return self.holder.name

    def as_dict(self) -> dict[str, Any]:
        """Return the tool as `NAME.tools.json` has it; what only forms for threads and fits have stands there where it is given."""
        shape = {
            "pitch": self.pitch,
            "lead": self.lead,
            "fit": self.fit,
            "smallest": self.smallest,
            "pitch_low": self.pitch_low,
            "pitch_high": self.pitch_high,
        }
        return {
            "number": self.number,
            "name": self.name,
            "form": self.form,
            "diameter": self.diameter,
            "corner_radius": self.corner_radius,
            "taper_deg": self.taper_angle,
            "barrel_radius": self.barrel_radius,
            "point_deg": self.point_angle,
            "outline": [list(row) for row in self.outline],
            "flute_length": self.flute_length,
            "neck_diameter": self.neck_diameter,
            "neck_length": self.neck_length,
            "shank_diameter": self.shank_diameter,
            "stickout": self.stickout,
            "gauge_length": self.gauge_length,
            "teeth": self.teeth,
            "holder": [list(row) for row in self.holder.rows],
            "holder_name": self.holder.name,
            "description": self.description,
            **{name: value for name, value in shape.items() if value},
        }
