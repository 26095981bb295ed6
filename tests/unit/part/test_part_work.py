"""Work on a part that the process which read it does beside."""

import numpy as np
import pytest

import samples
from trunnion import tolerance
from trunnion.part.read.part_file import PartReading, read_part
from trunnion.part.shape.refine_mesh import opened
from trunnion.part.work import MeshWork, RefinedMeshWork
from trunnion.progress import NO_PROGRESS, Cancelled, Progress

ALL = tuple((tag, tolerance.CHORD) for tag in range(1, 24))


@pytest.mark.cold
def test_what_is_finished_is_what_would_be_made_here() -> None:
    file = samples.block_with_pocket()
    with PartReading.of_file(file, stays=True) as reading:
        part = reading.part()
        part.begin(MeshWork())
        part.begin(RefinedMeshWork(ALL))
        mesh, fine = part.mesh(), opened(part, dict(ALL))
        assert part.finished(RefinedMeshWork(ALL), NO_PROGRESS) is not None
    alone = read_part(file)
    own, finer = alone.mesh(), opened(alone, dict(ALL))
    for name in ("points", "triangles", "face"):
        assert np.array_equal(getattr(mesh, name), getattr(own, name))
    for name in ("tag", "points", "normals", "triangles", "face", "bound"):
        assert np.array_equal(getattr(fine, name), getattr(finer, name))


def test_work_that_was_not_begun_or_that_fails_there_is_done_here() -> None:
    beyond = RefinedMeshWork(((1, tolerance.CHORD), (999, tolerance.CHORD)))
    with PartReading.of_file(samples.block_with_pocket(), stays=True) as reading:
        part = reading.part()
        assert part.finished(MeshWork(), NO_PROGRESS) is None
        part.begin(beyond)
        assert part.finished(beyond, NO_PROGRESS) is None
        assert len(part.mesh().triangles)


def test_a_process_that_has_ended_leaves_the_work_to_this_one() -> None:
    with PartReading.of_file(samples.block_with_pocket(), stays=True) as reading:
        part = reading.part()
        part.begin(MeshWork())
    part.begin(RefinedMeshWork(ALL))
    assert part.finished(MeshWork(), NO_PROGRESS) is None
    assert part.finished(RefinedMeshWork(ALL), NO_PROGRESS) is None
    assert len(part.mesh().triangles)


def test_waiting_for_work_beside_can_be_cancelled() -> None:
    with PartReading.of_file(samples.block_with_pocket(), stays=True) as reading:
        part = reading.part()
        part.begin(RefinedMeshWork(tuple((tag, 1e-4) for tag, _ in ALL)))
        with pytest.raises(Cancelled):
            part.finished(
                RefinedMeshWork(tuple((tag, 1e-4) for tag, _ in ALL)),
                Progress(cancelled=lambda: True),
            )


def test_a_part_that_no_process_has_is_worked_on_here() -> None:
    part = read_part(samples.block_with_pocket())
    part.begin(MeshWork())
    assert part.finished(MeshWork(), NO_PROGRESS) is None
