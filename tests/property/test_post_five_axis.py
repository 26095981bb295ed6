"""Whatever way a leaning tool goes, the text says it: read back, it passes every pose and leaves the way by no more than allowed."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st

from leaning_paths import (
    ENDLESS_FORK,
    HEAD_AND_TABLE,
    HEADER,
    TABLE,
    again,
    path_of,
    program,
    standing,
    text_of,
)
from programs import FLAT_16, S1
from trunnion.findings import BadInput
from trunnion.model.motion.toolpath import Motion
from trunnion.post.dialects.apt import AptDialect
from trunnion.post.dialects.linuxcnc import LinuxCncDialect
from trunnion.post.linearize import even_turn
from trunnion.post.settings import PostSettings

places = st.integers(-600_000, 600_000).map(lambda n: n / 10_000)
leans = st.one_of(st.just(0.0), st.floats(0.0, 80.0), st.floats(0.0, 0.01))
poses = st.tuples(
    places,
    places,
    st.integers(-200_000, 400_000).map(lambda n: n / 10_000),
    leans,
    st.floats(0.0, 360.0),
)
machines = st.sampled_from([TABLE, ENDLESS_FORK, HEAD_AND_TABLE])


@st.composite
def ways(draw):
    """Return a path of poses anywhere, the tool leaning by up to 80 degrees anywhere, the pole among them."""
    stops = []
    for x, y, z, degrees, around in draw(
        st.lists(poses, min_size=2, max_size=5, unique_by=lambda p: p[:3])
    ):
        a, b = math.radians(degrees), math.radians(around)
        stops.append(
            ((x, y, z), (math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)))
        )
    return path_of(*stops, feed=draw(st.floats(10.0, 5000.0)))


def passed_in_order(planned, read, within: float, reach: float) -> bool:
    """Say whether a path read back goes along a planned one: its poses fall on the planned blocks one after the other.

    Blocks shorter than `within` may share a pose; the last one ends all that it is on.
    """
    k = 1
    for tip, axis in zip(read.position, read.axis, strict=True):
        while not on_block(planned, k, tip, axis, within, reach):
            k += 1
            if k == len(planned):
                return False
    tip, axis = read.position[-1], read.axis[-1]
    while k < len(planned) - 1 and on_block(planned, k + 1, tip, axis, within, reach):
        k += 1
    return k == len(planned) - 1


def on_block(planned, k: int, tip, axis, within: float, reach: float) -> bool:
    start, end = planned.position[k - 1], planned.position[k]
    run = float(np.linalg.norm(end - start))
    turn = float(np.linalg.norm(planned.axis[k] - planned.axis[k - 1]))
    if run > 1.0:
        share = np.array([np.clip((tip - start) @ (end - start) / run**2, 0.0, 1.0)])
    else:
        share = np.linspace(0.0, 1.0, 2001)
    axes = even_turn(
        np.tile(planned.axis[k - 1], (len(share), 1)),
        np.tile(planned.axis[k], (len(share), 1)),
        share,
    )
    off = np.linalg.norm(start + share[:, None] * (end - start) - tip, axis=1)
    leans_off = np.linalg.norm(axes - axis, axis=1) * reach
    slack = within * turn * reach / max(run, within) + (turn * reach / 2000 if run <= 1.0 else 0.0)
    return bool(((off <= within) & (leans_off <= within + slack)).any())


def path_upright(*heights: float):
    return path_of(*[((0.0, 0.0, z), (0.0, 0.0, 1.0)) for z in heights])


TO_THE_POLE = path_of(
    ((0.0, 0.0, 0.0), (8.46e-3, 1.526e-2, 1.0)), ((1.0, 0.0, 0.0), (-9.2e-8, -1.48e-7, 1.0))
)
"""It ends with a lean of 1e-5 degrees to the other side."""


@settings(deadline=None, max_examples=25)
@given(ways(), machines)
@example(path_upright(0.0, 1e-4, -1e-4), TABLE)
@example(TO_THE_POLE, TABLE)
@example(TO_THE_POLE, ENDLESS_FORK)
@example(TO_THE_POLE, HEAD_AND_TABLE)
def test_linuxcnc_says_where_a_leaning_tool_goes(path, machine):
    place = standing(machine)
    read = again(text_of(program(path), place, straying=0.01), place).sections[0].path
    first = int(np.argmax(read.motion != Motion.RAPID)) - 1
    last = len(read) - int(np.argmax(read.motion[::-1] != Motion.RAPID))
    assert (read.motion[: first + 1] == Motion.RAPID).all()
    cut = slice(first, last)
    assert np.abs(read.position[first] - path.position[0]).max() <= 3e-4
    assert np.abs(read.position[last - 1] - path.position[-1]).max() <= 3e-4
    assert np.abs(read.axis[last - 1] - path.axis[-1]).max() <= 3e-7
    part = type(read)(
        **{
            name: getattr(read, name)[cut]
            for name in ("position", "axis", "centre", "feed", "mark")
        },
        motion=np.array([Motion.RAPID, *read.motion[cut][1:]]),
    )
    assert passed_in_order(path, part, 0.013, FLAT_16.flute_length)


@settings(deadline=None, max_examples=25)
@given(ways(), machines)
def test_no_block_is_faster_than_its_feed_or_its_axes(path, machine):
    place = standing(machine)
    read = again(text_of(program(path), place, straying=0.01), place).sections[0].path
    assert read.feed.max() <= path.feed.max() + 0.06


@settings(deadline=None, max_examples=30)
@given(ways())
def test_apt_says_tips_and_axes_as_they_are(path):
    (read,) = AptDialect().read(
        AptDialect().write([program(path)], HEADER, PostSettings()), (FLAT_16,), [S1]
    )
    found = read.sections[0].path
    kept = np.concatenate(
        [
            [True],
            (np.abs(np.diff(path.position, axis=0)).max(axis=1) > 1e-4)
            | (np.abs(np.diff(path.axis, axis=0)).max(axis=1) > 2e-9),
        ]
    )
    assert len(found) >= int(kept.sum())
    assert np.abs(found.position[-1] - path.position[-1]).max() <= 1e-4
    assert np.abs(found.axis[-1] - path.axis[-1]).max() <= 2e-9


@settings(deadline=None, max_examples=60)
@given(
    st.lists(
        st.tuples(
            st.floats(0, 1, exclude_max=True), st.sampled_from(list("GMXYZACFN0123456789.- (\n"))
        ),
        min_size=1,
        max_size=5,
    )
)
def test_a_spoiled_text_of_five_axes_is_read_or_refused_in_one_line(spoils):
    place, path = (
        standing(TABLE),
        path_of(((0.0, 0.0, 40.0), (0.0, 0.1, 0.9)), ((5.0, 0.0, 3.0), (0.2, 0.1, 0.9))),
    )
    text = list(LinuxCncDialect().write([program(path)], HEADER, PostSettings(), {"S1": place}))
    for share, letter in spoils:
        text[int(share * len(text))] = letter
    try:
        again("".join(text), place)
    except BadInput as refused:
        assert "\n" not in str(refused)
