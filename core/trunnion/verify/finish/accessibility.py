"""Accessibility: the points of the part that some cutter of the catalogue reaches, upright from above or tilted on rotary axes.

A position that nothing reaches is settled only when every pose of every cutter is stopped. What stopped one stops most of the others, so
each position remembers its obstacles (`contact/obstacles.py`), and few poses are held against the whole part.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.material import Machine
from trunnion.model.tool import PLAIN_FORMS, Tool
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.verify.contact import Obstacles, PartContact
from trunnion.verify.finish.coverage import Samples
from trunnion.verify.finish.tilted_poses import leaning_axes, touching_tips
from trunnion.verify.machine.kinematics import UP, can_hold

MOST_TRIED = 3000
"""Samples that every cutter is tried on: some seconds where none reaches."""
MOST_LEANING = 200
"""The same for leaning cutters, which are tried in many more poses."""
AROUND = 8
"""Directions in which a flat end stands aside from a position on a level face."""
ASIDE = (1.0, 0.5)
"""Shares of its flat end's radius by which it does."""


class Accessibility:
    """Finds collision-free poses of catalogue cutters that touch a point of the part: upright ones from above, and leaning ones where the
    machine has rotary axes (contact then needs facets). Contact must be without fixtures. Works on `threads` threads (0: one a core)."""

    def __init__(
        self,
        contact: PartContact,
        tools: Sequence[Tool],
        allowed: float,
        machine: Machine | None = None,
        threads: int = 0,
    ) -> None:
        self._contact, self._allowed, self._machine, self._threads = (
            contact,
            allowed,
            machine,
            threads,
        )
        # Upright and from above, no other form goes where none of these fits. Slender cutters reach what any reach: the order is for speed.
        plain = [t for t in tools if t.form in PLAIN_FORMS]
        self._tools = sorted(reaching_furthest(plain), key=lambda t: (t.radius, -t.reach, t.number))

    def reached(self, samples: Samples, rows: Ints, progress: Progress = NO_PROGRESS) -> Bools:
        """Return for each of the samples' rows whether some cutter reaches it.

        Of very many rows, evenly chosen ones of every face are tried, and the others share the result of the nearest on their face.
        """
        machine = self._machine
        if machine is None or not machine.rotary:
            return _shared(self._try, samples, rows, MOST_TRIED, progress)
        found = _shared(self._try, samples, rows, MOST_TRIED, progress.part(0.0, 0.5))
        found[~found] = _shared(
            partial(self._try_leaning, machine),
            samples,
            rows[~found],
            MOST_LEANING,
            progress.part(0.5, 1.0),
        )
        return found

    def _try(self, samples: Samples, rows: Ints, progress: Progress) -> Bools:
        return self._first_clear(
            len(rows),
            partial(upright_poses, samples.point[rows], samples.normal[rows]),
            progress,
            "Looking for cutters that reach what is left",
        )

    def _try_leaning(
        self, machine: Machine, samples: Samples, rows: Ints, progress: Progress
    ) -> Bools:
        point, normal = samples.point[rows], samples.normal[rows]
        axes = np.stack(list(progress.each(leaning_axes(normal))), axis=1)
        holds = progress.aside(lambda _: can_hold(axes.reshape(-1, 3), machine)).reshape(
            axes.shape[:2]
        )
        return self._first_clear(
            len(rows),
            partial(leaning_poses, point, normal, axes, holds),
            progress,
            "Looking for leaning cutters that reach what is left",
        )

    def _first_clear(
        self,
        k: int,
        poses: Callable[[Tool, Ints], tuple[Floats, Floats, Bools]],
        progress: Progress,
        text: str,
    ) -> Bools:
        """Return for each of k positions whether some tool has a clear pose there; `poses` gives a tool's at some rows of them."""
        found, obstacles = np.zeros(k, bool), Obstacles.none(k)
        for n, tool in enumerate(self._tools):
            share = progress.part(n / len(self._tools), (n + 1) / len(self._tools))
            share.at(0.0, text)
            rows = np.flatnonzero(~found)
            if not len(rows):
                break
            tips, axes, possible = _query_poses(poses, tool, rows, share)
            known = obstacles.of(rows)
            found[rows] = self._contact.any_clear(
                tool, tips, axes, possible, self._allowed, known, share, text, self._threads
            )
            obstacles.put(rows, known)
        return found


def _query_poses(
    poses: Callable[[Tool, Ints], tuple[Floats, Floats, Bools]],
    tool: Tool,
    rows: Ints,
    progress: Progress,
) -> tuple[Floats, Floats, Bools]:
    return progress.aside(lambda _: poses(tool, rows))


