"""The skin of a part of too many triangles is coarser, and one that is still too fine is refused in one line."""

from __future__ import annotations

import pytest

from samples import ball_shape, read
from trunnion import tolerance
from trunnion.findings import OutOfMemory
from trunnion.part.shape import refine_mesh
from trunnion.pipeline.context import COARSER, Context
from trunnion.shop import load_shop


def test_a_part_of_too_many_triangles_is_taken_coarser(monkeypatch) -> None:
    part, shop = read(ball_shape()), load_shop(None)
    fine, coarse = (len(Context(part, shop).skin(c).triangles) for c in (0.01, COARSER * 0.01))
    assert coarse < 0.5 * fine
    monkeypatch.setattr(refine_mesh, "MOST_TRIANGLES", (fine + coarse) // 2)
    context = Context(part, shop)
    skin = context.skin(0.01)
    assert len(skin.triangles) == coarse and context.skin(0.01) is skin
    monkeypatch.setattr(refine_mesh, "MOST_TRIANGLES", coarse // 2)
    with pytest.raises(OutOfMemory, match="needs more than"):
        Context(part, shop).skin(0.01)


def test_a_coarser_skin_is_fine_enough_for_finishing() -> None:
    assert COARSER * tolerance.SKIN_CHORD <= 0.1 * tolerance.GOUGE
