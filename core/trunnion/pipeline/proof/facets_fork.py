"""The part's faces as triangles, made beside posting and reading back: the proof's two longest preparations need nothing of each other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from trunnion.forks import Fork, copies
from trunnion.geometry.frame import Frame
from trunnion.model.material import Machine
from trunnion.part.part import Part
from trunnion.part.shape.facets import Facets, facets_of
from trunnion.progress import Progress
from trunnion.verify.judge.part_facets import FacetsFork, may_lean


@contextmanager
def facets_fork(
    part: Part, frame: Frame, machines: Sequence[Machine]
) -> Iterator[FacetsFork | None]:
    """Begin to make the triangles of all faces, in a frame, in a copy of this process; it is stopped where the block ends before it.

    None where no tool may lean on the machines, or where this process can't be copied: the proof makes what it needs itself.
    """
    if not copies() or not may_lean(machines):
        yield None
        return

    def make(progress: Progress) -> Facets:
        return facets_of(part, frame, progress=progress)

    copy = Fork(make)
    try:
        yield FacetsFork(frame, copy.result)
    finally:
        copy.stop()
