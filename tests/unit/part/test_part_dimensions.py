"""Dimensions that a part carries: through bytes, through cuts of faces, and none where a file has none."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

import samples
from shaped_parts import face_towards, plate
from trunnion.geometry.cut import plane_cut
from trunnion.model.dimension import DIAMETER, Dimension
from trunnion.part.cut import divided
from trunnion.part.part import Part, PartMetadata

BORE = Dimension(DIAMETER, 12.0, 0.018, 0.0, "H7", "", "bore A", (2, 5))
TAPPED = Dimension(DIAMETER, 5.0, thread="M6x1", faces=(3,))


def with_dimensions(part: Part, *dimensions: Dimension) -> Part:
    return Part(replace(part.facts, dimensions=dimensions), part.shape, part.as_read)


def test_dimensions_come_through_the_bytes_that_processes_exchange() -> None:
    part = with_dimensions(plate(30.0, 20.0, 5.0), BORE, TAPPED)
    assert Part.from_bytes(part.to_bytes()).dimensions == (BORE, TAPPED)


def test_a_part_of_before_dimensions_were_read_has_none() -> None:
    data = json.loads(plate(30.0, 20.0, 5.0).facts.to_json())
    del data["dimensions"]
    assert PartMetadata.from_json(json.dumps(data)).dimensions == ()


def test_the_pieces_of_a_cut_face_keep_its_size() -> None:
    part = plate(30.0, 20.0, 5.0)
    top = face_towards(part, 0, 0, 1)
    other = next(t for t in part.tags if t != top)
    marked = with_dimensions(part, replace(BORE, faces=(top,)), replace(TAPPED, faces=(other,)))
    cut = divided(marked, plane_cut(top, (10.0, 0.0, 0.0), (1.0, 0.0, 0.0)))
    assert [d.faces for d in cut.dimensions] == [(top, 7), (other,)]


@pytest.mark.parametrize("suffix", ["step", "igs"])
def test_a_file_without_sizes_as_data_has_no_dimensions(suffix: str) -> None:
    assert samples.read(samples.box_shape(), suffix).dimensions == ()
