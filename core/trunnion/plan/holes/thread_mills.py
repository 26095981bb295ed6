"""Which thread mills cut the threads of bores, when they take the place of taps, and along which helices.

A helix begins at the thread's lower end and rises by a pitch a turn, anticlockwise: a right-hand thread, in climb milling. The middles
of the teeth go from half a pitch below the full thread to half a pitch over it, so that grooves are whole at every angle between. A comb
with n teeth cuts n pitches of the groove in one turn; where the thread is longer, it goes n pitches up and turns again, in step with the
groove.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from trunnion import tolerance
from trunnion.model.tool import Tool
from trunnion.model.tool.thread_mill import (
    FLANK_ANGLE,
    cuts_pitch,
    extra_depth,
    lowest_tooth,
    teeth_along,
)
from trunnion.plan.holes.drive import MILL_THREAD, TAP
from trunnion.plan.holes.finish_tools import BoreFinish
from trunnion.plan.holes.hole import HoleShape, HoleThread, PlannedHole
from trunnion.plan.holes.settings import ALWAYS, HoleSettings, ThreadMillSettings
from trunnion.plan.holes.tools import HoleSpace, either
from trunnion.plan.tool_choice import Candidates
from trunnion.units import trimmed

USE = "thread_mill"
"""Use of thread mills in the catalogue."""
ENTRY = 0.1
"""mm all round that a thread mill is thinner than the bore that it goes into along the axis."""
LEAD_RISE = 0.25
"""Pitches that a lead rises: on a half circle from the bore's axis to the helix the direction from the axis to the tool turns by a quarter
turn, in proportion to the way, so that teeth stay in the groove."""
WIDENED = 0.5
"""Of the tolerance of a thread's pitch diameter: what milling may widen it by at most."""
GRADE_6 = 90e-3
"""mm: factor of the tolerance of the pitch diameter of external threads of grade 6, Td2 = 90 P^0.4 d^0.1 in µm (ISO 965-1)."""
INTERNAL = 1.32
"""Tolerance of the pitch diameter of internal threads over that of external ones of the same grade (ISO 965-1)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ThreadHelix:
    """How a thread mill's tip goes: `turns` turns of a `pitch` each about the hole's axis at a `radius` mm; the first one begins at the
    height `start`, each next one `step` mm over where the one before began. Below and above each is a lead from and to the axis."""

    radius: float
    pitch: float
    start: float
    step: float
    turns: int

    @property
    def lowest(self) -> float:
        """The lowest height of the tip, where the first lead begins."""
        return self.start - LEAD_RISE * self.pitch

    @property
    def highest(self) -> float:
        """The highest height of the tip, where the last lead ends."""
        return self.start + (self.turns - 1) * self.step + (1.0 + LEAD_RISE) * self.pitch


def helix_of(
    hole: PlannedHole, thread: HoleThread, tool: Tool, settings: ThreadMillSettings
) -> ThreadHelix:
    """Return the helix that mills a bore's thread from its lower end, as deep as it may be where no depth is demanded, to its beginning."""
    pitch, teeth = thread.pitch, teeth_along(tool)
    under = 0.5 * pitch + lowest_tooth(tool)
    if thread.depth > 0.0:
        start = hole.top - thread.depth - under
    else:
        start = hole.bottom - under
    if not hole.through:
        least = hole.bottom + settings.bottom_distance + LEAD_RISE * pitch
        start = max(start, least)
    full = hole.top - (start + under)
    turns = max(math.ceil((full + pitch) / (teeth * pitch) - tolerance.PARAMETRIC), 1)
    return ThreadHelix(
        radius=0.5 * thread.diameter + extra_depth(tool, pitch) - tool.radius,
        pitch=pitch,
        start=start,
        step=teeth * pitch,
        turns=turns,
    )


def full_depth(hole: PlannedHole, helix: ThreadHelix, tool: Tool) -> float:
    """Return how deep the thread is full below where the bore begins, mm."""
    return hole.top - max(helix.start + lowest_tooth(tool) + 0.5 * helix.pitch, hole.bottom)


