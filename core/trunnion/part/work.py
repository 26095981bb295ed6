"""Work on a part that another process may do while this one is at something else: triangles, which take the CAD kernel seconds."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from trunnion import tolerance
from trunnion.progress import NO_PROGRESS, Progress

if TYPE_CHECKING:
    from trunnion.geometry.mesh import Mesh
    from trunnion.part.part import Part
    from trunnion.part.shape.refine_mesh import RefinedMesh


class PartWork(Protocol):
    """Work on a part that depends on nothing else; equal ones come to the same, and they and their results can be pickled."""

    def load(self) -> None:
        """Load what does it, where some takes time to be loaded."""

    def done(self, part: Part, progress: Progress = NO_PROGRESS) -> Any:
        """Return what comes of it."""


class PartWorker(Protocol):
    """A process that has the same part."""

    def begin(self, work: PartWork) -> None:
        """Let it do some work, after what was begun before."""

    def made(self, work: PartWork, progress: Progress) -> Any | None:
        """Return what came of some work, waiting for it; None where it was not begun or failed."""


@dataclass(frozen=True, slots=True)
class MeshWork:
    """Triangles as `Part.mesh` has them, within a chord error (mm) and an angle (radians)."""

    chord: float = tolerance.CHORD
    angle: float = tolerance.MESH_ANGLE

    def load(self) -> None:
        """Nothing that is not loaded with a part."""

    def done(self, part: Part, progress: Progress = NO_PROGRESS) -> Mesh:
        """Return them."""
        with part.watched(progress):
            return part.mesh(self.chord, self.angle)


@dataclass(frozen=True, slots=True)
class RefinedMeshWork:
    """Triangles as `refine_mesh.opened` has them, with the chord error (mm) of each face by its tag, ascending."""

    chords: tuple[tuple[int, float], ...]

    @staticmethod
    def of(tags: Iterable[int], chord: float) -> RefinedMeshWork:
        """Return the opening of some faces within one chord error (mm)."""
        return RefinedMeshWork(tuple((tag, chord) for tag in sorted(tags)))

    def load(self) -> None:
        """Load the compiled splines."""
        from trunnion.geometry.surface.spline import load_splines

        load_splines()

    def done(self, part: Part, progress: Progress = NO_PROGRESS) -> RefinedMesh:
        """Return them."""
        from trunnion.part.shape.refine_mesh import opened

        return opened(part, dict(self.chords), progress)
