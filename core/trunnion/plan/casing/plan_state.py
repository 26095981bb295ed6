"""What is known of a casing while its milling is planned, and the operations so far."""

from __future__ import annotations

from dataclasses import dataclass, field

from trunnion.geometry.mesh import Mesh
from trunnion.geometry.plane.region import Region
from trunnion.plan.casing.milling_settings import CasingRouteSettings
from trunnion.plan.casing.regions.settings import RegionSettings
from trunnion.plan.casing.turning_route import TurnedRoute
from trunnion.plan.development.ground import DevelopedGround
from trunnion.plan.setups.state import SetupPlanState


@dataclass(slots=True, kw_only=True)
class CasingPlanState(SetupPlanState):
    """What is known while a casing is planned in a setup.

    `grounds` are the bottoms laid flat, by their pockets, `hosts` of those that are recesses the pocket that each is sunk into, empty where
    that is a profile, `gaps` what of them is turned with interruptions. `turned` is the turning before them, where the blank did not come
    turned.
    """

    mesh: Mesh
    settings: CasingRouteSettings
    regions: RegionSettings
    turned: TurnedRoute | None = None
    grounds: dict[str, DevelopedGround] = field(default_factory=dict)
    gaps: dict[str, Region] = field(default_factory=dict)
    hosts: dict[str, str] = field(default_factory=dict)

    def hosts_of(self, pocket: str) -> list[str]:
        """Return the pockets that a recess is sunk into, the nearest first; none for a bottom that runs round."""
        found = list[str]()
        while self.hosts.get(pocket):
            pocket = self.hosts[pocket]
            found.append(pocket)
        return found