def widening(tool: Tool, thread: HoleThread) -> float:
    """Return by how much in mm a thread mill widens the pitch diameter of a thread.

    A tooth lies in a plane across the axis, the groove that it cuts does not: beside where the tooth is deepest the groove has gone on by
    P theta / (2 pi) with the angle theta about the bore's axis, and the tooth's radius cuts into its flank there. With e the radius of the
    helix, r the tool's and R = e + r the thread's, the flank loses up to P^2 r / (8 pi^2 tan 30 e R) along the axis: the largest over phi,
    the angle about the tool, of P theta / (2 pi) - tan 30 e r phi^2 / (2 R) with theta = r phi / R.
    """
    out = 0.5 * thread.diameter + extra_depth(tool, thread.pitch)
    orbit, slope = out - tool.radius, math.tan(FLANK_ANGLE)
    if orbit <= 0.0:
        return math.inf
    flank = thread.pitch**2 * tool.radius / (8.0 * math.pi**2 * slope * orbit * out)
    return 2.0 * flank / slope


def pitch_tolerance(thread: HoleThread) -> float:
    """Return the tolerance TD2 in mm of a thread's pitch diameter in grade 6 (ISO 965-1, before it is rounded)."""
    return float(INTERNAL * GRADE_6 * thread.pitch**0.4 * thread.diameter**0.1)


def mills_thread(tool: Tool, hole: PlannedHole, thread: HoleThread) -> bool:
    """Return whether a tool is a thread mill that cuts a thread's pitch and gets into its bore."""
    fits = tool.diameter + 2.0 * ENTRY <= hole.diameter + tolerance.COINCIDENT
    return fits and cuts_pitch(tool, thread.pitch)


def thread_mills_for(
    hole: PlannedHole,
    thread: HoleThread,
    tools: Sequence[Tool],
    around: HoleSpace,
    settings: ThreadMillSettings,
) -> Candidates:
    """Return the thread mills that cut a bore's thread, those first that take the fewest turns, the thickest of them; each test that leaves
    none says what would be needed."""
    size = f"D {trimmed(thread.diameter, 3)} with a pitch of {trimmed(thread.pitch, 4)} mm"
    same = [t for t in tools if mills_thread(t, hole, thread)]
    true = [t for t in same if widening(t, thread) <= WIDENED * pitch_tolerance(thread)]
    if not true:
        return Candidates(
            tools=(),
            reason=f"the catalogue has no thread mill for {size}"
            + (" that is thin enough to keep its flanks" if same else ""),
            remedy="add one to the tools folder",
        )
    helices = {t.name: helix_of(hole, thread, t, settings) for t in true}
    deep = [
        t
        for t in true
        if full_depth(hole, helices[t.name], t) >= thread.depth - tolerance.SEW
        and full_depth(hole, helices[t.name], t) > 0.0
    ]
    if not deep:
        most = max(full_depth(hole, helices[t.name], t) for t in true)
        return Candidates(
            tools=(),
            reason=f"its bore is too short for a thread mill: {trimmed(max(most, 0.0), 2)} mm of it get full threads of {size}",
            remedy="drill deeper by changing the part, or demand a shorter thread",
        )
    if not around.is_free(hole, hole.top + tolerance.OFF_PLANE, 0.5 * thread.diameter):
        return Candidates(
            tools=(),
            reason=f"what stands over its bore is nearer than half of {size}: the teeth of a thread mill would cut it",
            remedy="tap it by hand, or widen what stands over the bore by changing the part",
            hindered=True,
        )
    free = [
        t for t in deep if around.has_space(hole, t, helices[t.name].lowest, helices[t.name].radius)
    ]
    if not free:
        return Candidates(
            tools=(),
            reason=f"shank or holder of every thread mill for {size} would come too near to the hole or what stands around it",
            remedy="add a longer thread mill to the tools folder",
            hindered=True,
        )
    order = sorted(free, key=lambda t: (helices[t.name].turns, -t.diameter, t.stickout, t.name))
    return Candidates(tools=tuple(order))


def threaded(
    finish: BoreFinish | None,
    shape: HoleShape,
    tools_of: Callable[[str], Sequence[Tool]],
    around: HoleSpace,
    settings: HoleSettings,
    milling: ThreadMillSettings,
) -> BoreFinish | None:
    """Return what comes after a bore with its thread milled in the place of tapped, where no tap serves or a person wants it so.

    Where neither a tap nor a thread mill serves, both reasons are told.
    """
    if finish is None or finish.kind != TAP or shape.thread is None:
        return finish
    always = settings.thread_milling == ALWAYS
    if finish.found.tools and not always:
        return finish
    found = thread_mills_for(shape.narrow, shape.thread, tools_of(USE), around, milling)
    if found.tools or always:
        return replace(finish, kind=MILL_THREAD, found=found)
    return replace(finish, found=either(finish.found, found))
