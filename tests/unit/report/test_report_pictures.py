"""Pictures of a report: nothing of the part is cut off, and nothing hides what matters."""

from __future__ import annotations

from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest
import pyvista

from samples import two_pockets_and_a_rib_shape, written
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.pipeline import Engine
from trunnion.report.palette import load_palette
from trunnion.report.pictures import write_pictures


@pytest.mark.parametrize("sizes", [(30.0, 90.0, 20.0), (90.0, 30.0, 20.0), (20.0, 20.0, 90.0)])
def test_the_whole_part_is_in_the_picture(sizes, tmp_path):
    engine = Engine()
    session = engine.open(written(cq.Workplane("XY").box(*sizes).val().wrapped))
    session = engine.run(engine.with_choices(session, {"recognize.family": "surface"}), "recognize")
    picture = write_pictures(session, engine.mesh(session), tmp_path, "bar", load_palette())[0]
    image = pyvista.read(tmp_path / picture.file)
    width, height, _ = image.dimensions
    pixels = np.reshape(image.active_scalars, (height, width, -1))[..., :3]
    rows, columns = np.nonzero((pixels < 200).any(axis=-1))
    assert rows.min() > 0 and rows.max() < height - 1
    assert columns.min() > 0 and columns.max() < width - 1


def with_rapids(path, count):
    """Return a path with so many rapids more, to and fro over all that it cuts."""
    low, high = path.position.min(axis=0), path.position.max(axis=0)
    low[2], high[2] = high[2], high[2] + 10.0
    random = np.random.default_rng(3).uniform(low, high, (count, 3))
    more = {
        "position": random,
        "axis": np.tile([0.0, 0.0, 1.0], (count, 1)),
        "motion": np.full(count, Motion.RAPID),
        "centre": np.full((count, 3), np.nan),
        "feed": np.zeros(count),
        "mark": np.zeros(count, dtype=path.mark.dtype),
    }
    return Toolpath(
        **{name: np.concatenate([getattr(path, name), new]) for name, new in more.items()}
    )


def test_thousands_of_rapids_do_not_hide_what_is_cut(tmp_path):
    engine, palette = Engine(), load_palette()
    session = engine.run(engine.open(written(two_pockets_and_a_rib_shape())), "toolpath")
    path = with_rapids(session.paths[0].path, 8000)
    session = replace(session, paths=(replace(session.paths[0], path=path), *session.paths[1:]))
    _, picture = write_pictures(session, engine.mesh(session), tmp_path, "p", palette)
    image = pyvista.read(tmp_path / picture.file)
    width, height, _ = image.dimensions
    # Beside the legend; drawn solid the rapids are a fifth of it.
    pixels = np.reshape(image.active_scalars, (height, width, -1))[:, width // 6 :, :3]
    off = pixels.astype(float) - np.array(palette.motion("rapid"))
    assert (np.linalg.norm(off, axis=-1) < 60.0).mean() < 0.01
