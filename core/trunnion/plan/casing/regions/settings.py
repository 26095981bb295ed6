"""What a person may choose about the machining regions of casings."""

from __future__ import annotations

from trunnion.settings import setting, settings


@settings("casing.regions")
class RegionSettings:
    """How far cutters keep off bosses, and how long a gap between them must be to be turned."""

    threshold: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=10000.0,
        label="Shortest gap",
        help="Arc length from which on a gap between bosses is turned; 0: by speed and machine, for each gap by itself.",
    )
    widening: float = setting(
        -1.0,
        unit="mm",
        low=-1.0,
        high=200.0,
        label="Widening of bosses",
        help="How much larger than its foot a boss counts on each side; -1: nose radius, allowance, clearance and half the insert's "
        "width together. 0 keeps narrow bands too.",
    )
    fillets: bool = setting(
        True,
        label="With root fillets",
        help="A boss counts to the toe of its root fillet, which is milled; without, to the foot of its sides.",
    )
    nose_radius: float = setting(
        0.8,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Nose radius",
        help="Radius of the corner of the turning insert.",
    )
    insert_width: float = setting(
        8.0,
        unit="mm",
        low=0.1,
        high=200.0,
        label="Width of the insert",
        help="Width of insert or holder along the main axis; bands that are narrower are not turned by themselves.",
    )
    allowance: float = setting(
        0.5,
        unit="mm",
        low=0.0,
        high=50.0,
        label="Allowance on sides",
        help="Material that is on the sides of bosses while their ground is turned.",
    )
    clearance: float = setting(
        1.0,
        unit="mm",
        low=0.0,
        high=100.0,
        label="Clearance",
        help="How far turning tools keep off bosses beside them, and over their tops.",
    )
    surface_speed: float = setting(
        40.0,
        unit="m/min",
        low=0.1,
        high=2000.0,
        label="Turning speed",
        help="Speed of the ground under the tool in interrupted turning.",
    )
    lowest_speed: float = setting(
        15.0,
        unit="m/min",
        low=0.1,
        high=2000.0,
        label="Lowest turning speed",
        help="Lowest speed that the insert's grade allows: down to it, lower speeds are offered for gaps that are too short.",
    )
    retract_speed: float = setting(
        20.0,
        unit="m/min",
        low=0.1,
        high=500.0,
        label="Speed of retracting",
        help="Highest speed of the axis that takes the tool out of the gap and back.",
    )
    acceleration: float = setting(
        3000.0,
        unit="mm/s2",
        low=1.0,
        high=50000.0,
        label="Acceleration",
        help="Acceleration of that axis.",
    )
    retract_angle: float = setting(
        0.0,
        unit="degrees",
        low=0.0,
        high=80.0,
        label="Angle of retracting",
        help="Angle between the way out of the gap and the radius.",
    )
    shortest_cut: float = setting(
        0.05,
        unit="s",
        low=0.0,
        high=60.0,
        label="Shortest cut",
        help="Time of cutting in a gap below which the way in and out is not worth while.",
    )
    margin: float = setting(
        5.0,
        unit="mm",
        low=0.0,
        high=1000.0,
        label="Margin",
        help="Length of a gap that is kept free for reaction times.",
    )
    shop_factor: float = setting(
        1.2,
        unit="times",
        low=1.0,
        high=10.0,
        label="Factor of the shop",
        help="What the shortest gap by the formula is multiplied with.",
    )

    @property
    def boss_widening(self) -> float:
        """How much larger a boss counts on each side, mm."""
        if self.widening >= 0.0:
            return self.widening
        return self.nose_radius + self.allowance + self.clearance + 0.5 * self.insert_width

    @property
    def narrowest(self) -> float:
        """Width (mm) of bands below which they are not turned by themselves; 0 where bosses count as they are."""
        return self.insert_width if self.boss_widening > 0.0 else 0.0
