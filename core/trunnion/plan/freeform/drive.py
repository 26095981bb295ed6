"""What a surface strategy is driven by: the faces to finish, the skin of the whole part, and the direction the tool comes from.

Everything here lies in the CUTTING FRAME: its z is the direction that the tool comes from. For most operations that is the setup's own
frame; an indexed one (3 + 2 axes) has a frame that is tilted in the setup's. Strategies never know the difference: their paths are
turned into the setup's frame afterwards (`pipeline.making`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from trunnion.findings import Finding
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.frame import Frame
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceQuery, LeaningCutQuery, RemainingStockQuery


class ExactFace(Protocol):
    """One trimmed face with its exact surface (`part.exact.ExactFace`), in the cutting frame."""

    tag: int

    def bounds(self) -> tuple[float, float, float, float]:
        """Return the least and greatest u and v."""

    def inside(self, uv: Floats) -> Bools:
        """Return which uv (k, 2) lie inside the trim."""

    def at(self, uv: Floats) -> ExactPoints:
        """Return the surface at uv (k, 2)."""


class ExactPoints(Protocol):
    """Points of a face."""

    @property
    def point(self) -> Floats:
        """Points (k, 3) mm."""

    @property
    def normal(self) -> Floats:
        """Outward unit normals (k, 3)."""

    @property
    def du(self) -> Floats:
        """Derivatives (k, 3) of the points by u."""

    @property
    def dv(self) -> Floats:
        """Derivatives (k, 3) of the points by v."""

    @property
    def normal_du(self) -> Floats:
        """Derivatives (k, 3) of the normals by u."""

    @property
    def normal_dv(self) -> Floats:
        """Derivatives (k, 3) of the normals by v."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SurfaceDrive:
    """All that a surface strategy needs to know of the geometry, in the cutting frame.

    `faces`: tags to be finished; `exact` their exact surfaces in the same order; `skin`: the whole part, with the setup's
    fixtures as triangles of no face. `low`, `high` (3,): the box of the
    blank. `frame`: the cutting frame in the part's coordinates. `allowance`: mm left on the faces on purpose; `height`: the scallop height
    in mm that is wanted. `clearance`: the height in the cutting frame above everything. `digest` identifies all of this. `query_for`
    returns a tool's clearance query: which poses are clear of part and fixtures and within the machine's rotary limits
    (`pipeline.planning.clearance`); None where no tool may lean. `remaining_stock` is the material that stands, None where nobody knows;
    `leaning_cuts` what leaning tools have cut for the feature before, where a strategy asks for it. `findings` say what fixtures keep the
    cutter from. Passes run on past free rims by the `extension` in mm.
    """

    feature: str
    kind: str
    faces: tuple[int, ...]
    exact: tuple[ExactFace, ...]
    skin: Skin
    frame: Frame
    low: Floats
    high: Floats
    clearance: float
    allowance: float
    height: float
    digest: str
    earlier: Tool | None = None
    query_for: Callable[[Tool], ClearanceQuery] | None = None
    remaining_stock: RemainingStockQuery | None = None
    leaning_cuts: tuple[LeaningCutQuery, ...] = ()
    findings: tuple[Finding, ...] = ()
    extension: float = 0.0

    @property
    def is_empty(self) -> bool:
        """Whether earlier cutters left nothing of the faces, or fixtures keep the cutter from them; else they are finished whatever is
        over them."""
        return not self.faces
