"""A setup: how the part lies on the machine, and where its program's zero is."""

from __future__ import annotations

from dataclasses import dataclass

from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank
from trunnion.model.fixture import Fixture
from trunnion.model.keep_out import KeepOutBox
from trunnion.settings import added


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Setup:
    """One clamping.

    `frame` is the work offset's frame in the part's coordinates (z towards the spindle): toolpath positions are in it.
    `clearance` is the height in that frame above everything; `machine` a catalogue name; `work_offset` a word (`G54`); `fixtures` what
    holds the part in it, which the proof lets nothing touch; `blank` what it begins with where setups before it have turned that (None: the
    plan's blank). While an operation is laid, `avoid` has the boxes, in the frame, that
    its tip keeps out of.
    """

    name: str
    frame: Frame
    work_offset: str
    clearance: float
    machine: str
    fixtures: tuple[Fixture, ...] = ()
    avoid: tuple[KeepOutBox, ...] = added((), written=False)
    blank: Blank | None = added(None, written=False)

    def begins_with(self, blank: Blank) -> Blank:
        """Return what the setup begins with, of a plan that begins with a blank."""
        return self.blank if self.blank is not None else blank

    def top(self, blank: Blank) -> float:
        """Return how high blank and fixtures stand, in the setup's frame."""
        own = (self.frame.to_local(f.mesh.points)[:, 2].max() for f in self.fixtures)
        return float(max([self.begins_with(blank).box_in(self.frame)[1][2], *own]))
