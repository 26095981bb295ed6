"""Work on a part that the process which read it does beside."""

import os
import re
from pathlib import Path

import numpy as np
import pytest

import samples
from trunnion import tolerance
from trunnion.forks import copies
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


@pytest.mark.cold
@pytest.mark.skipif(not copies(), reason="this process can't be copied")
def test_the_process_beside_keeps_nothing_of_the_memory_that_work_takes() -> None:
    fine = tuple((tag, 5e-5) for tag, _ in ALL)
    with PartReading.of_file(samples.block_with_pocket(), stays=True) as reading:
        part = reading.part()
        peak = []
        for chords in (ALL, fine):
            part.begin(RefinedMeshWork(chords))
            made = part.finished(RefinedMeshWork(chords), NO_PROGRESS)
            peak.append(_peak_of_readers())
    taken = sum(getattr(made, name).nbytes for name in ("points", "normals", "triangles"))
    assert taken > 10_000_000
    assert peak[1] - peak[0] < 0.5 * taken


def _peak_of_readers() -> int:
    """Return the most memory (bytes) that this process's readers have had, each for itself."""
    own = Path("/proc", str(os.getpid()))
    children = [
        c for task in (own / "task").iterdir() for c in (task / "children").read_text().split()
    ]
    status = [
        Path("/proc", child, "status").read_text()
        for child in children
        if b"trunnion.part.read.child" in Path("/proc", child, "cmdline").read_bytes()
    ]
    return sum(1024 * int(re.findall(r"VmHWM:\s+(\d+)", text)[0]) for text in status)