def upright_poses(
    point: Floats, normal: Floats, tool: Tool, rows: Ints
) -> tuple[Floats, Floats, Bools]:
    """Return tips and axes (k, a, 3) of an upright cutter that touches some rows (k,) of points from above, and which make sense (k, a).

    The first touches along the normal with the corner (or the flank, where the face is upright), two with the flank higher up, the others
    stand on a level face with the point anywhere under the cutter's flat end.
    """
    point, normal = point[rows], normal[rows]
    level = normal[:, 2] > np.cos(tolerance.ANGLE)
    upright = np.abs(normal[:, 2]) < np.sin(tolerance.ANGLE)
    plan = np.hypot(normal[:, 0], normal[:, 1])
    out = np.divide(
        normal[:, :2], plan[:, None], out=np.zeros_like(normal[:, :2]), where=plan[:, None] > 0.0
    )
    inner, corner = tool.radius - tool.corner_radius, tool.corner_radius
    n = 3 + (len(ASIDE) * AROUND if inner > 0.0 and level.any() else 0)
    tips, possible = np.repeat(point[:, None], n, axis=1), np.zeros((len(point), n), bool)
    touching = point + corner * normal
    touching[:, :2] += np.where(level[:, None], 0.0, inner * out)
    touching[:, 2] -= corner
    for up in range(3):
        tips[:, up] = touching
        tips[:, up, 2] -= up * 0.5 * (tool.flute_length - corner) * upright
        possible[:, up] = (normal[:, 2] > -np.sin(tolerance.ANGLE)) & (upright | (up == 0))
    for k in range(3, n):
        ring, turn = divmod(k - 3, AROUND)
        angle = 2 * np.pi * turn / AROUND
        tips[:, k, :2] += ASIDE[ring] * inner * np.array([np.cos(angle), np.sin(angle)])
        possible[:, k] = level
    return tips, np.broadcast_to(UP, tips.shape), possible


def leaning_poses(
    point: Floats, normal: Floats, axes: Floats, holds: Bools, tool: Tool, rows: Ints
) -> tuple[Floats, Floats, Bools]:
    """Return tips and axes (k, a, 3) of a cutter that touches some rows (k,) of points with their axes (all, a, 3), and which make sense
    (k, a): those that the machine holds (all, a) and that are outside the face."""
    own, n = axes[rows], axes.shape[1]
    tips, possible = touching_tips(
        tool,
        np.repeat(point[rows], n, axis=0),
        np.repeat(normal[rows], n, axis=0),
        own.reshape(-1, 3),
    )
    return tips.reshape(own.shape), own, possible.reshape(own.shape[:2]) & holds[rows]


def _shared(
    query: Callable[[Samples, Ints, Progress], Bools],
    samples: Samples,
    rows: Ints,
    most: int,
    progress: Progress,
) -> Bools:
    """Return what is answered for rows, of very many only for evenly chosen ones: the others share the nearest answer on their face."""
    tried = _tried(samples.face[rows], most)
    result = query(samples, rows[tried], progress)
    if len(tried) == len(rows):
        return result
    # Faces are distinguished by a fourth coordinate longer than any part.
    position = np.column_stack(
        [samples.point[rows], samples.face[rows] * 4.0 * np.ptp(samples.point)]
    )
    return np.asarray(result[progress.aside(lambda _: cKDTree(position[tried]).query(position)[1])])


def reaching_furthest(tools: Sequence[Tool]) -> list[Tool]:
    """Return the tools without those that another one of the same form outreaches: as long flutes, as far to anything thicker, as far to
    the holder."""
    best: dict[tuple[float, float], list[Tool]] = {}
    for tool in tools:
        alike = best.setdefault((tool.radius, tool.corner_radius), [])
        if not any(_outreaches(other, tool) for other in alike):
            alike[:] = [other for other in alike if not _outreaches(tool, other)] + [tool]
    return [tool for alike in best.values() for tool in alike]


def _outreaches(one: Tool, other: Tool) -> bool:
    return (
        one.flute_length >= other.flute_length
        and one.reach >= other.reach
        and one.stickout >= other.stickout
    )


def _tried(face: Ints, most: int) -> Ints:
    """Return which rows are tried: all, or evenly chosen ones of every face when there are more than `most`."""
    step = -(-len(face) // most)
    order = np.argsort(face, kind="stable")
    first = np.flatnonzero(np.diff(face[order], prepend=-1))
    within = np.arange(len(face)) - np.repeat(first, np.diff(first, append=len(face)))
    return np.sort(order[within % step == 0]) if step > 1 else np.arange(len(face))
