"""Pictures of a report: nothing of the part is cut off."""

from __future__ import annotations

import cadquery as cq
import numpy as np
import pytest
import pyvista

from samples import written
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
