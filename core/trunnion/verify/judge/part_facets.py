"""The part's faces as triangles, as far as a proof needs them: all for tools that lean, else those of faces without a closed form."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.frame import Frame
from trunnion.model.material import Machine
from trunnion.model.motion.program import Program
from trunnion.part.part import Part
from trunnion.part.shape.facets import Facets, facets_of
from trunnion.part.shape.surfaces import Surfaces
from trunnion.progress import Progress
from trunnion.verify.motion import AXIS_LEAN


@dataclass(frozen=True, slots=True, eq=False)
class FacetsFork:
    """The triangles of all faces in a frame, begun before they are asked for; `result` waits for them."""

    frame: Frame
    result: Callable[[Progress], Facets]


def may_lean(machines: Sequence[Machine]) -> bool:
    """Return whether a tool may lean on one of the machines."""
    return any(m.rotary for m in machines)


def part_facets(
    programs: Sequence[Program],
    part: Part,
    frame: Frame,
    surfaces: Sequence[Surfaces],
    machines: Sequence[Machine],
    progress: Progress,
    fork: FacetsFork | None = None,
) -> Facets | None:
    """Return the part's faces as triangles in a frame: all for a tool that leans, or a machine on which one may lean, else those
    without closed form; None when none is."""
    leans = may_lean(machines) or any(
        (np.abs(s.path.axis - [0.0, 0.0, 1.0]) > AXIS_LEAN).any()
        for p in programs
        for s in p.sections
    )
    free = {int(s.tag[row]) for s in surfaces for row in s.free}
    if not leans and not free:
        return None
    if leans and fork is not None:
        return fork.result(progress).moved(fork.frame, frame)
    return facets_of(part, frame, progress=progress, only=None if leans else free)
