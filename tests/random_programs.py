"""Random programs that a three-axis control can run, and a comparison of what two programs do."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import strategies as st

from programs import BULL_10, CCW, CW, FLAT_16, LINE, RAPID, S1, path_of, section
from trunnion.model.motion.cycle import BACK_OFF, PECKING, WAITING, Cycle, CycleKind
from trunnion.model.motion.program import Program
from trunnion.post.writer.turning import in_plane

coordinates = st.integers(-9_999_999, 9_999_999).map(lambda n: n / 10_000)
feeds = st.integers(1, 200_000).map(lambda n: n / 10)
ticks = st.integers(1, 400_000).map(lambda n: n / 10_000)
"""Lengths above 0 with four decimals."""
steps = st.one_of(
    st.tuples(st.just(RAPID), coordinates, coordinates, coordinates),
    st.tuples(st.just(LINE), coordinates, coordinates, coordinates, feeds),
    st.tuples(
        st.sampled_from([CW, CCW]),
        st.integers(10, 2_000_000),
        st.floats(0, 2 * math.pi),
        st.floats(0.0, 2 * math.pi),
        coordinates,
        feeds,
        st.booleans(),
    ),
)


def cycle(kind, depth=7.0, lift=0.0, peck=3.0, dwell=0.5, pitch=1.25):
    """Return a cycle with the numbers that are of its kind."""
    return Cycle(
        kind=kind,
        depth=depth,
        lift=lift,
        peck=peck if kind in PECKING else 0.0,
        dwell=dwell if kind in WAITING else 0.0,
        pitch=pitch if kind is CycleKind.TAP else 0.0,
    )


@st.composite
def cycles(draw):
    """Return a cycle of any kind."""
    depth, kind = draw(ticks), draw(st.sampled_from(CycleKind))
    peck = max(draw(ticks), BACK_OFF + 1e-4, depth / 50)
    lift, dwell, pitch = draw(st.sampled_from([0.0, 3.5])), draw(ticks), draw(ticks)
    return cycle(kind, depth, lift, peck, max(dwell, 0.1), max(pitch, 0.1))


@st.composite
def paths(draw):
    """Return a path whose ends lie on the decimals and whose arcs start and end anywhere, full turns among them."""
    at, blocks = (draw(coordinates), draw(coordinates), 50.0), []
    at = (*at[:2], draw(coordinates))
    blocks += [(RAPID, *at[:2], 50.0), (LINE, *at, draw(feeds))]
    for step in draw(st.lists(steps, min_size=1, max_size=12)):
        if len(step) < 7:
            blocks.append(step)
        else:
            motion, ticks, first, turn, z, feed, full = step
            radius, sign = ticks / 10_000, 1.0 if motion == CCW else -1.0
            centre = (at[0] - radius * math.cos(first), at[1] - radius * math.sin(first))
            end = (
                at[:2]
                if full
                else tuple(
                    centre[n] + radius * f(first + sign * turn)
                    for n, f in enumerate((math.cos, math.sin))
                )
            )
            blocks.append((motion, *end, z, *centre, feed))
        at = blocks[-1][1:4]
    return path_of(*blocks, (RAPID, at[0], at[1], 50.0))


operations = st.tuples(
    paths(),
    st.sampled_from([FLAT_16, BULL_10]),
    st.integers(1, 40_000),
    st.sampled_from(["flood", "mist", "off"]),
)
programs = st.lists(operations, min_size=1, max_size=3)
spoils = st.lists(
    st.tuples(
        st.floats(0, 1, exclude_max=True),
        st.sampled_from(list("GMXYZIJRFSTHPN0123456789.-+ ()/,;%$#[]\n\x00éKE")),
    ),
    min_size=1,
    max_size=6,
)
"""Places in a text, as shares of it, and what comes there instead."""


def program_of(parts, setup=S1) -> Program:
    """Return the program of a setup whose operations were drawn from `programs`."""
    return Program(
        name=f"B1.{setup.name}",
        setup=setup,
        sections=tuple(
            section(f"op-{n}", tool, path, float(spindle), coolant)
            for n, (path, tool, spindle, coolant) in enumerate(parts)
        ),
    )


def track(path) -> np.ndarray:
    """Return points along a path (n, 3): ends, and places within its arcs."""
    points = []
    path = in_plane(path) if path.work_turns else path
    for row, (start, sweep) in enumerate(zip(path.starts(), path.sweeps(), strict=True)):
        if sweep:
            x, y = start[:2] - path.centre[row, :2]
            for share in (0.25, 0.5, 0.75):
                c, s = math.cos(share * sweep), math.sin(share * sweep)
                points.append(
                    (
                        path.centre[row, 0] + c * x - s * y,
                        path.centre[row, 1] + s * x + c * y,
                        start[2] + share * (path.position[row, 2] - start[2]),
                    )
                )
        points.append(tuple(path.position[row]))
    return np.array(points)


def farthest(points: np.ndarray, line: np.ndarray) -> float:
    """Return how far the points (n, 3) lie from a polyline (m, 3) at most."""
    start, run = line[None, :-1], np.diff(line, axis=0)[None]
    share = np.clip(
        ((points[:, None] - start) * run).sum(axis=2) / np.maximum((run * run).sum(axis=2), 1e-30),
        0.0,
        1.0,
    )
    return float(
        np.linalg.norm(points[:, None] - start - share[..., None] * run, axis=2).min(axis=1).max()
    )


def same(first: Program, second: Program, within: float) -> None:
    """Compare what two programs do; blocks that rounding made vanish or made lines may differ, where the tool goes may not."""
    assert [s.operation for s in first.sections] == [s.operation for s in second.sections]
    for a, b in zip(first.sections, second.sections, strict=True):
        assert a.tool == b.tool
        one, other = track(a.path), track(b.path)
        assert max(farthest(one, other), farthest(other, one)) <= within
        if len(a.path) == len(b.path):
            assert np.abs(a.path.position - b.path.position).max() <= within
            cutting = a.path.motion != RAPID
            assert (
                not cutting.any() or np.abs(a.path.feed - b.path.feed)[cutting].max() <= 0.05 + 1e-9
            )
