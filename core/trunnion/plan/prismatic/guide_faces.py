"""A plane drive led by the faces that a person gave its operation: guide lines along these walls alone, and these floors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from trunnion.findings import Refused
from trunnion.geometry.arrays import Bools
from trunnion.plan.plane_guides import GuideSpace
from trunnion.plan.prismatic.drive import PlaneDrive, WallGuide
from trunnion.plan.prismatic.regions import runs


def on_guide_faces(
    drive: PlaneDrive, operation: str, faces: tuple[int, ...], space: GuideSpace
) -> PlaneDrive:
    """Return a drive whose guide lines are on some faces alone; walls that none is on only keep the cutter off their feet. Its floors are
    those among the faces where there are any: an operation on walls alone knows all of them.

    Raises `Refused` where no guide line of the operation is on any of them.
    """
    walls = [(guide, _runs(guide, faces, space)) for guide in drive.walls]
    unled = tuple(guide for guide, parts in walls if not parts)
    led = tuple(part for _, parts in walls for part in parts)
    own_floors = tuple(f for f in drive.floors if f.face in faces)
    if not led and not own_floors:
        raise Refused(
            f"{operation}: no guide line is on its faces any more; give it faces of {drive.feature}, or delete it"
        )
    return replace(
        drive, walls=led, floors=own_floors or drive.floors, beside=(*drive.beside, *unled)
    )


def _runs(guide: WallGuide, faces: tuple[int, ...], space: GuideSpace) -> tuple[WallGuide, ...]:
    """Return the runs of a guide line that are on some faces, the guide itself where all of it is."""
    on = guide.faces_on(space)
    own = np.isin(on, faces)
    # Between faces of their own, elements that no face is known of belong to these.
    kept = own | ((on == 0) & _between(own, on == 0, guide.curve.closed))
    if kept.all():
        return (guide,)
    return tuple(replace(guide, curve=part, run_of=guide.loop) for part in runs(guide.curve, kept))


def _between(own: Bools, unknown: Bools, closed: bool) -> Bools:
    """Return which unknown elements (m,) have none but own ones next to them on both sides, other unknown ones passed over."""
    known = np.flatnonzero(~unknown)
    if not len(known):
        return np.zeros(len(own), dtype=bool)
    after = np.searchsorted(known, np.arange(len(own)))
    if closed:
        before, following = known[after - 1], known[after % len(known)]
    else:
        # Past the ends there is nothing on the other side.
        before, following = (known[np.clip(side, 0, len(known) - 1)] for side in (after - 1, after))
    between: Bools = own[before] & own[following]
    return between
