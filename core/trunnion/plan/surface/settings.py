"""What a person may choose about the plan of a part of curved surfaces."""

from __future__ import annotations

from trunnion.findings import BadInput
from trunnion.plan.freeform.estimate.scallop import height_of
from trunnion.settings import setting, settings


@settings("surface")
class SurfaceRouteSettings:
    """Which cutters finish curved faces, how fine, and what is left for them."""

    scallop: float = setting(
        0.004,
        unit="mm",
        low=0.0002,
        high=1.0,
        label="Scallop height",
        help="Height of the ridges between passes that finishing leaves.",
    )
    ra: float = setting(
        0.0,
        unit="um",
        low=0.0,
        high=100.0,
        label="Wanted Ra",
        help="Roughness that the scallop height is chosen for, 2.5 um of height for each um; 0: as said by the height.",
    )
    share: float = setting(
        0.97,
        unit="of the area",
        low=0.5,
        high=1.0,
        label="Reach",
        help="Share of an area that its cutter must reach without gouging; the largest that does is taken.",
    )
    cutter: str = setting(
        "",
        label="Cutter",
        catalogue="tools",
        help="Name of the cutter that finishes all areas but local features; empty: the largest that reaches.",
    )
    local_cutter: str = setting(
        "",
        label="Local cutter",
        catalogue="tools",
        help="Name of the cutter that finishes local features; empty: the largest that reaches.",
    )
    rough_cutter: str = setting(
        "",
        label="Roughing cutter",
        catalogue="tools",
        help="Name of the cutter that roughs; empty: the largest that leaves little.",
    )
    layer: float = setting(
        1.5,
        unit="mm",
        low=0.05,
        high=50.0,
        label="Roughing layer",
        help="Height of the steps that roughing leaves on slopes, after layers as deep as material and cutter bear.",
    )
    rough_allowance: float = setting(
        0.3,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Roughing allowance",
        help="What roughing leaves all round.",
    )
    semi_allowance: float = setting(
        0.1,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Semi-finishing allowance",
        help="What semi-finishing leaves for the last cut; 0: nothing is semi-finished.",
    )
    semi_scallop: float = setting(
        0.05,
        unit="mm",
        low=0.001,
        high=2.0,
        label="Semi-finishing scallop",
        help="Height of the ridges that semi-finishing leaves on its allowance.",
    )
    steep: float = setting(
        70.0,
        unit="deg",
        low=10.0,
        high=84.0,
        label="Steep from",
        help="What leans from level by more is cut level by level.",
    )
    extension: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=100.0,
        label="Passes past free rims",
        help="How far finishing runs on along the face's tangent past the rim of open faces and past high sharp edges, "
        "where nothing is beside; 0: to the rim.",
    )
    lands: bool = setting(
        True,
        label="End mills on level lands",
        help="Level faces are finished with end mills where these reach most of "
        "them; off: with balls, as curved ones.",
    )
    cell: float = setting(
        0.25,
        unit="mm",
        low=0.05,
        high=5.0,
        label="Map cell",
        help="Distance of the places at which roughing measures how high the part stands.",
    )

    def consistent(self) -> SurfaceRouteSettings:
        """Return itself; raise `BadInput` when semi-finishing would leave more than roughing did, and so cut nothing."""
        if self.semi_allowance > self.rough_allowance:
            raise BadInput(
                f"Semi-finishing allowance (surface.semi_allowance) is {self.semi_allowance:g} mm, more than roughing leaves "
                f"(surface.rough_allowance, {self.rough_allowance:g} mm); choose less, or 0 for no semi-finishing"
            )
        return self

    def height(self) -> float:
        """Return the scallop height in mm that is wanted."""
        return height_of(self.ra) if self.ra > 0.0 else self.scallop
