"""The sides that a part is machined from: its faces and fixtures in the frame of each setup, ready for contact."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.frame import Frame
from trunnion.model.fixture import Fixture
from trunnion.part.shape.facets import Facets
from trunnion.part.shape.surfaces import Surfaces
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.verify.contact import PartContact

FIXTURE_BOUND = 0.02
"""mm: how far a fixture's triangles may be from its faces."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Side:
    """A side: its frame, the part's contact in it, with fixtures and without."""

    frame: Frame
    contact: PartContact
    part: PartContact


def sides_of(
    frames: Sequence[Frame],
    surfaces: Sequence[Surfaces],
    facets: Facets | None,
    fixtures: Sequence[Sequence[Fixture]],
    progress: Progress = NO_PROGRESS,
) -> list[Side]:
    """Return the side of every frame, from the part's faces in it and what holds it there; `facets` are in the first frame, and their tree
    serves all."""
    sides: list[Side] = []
    home = PartContact(surfaces[0], facets)
    for frame, faces, held in zip(frames, surfaces, fixtures, strict=True):
        progress.check()
        part = home if not sides else home.seen_from(faces, frames[0], frame)
        meshes = [fixture_facets(f, frame) for f in progress.each(held)]
        sides.append(Side(frame=frame, part=part, contact=part.with_fixtures(meshes)))
    return sides


def fixture_facets(fixture: Fixture, frame: Frame) -> Facets:
    """Return a fixture's triangles in a frame."""
    mesh = fixture.mesh
    return Facets.of_mesh(
        frame.to_local(mesh.points),
        mesh.triangles,
        np.zeros(len(mesh.triangles), np.int64),
        np.zeros(1, np.int64),
        FIXTURE_BOUND,
    )
