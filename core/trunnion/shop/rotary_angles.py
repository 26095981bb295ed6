"""Rotary angles along a path: without a leap, inside the limits, turning least; windings and both solutions are looked at."""

from __future__ import annotations

import itertools
import math

import numpy as np

from trunnion.findings import Refused
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.kernels.shortest_paths.rotary_angles_compiled import choose_angles
from trunnion.model.material import Machine
from trunnion.shop.kinematics import POLE, SLACK, WorkPosition, pole_of, rotary_solutions

MOST_TURNS = 3
"""Whole turns, each way, that another beginning is looked for; an axis with so many to spare needs none."""
TURN = 2.0 * math.pi


def followed(
    axis: Floats,
    work_position: WorkPosition,
    start_angle: Floats | None,
    near: float,
    operation: str,
) -> Floats:
    """Return the rotary angles (n, a) in rad at which a machine holds tool axes (n, 3), one after the other.

    They go on from where the axes start_angle (a,) when that can be, else from the beginning that turns least, a head leaned to its
    positive side: with some paths to either side a linear axis would travel twice as far. An axis within `near` rad of the pole may be
    taken for the pole. Raises `Refused`, naming operation and block, for what the machine can't hold or can't reach.
    """
    machine = work_position.machine
    through = _through_pole(axis, machine, near)
    angles, free, held = rotary_solutions(machine, axis)
    lost = np.flatnonzero(~held)
    if len(lost):
        has = f"{' and '.join(a.name for a in machine.rotary)} can't hold"
        raise Refused(
            f"operation {operation}, block {lost[0] + 1}: a tool axis that {machine.title} with {has}; lean it another way or "
            "choose another machine"
        )
    low, high = work_position.limits
    angles_used = np.zeros((len(axis), len(machine.rotary)))
    home = np.zeros(len(machine.rotary)) if start_angle is None else start_angle
    heads = [k for k, rotary in enumerate(machine.rotary) if rotary.carries == "tool"]
    tries: list[tuple[int, bool, float, int, Floats]] = []
    # Spirals wind an axis up turn by turn: when it comes to its end it begins anew near the middle.
    unwound = (
        []
        if start_angle is None
        else _beginnings(angles, free, np.clip(np.zeros(len(home)), low, high), low, high)
    )
    for start in ([] if start_angle is None else [start_angle]) + [
        *_beginnings(angles, free, home, low, high),
        *unwound,
    ]:
        reached, turned = choose_angles(angles, free, through, low, high, SLACK, start, angles_used)
        if (
            reached == len(axis)
            and start is start_angle
            and np.abs(angles_used[:1] - start_angle).max(initial=0.0) <= 2.0 * POLE
        ):
            return angles_used
        tries.append(
            (
                -reached,
                bool((start[heads] < -POLE).any()),
                turned + float(np.abs(start - home).sum()),
                len(tries),
                np.array(angles_used),
            )
        )
    reached, *_, best = min(tries, key=lambda t: t[:4])
    if -reached < len(axis):
        raise Refused(
            f"operation {operation}, block {1 - reached}: {beyond(angles[-reached], work_position)}"
        )
    return best


def _through_pole(axis: Floats, machine: Machine, near: float) -> Bools:
    """Say on the way to which poses (n,) the tool axis comes so near to the pole that it may be taken for going through it."""
    pole = pole_of(machine)
    first, last = np.vstack([axis[:1], axis[:-1]]), axis
    # Seen along the pole an even turn is a piece of an ellipse; where it passes close by it is as good as its chord.
    a, b = (v - np.outer(v @ pole, pole) for v in (first, last))
    run = b - a
    share = np.clip(
        -(a * run).sum(axis=1) / np.maximum((run * run).sum(axis=1), np.finfo(float).tiny), 0.0, 1.0
    )
    return np.asarray(np.linalg.norm(a + share[:, None] * run, axis=1) < 0.5 * near)


def _beginnings(
    angles: Floats, free: Bools, near: Floats, low: Floats, high: Floats
) -> list[Floats]:
    """Return the angles (a,) that a path may begin with: those of its first pose that leaves no axis free, within the limits."""
    fixed = np.flatnonzero(~free[:, 0].any(axis=1))
    if not len(fixed):
        return [np.clip(near, low, high)]
    found = []
    for solution in angles[fixed[0]]:
        least, most = (
            np.ceil((low - SLACK - solution) / TURN),
            np.floor((high + SLACK - solution) / TURN),
        )
        # Some turns about where the axes stand, and those at home when they are wound up to a limit.
        turns = [
            sorted(
                {
                    n + k
                    for n in (np.round((v - w) / TURN), np.round(-w / TURN))
                    for k in range(-MOST_TURNS, MOST_TURNS + 1)
                    if a <= n + k <= b
                }
            )
            for w, v, a, b in zip(solution, near, least, most, strict=True)
        ]
        found += [solution + TURN * np.array(n) for n in itertools.product(*turns)]
    return found or [np.clip(near, low, high)]


def beyond(solutions: Floats, work_position: WorkPosition) -> str:
    """Return the angles that a pose needs and the limits of the axes."""
    near = np.degrees(solutions - TURN * np.round(solutions / TURN))
    ranges = " or ".join(
        " ".join(
            f"{a.name}{v:.1f}" for a, v in zip(work_position.machine.rotary, solution, strict=True)
        )
        for solution in near.tolist()
    )
    has = ", ".join(f"{a.name} {a.low:g} to {a.high:g}" for a in work_position.machine.rotary)
    return f"its tool axis needs {ranges}, which can't be reached from the block before; {work_position.machine.title} has {has}"
