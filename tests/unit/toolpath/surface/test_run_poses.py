"""A leaning cutter along runs of axes: many runs followed together come out as each one alone, no block off by more than it may be."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from own_shop import own_shop
from trunnion.tolerance import PARAMETRIC
from trunnion.toolpath.contact_passes.axis_search import FreeAxes
from trunnion.toolpath.contact_passes.contacts import Contacts
from trunnion.toolpath.contact_passes.run_poses import AxisRuns, poses_along

TOOLS = {form: next(t for t in own_shop().tools if t.form == form) for form in ("ball", "bull")}
CHORD = 0.002


def wave(rng: np.random.Generator) -> Contacts:
    """A line of contacts that climbs and falls about a cylinder of radius 20."""
    turn = np.linspace(0.0, rng.uniform(0.2, 1.5), int(rng.integers(2, 60)))
    out = np.column_stack([np.cos(turn), np.sin(turn), 0.0 * turn])
    height = rng.uniform(-5.0, 5.0) + 2.0 * np.sin(3.0 * turn)
    return Contacts(point=20.0 * out + height[:, None] * [0.0, 0.0, 1.0], normal=out)


def run_on(contacts: Contacts, rng: np.random.Generator) -> FreeAxes:
    """A run on some of a line: its axes lean upwards and sway."""
    low, high = np.sort(rng.uniform(0.0, len(contacts) - 1.0, 2))
    count = int(rng.integers(2, 30))
    row = np.linspace(low, max(high, low + 0.1), count)
    row = np.minimum(row, len(contacts) - 1.0) if high > low + 0.1 else row * 0.9
    sway = rng.uniform(-0.3, 0.3) + 0.2 * np.sin(np.arange(count) / 5.0)
    axis = np.column_stack([np.cos(0.5 + sway), np.sin(0.5 + sway), np.full(count, 0.6)])
    return FreeAxes(
        position=row,
        axis=axis / np.linalg.norm(axis, axis=1)[:, None],
        free=np.ones(count, bool),
        leap=np.zeros(count, bool),
    )


def runs_of(seed: int, count: int) -> list[tuple[Contacts, FreeAxes]]:
    """Runs on some lines, now and then two on one."""
    rng = np.random.default_rng(seed)
    lines = [wave(rng) for _ in range(max(1, count // 2))]
    return [(line, run_on(line, rng)) for line in (lines[k % len(lines)] for k in range(count))]


@settings(deadline=None)
@given(st.integers(0, 10_000), st.integers(1, 6), st.sampled_from(sorted(TOOLS)))
def test_runs_together_come_out_as_each_one_alone(seed, count, form) -> None:
    runs = runs_of(seed, count)
    together = poses_along(AxisRuns.of(runs, TOOLS[form], 0.1), CHORD)
    assert (np.diff(together.run) >= 0).all() and set(together.run) == set(range(count))
    for k, run in enumerate(runs):
        alone = poses_along(AxisRuns.of([run], TOOLS[form], 0.1), CHORD)
        rows = together.run == k
        assert np.array_equal(together.position[rows], alone.position)
        for name in ("tip", "axis", "normal"):
            found, expected = getattr(together.poses, name)[rows], getattr(alone.poses, name)
            assert found == pytest.approx(expected, abs=1e-12)


@settings(deadline=None)
@given(st.integers(0, 10_000), st.integers(1, 6), st.sampled_from(sorted(TOOLS)))
def test_every_block_is_within_what_it_may_be_off(seed, count, form) -> None:
    joined = AxisRuns.of(runs_of(seed, count), TOOLS[form])
    made = poses_along(joined, CHORD)
    blocks = made.blocks()
    assert len(blocks) == len(made.position) - count
    assert made.off(blocks, joined.inner(), CHORD).max() <= 1.0
    # Each run is followed from its first axis to its last.
    for k, (_, run) in enumerate(zip(joined.first, joined.start[:-1], strict=True)):
        at = made.position[made.run == k]
        end = joined.start[k + 1] - 1
        assert at[0] == joined.axis_position[run] and at[-1] == joined.axis_position[end]
        assert (np.diff(at) > 0.0).all()


@given(st.integers(0, 10_000), st.integers(1, 6))
@settings(deadline=None, max_examples=30)
def test_axes_within_blocks_are_those_between_their_ends(seed, count) -> None:
    joined = AxisRuns.of(runs_of(seed, count), TOOLS["ball"])
    made = poses_along(joined, CHORD)
    blocks = made.blocks()[::2]
    run, position = made.axes_within(blocks)
    expected = [
        (number, at)
        for block in blocks.tolist()
        for number in [int(made.run[block])]
        for at in joined.axis_position[joined.start[number] : joined.start[number + 1]].tolist()
        if made.position[block] + PARAMETRIC < at < made.position[block + 1] - PARAMETRIC
    ]
    assert list(zip(run.tolist(), position.tolist(), strict=True)) == expected
    more = made.with_positions(run, position)
    assert len(more.position) == len(made.position) + len(run)
    assert (np.diff(joined.order(more.run, more.position)) > 0.0).all()
