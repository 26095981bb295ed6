"""Recognition doesn't depend on where a part lies: the same features, faces and sizes wherever it is moved and however it is turned."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from blockparts import BlockPart, terrace
from trunnion.geometry.frame import Frame
from trunnion.model.feature import Recognition
from trunnion.progress import NO_PROGRESS
from trunnion.recognize.panel import PanelFamily
from trunnion.settings import choose

H = 40.0
XS, YS = (0, 10, 40, 43, 80, 90, 120), (0, 10, 30, 45, 60, 70)
HEIGHTS = [[H] * 6, [H, 5, 30, 20, H, 15], [H, 5, 30, 8, H, 15], [H, 5, 30, 20, H, H], [H] * 6]
numbers = st.floats(-1.0, 1.0, allow_nan=False)
vectors = st.tuples(numbers, numbers, numbers).map(np.array)


@st.composite
def frames(draw: st.DrawFn) -> Frame:
    x, z = draw(vectors), draw(vectors)
    if np.linalg.norm(np.cross(x, z)) < 0.1:
        x, z = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
    return Frame(10000.0 * draw(vectors), x, z)


def recognized(part: BlockPart) -> Recognition:
    return PanelFamily().recognize(
        part.graph(), part, choose(PanelFamily.settings, {}), NO_PROGRESS
    )


def summary(found: Recognition) -> list[tuple[object, ...]]:
    return [(f.id, f.faces, sorted(f.attributes)) for f in found.features]


STILL = terrace(XS, YS, HEIGHTS)
AS_DRAWN = recognized(STILL)


@settings(deadline=None, max_examples=15)
@given(frames())
@example(Frame(np.zeros(3), np.array([1.0, 2e-64, 0.0]), np.array([0.0, 0.0, -1.0])))
def test_a_moved_part_has_the_same_features(placed: Frame) -> None:
    still, moved = AS_DRAWN, recognized(BlockPart(STILL.breaks, STILL.full, placed))
    assert summary(moved) == summary(still)
    for a, b in zip(still.features, moved.features, strict=True):
        assert {k: pytest.approx(v, abs=1e-3) for k, v in a.sizes.items()} == dict(b.sizes)


@settings(deadline=None, max_examples=5)
@given(frames())
def test_a_mirrored_part_has_as_many_features_of_the_same_sizes(placed: Frame) -> None:
    mirrored = BlockPart(
        (tuple(120 - x for x in reversed(XS)), *STILL.breaks[1:]), STILL.full[::-1].copy(), placed
    )
    still, turned = AS_DRAWN, recognized(mirrored)
    assert turned.counts() == still.counts()
    for kind in still.counts():
        depths = [
            sorted(float(f.sizes.get("depth", 0.0)) for f in r.of_kind(kind))
            for r in (still, turned)
        ]  # type: ignore[arg-type]
        assert depths[0] == pytest.approx(depths[1], abs=1e-3)


@settings(deadline=None, max_examples=5)
@given(st.floats(0.2, 30.0))
def test_a_scaled_part_has_the_same_features(factor: float) -> None:
    breaks = tuple(tuple(factor * b for b in axis) for axis in STILL.breaks)
    part = BlockPart(breaks, STILL.full)  # type: ignore[arg-type]
    words = choose(
        PanelFamily.settings,
        {"rib_width": 12.0 * factor if factor < 16.0 else 200.0, "hole_diameter": 30.0},
    )
    found = PanelFamily().recognize(part.graph(), part, words, NO_PROGRESS)
    assert summary(found) == summary(AS_DRAWN)
