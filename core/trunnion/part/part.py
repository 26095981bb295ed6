"""The part: a CAD shape with numbered faces, and the queries on it that other packages may make."""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from trunnion import tolerance
from trunnion.findings import BadInput, Finding, Severity
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.boundary import Boundary
from trunnion.geometry.dimension import Dimension
from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.geometry.mesh import Mesh
from trunnion.geometry.plane.region import Region
from trunnion.geometry.surface.curvature import FaceCurvature
from trunnion.part.topology.identity import Shape, faces_of
from trunnion.part.work import MeshWork, PartWork, PartWorker
from trunnion.progress import NO_PROGRESS, Progress

if TYPE_CHECKING:
    from trunnion.part.topology.boundary import BoundaryCurves

_MAGIC = b"trunnion part 1\n"


@dataclass(frozen=True, slots=True, kw_only=True)
class PartMetadata:
    """What is known of a part beside its shape.

    `unit` is the file's own ("mm", "inch", ...), lengths here are mm; `tags` (k,) the tag of every face of the chosen solid in the
    order of the solid's own faces; `names` and `colours` (red, green, blue from 0 to 1) by face tag where the file gives them; `entities`
    the first line in an IGES file's directory of the entity that a face comes from, by its tag; `backing` the tags of faces that are none
    of the file's: they make a solid of faces that enclose no material (`part.backing`); `dimensions` the sizes that a STEP file gives as
    data, of faces of the chosen solid.
    """

    path: str
    name: str
    digest: str
    unit: str
    n_faces: int
    n_solids: int
    solid: int
    is_closed: bool
    area: float
    volume: float
    tags: tuple[int, ...]
    names: Mapping[int, str] = field(default_factory=dict)
    colours: Mapping[int, tuple[float, float, float]] = field(default_factory=dict)
    entities: Mapping[int, int] = field(default_factory=dict)
    findings: tuple[Finding, ...] = ()
    backing: tuple[int, ...] = ()
    dimensions: tuple[Dimension, ...] = ()

    def to_json(self) -> str:
        """Return the facts as JSON text."""
        plain = asdict(self) | {"findings": [f.as_dict() for f in self.findings]}
        return json.dumps(plain)

    @staticmethod
    def from_json(text: str) -> PartMetadata:
        """Return the facts that `to_json` wrote."""
        data = json.loads(text)
        data["findings"] = tuple(
            Finding(**f | {"severity": Severity(f["severity"]), "where": tuple(f["where"])})
            for f in data["findings"]
        )
        data["names"] = {int(k): v for k, v in data["names"].items()}
        data["colours"] = {int(k): tuple(v) for k, v in data["colours"].items()}
        data["entities"] = {int(k): v for k, v in data["entities"].items()}
        data["tags"] = tuple(data["tags"])
        data["backing"] = tuple(data["backing"])
        # Parts that were written before dimensions were read have none.
        data["dimensions"] = tuple(
            Dimension(**d | {"faces": tuple(d["faces"])}) for d in data.get("dimensions", ())
        )
        return PartMetadata(**data)


class Part:
    """One chosen solid of a part file, in mm, with the face tags of the file as read.

    `shape` is the solid that is programmed (healed or sewn where that was needed), `as_read` everything the file holds. What is
    computed from them is cached.
    """

    def __init__(self, facts: PartMetadata, shape: Shape, as_read: Shape) -> None:
        self.facts = facts
        self.shape = shape
        self.as_read = as_read
        own = faces_of(shape)
        if len(own) != len(facts.tags):
            raise BadInput(
                f"{facts.name}: the part's {len(own)} faces don't fit its {len(facts.tags)} face tags; read the part anew"
            )
        self._faces = dict(zip(facts.tags, own, strict=True))
        self._graph: FaceGraph | None = None
        self._meshes: dict[tuple[float, float], Mesh] = {}
        self._boxes: dict[bytes, tuple[Floats, Floats]] = {}
        self._sections: dict[tuple[bytes, float], Region] = {}
        self._bounding: BoundaryCurves | None = None
        self._bends: dict[int, FaceCurvature] = {}
        self._slicer: Any = None
        self._progress = NO_PROGRESS
        self._beside: PartWorker | None = None

    path = property(lambda self: self.facts.path, doc="Where the part was read from.")
    name = property(lambda self: self.facts.name, doc="The file's name without its suffix.")
    digest = property(lambda self: self.facts.digest, doc="SHA-256 of the file's bytes.")
    unit = property(
        lambda self: self.facts.unit, doc="The file's own unit; everything here is in mm."
    )
    n_faces = property(lambda self: self.facts.n_faces, doc="How many faces the file holds.")
    n_solids = property(lambda self: self.facts.n_solids, doc="How many solids the file holds.")
    solid = property(lambda self: self.facts.solid, doc="Which of them this is, from 1.")
    is_closed = property(
        lambda self: self.facts.is_closed, doc="Whether the faces enclose material without a gap."
    )
    area = property(lambda self: self.facts.area, doc="Area of the solid's faces in mm2.")
    volume = property(lambda self: self.facts.volume, doc="Volume in mm3.")
    names = property(
        lambda self: self.facts.names, doc="Names of faces by tag, where the file gives them."
    )
    colours = property(
        lambda self: self.facts.colours, doc="Colours of faces by tag, where the file gives them."
    )
    entities = property(
        lambda self: self.facts.entities,
        doc="The line in an IGES file's directory of the entity of a face, by its tag.",
    )
    backing = property(
        lambda self: self.facts.backing,
        doc="Tags of faces that only give open faces material behind them: nobody asks for them.",
    )
    dimensions = property(
        lambda self: self.facts.dimensions,
        doc="Sizes with tolerances, fits and threads of faces, where a STEP file gives them as data.",
    )
    findings = property(
        lambda self: self.facts.findings, doc="What a person should know about the file."
    )

    @property
    def tags(self) -> tuple[int, ...]:
        """The tags of the chosen solid's faces, ascending."""
        return tuple(sorted(self._faces))

    @property
    def low(self) -> Floats:
        """Lowest corner (3,) of the box around the solid, mm."""
        return self.graph().box_low[np.asarray(self.tags) - 1].min(axis=0)

    @property
    def high(self) -> Floats:
        """Highest corner (3,) of the box around the solid, mm."""
        return self.graph().box_high[np.asarray(self.tags) - 1].max(axis=0)

    @contextmanager
    def watched(self, progress: Progress) -> Iterator[None]:
        """Look at a progress during whatever is computed from the part meanwhile: graph, mesh, sections, boundary and bends."""
        before, self._progress = self._progress, progress
        try:
            yield
        finally:
            self._progress = before

    def accompanied(self, beside: PartWorker) -> Part:
        """Return this part, which lets a process that has it too do work beside."""
        self._beside = beside
        return self

    def begin(self, work: PartWork) -> None:
        """Let work that will be wanted be done beside; nothing where no other process has the part."""
        if self._beside is not None:
            self._beside.begin(work)

    def finished(self, work: PartWork, progress: Progress) -> Any | None:
        """Return what came of work that was begun, waiting for it; None where it is to be done here."""
        return self._beside.made(work, progress) if self._beside is not None else None

    def face_shape(self, tag: int) -> Shape | None:
        """Return the face of a tag as it lies in the solid (its normal points outward), or None when it is not of this solid."""
        return self._faces.get(tag)

    def graph(self) -> FaceGraph:
        """Return the attributed face graph; row = tag - 1, faces of other solids have area 0, no samples and no edges."""
        if self._graph is None:
            from trunnion.part.topology.graph import face_graph

            self._graph = face_graph(self.shape, self._faces, self.n_faces, self._progress)
        return self._graph

    def mesh(self, chord: float = tolerance.CHORD, angle: float = tolerance.MESH_ANGLE) -> Mesh:
        """Return triangles of the solid within a chord error (mm) and an angle between neighbouring chords (radians)."""
        if (chord, angle) not in self._meshes:
            made = self.finished(MeshWork(chord, angle), self._progress)
            if made is None:
                from trunnion.part.shape.tessellate import tessellated

                made = tessellated(self.shape, self._faces, chord, angle, self._progress)
            self._meshes[chord, angle] = made
        return self._meshes[chord, angle]

    @property
    def picture_chord(self) -> float:
        """Chord error (mm) of the triangles that pictures show: what nobody sees in one of the whole part."""
        diagonal = float(np.linalg.norm(self.high - self.low))
        return max(tolerance.PICTURE, tolerance.PICTURE_SHARE * diagonal)

    @property
    def view_chord(self) -> float:
        """Chord error (mm) of the triangles that the window shows: what nobody sees when looking at a seventh of the part."""
        diagonal = float(np.linalg.norm(self.high - self.low))
        return max(tolerance.CHORD, tolerance.VIEW_SHARE * diagonal)

    def box(self, frame: Frame) -> tuple[Floats, Floats]:
        """Return the lowest and the highest corner (3,) mm of the box around the solid, in a frame."""
        from trunnion.part.topology.part_box import box_in

        key = _key(frame)
        if key not in self._boxes:
            self._boxes[key] = box_in(frame, self._faces, self.graph(), self._progress)
        return self._boxes[key]

    def section(self, frame: Frame, z: float) -> Region:
        """Return the material cut by the plane at height `z` of a frame, in the frame's x and y.

        Lines and arcs are exact, other curves are followed by arcs within `tolerance.FITTED`. A plane that touches vertices or holds
        faces is moved up by `tolerance.SECTION_STEP` until it doesn't.
        """
        self._progress.check()
        key = (_key(frame), float(z))
        if key not in self._sections:
            if self._slicer is None:
                from trunnion.part.shape.section import SolidSlicer

                self._slicer = SolidSlicer(self.shape, list(self._faces.values()), self._progress)
            self._sections[key] = self._slicer.section(frame, float(z), self._progress)
        return self._sections[key]

    def boundary(self, parts: Callable[[Floats], Ints] | None = None) -> Boundary:
        """Return the boundary of every face as read (healing may move edges): each edge cut into `parts(lengths)` pieces of equal length,
        or with the points that are farthest along x, y and z."""
        if self._bounding is None:
            from trunnion.part.topology.boundary import bounding_of

            self._bounding = bounding_of(
                (tag, face) for tag, face in self._as_read() if tag in self._faces
            )
        return self._bounding.points(parts)

    def boundary_error(self) -> dict[int, float]:
        """Return how far each face's boundary curves, as read, are from its surface at most, mm, by tag."""
        from trunnion.part.topology.boundary import approximation_of

        return {tag: approximation_of(face) for tag, face in self._as_read() if tag in self._faces}

    def _as_read(self) -> Iterator[tuple[int, Shape]]:
        """Yield the faces as read by tag, looking at progress before each."""
        for tag, face in enumerate(faces_of(self.as_read), 1):
            self._progress.check()
            yield tag, face

    def bend(self, tag: int) -> FaceCurvature:
        """Return how a face bends; raise `BadInput` when it is not of the chosen solid."""
        if tag not in self._bends:
            from trunnion.part.shape.curvature import bend_of

            self._progress.check()
            face = self.face_shape(tag)
            if face is None:
                raise BadInput(f"face {tag} is not a face of the chosen solid of {self.name}")
            self._bends[tag] = bend_of(face)
        return self._bends[tag]

    def face_outline(self, frame: Frame, tag: int) -> Region:
        """Return the plan projection, in the frame's x and y, of a plane face that is level or nearly so; raise `BadInput` otherwise."""
        from trunnion.part.shape.outline import outline

        face = self.face_shape(tag)
        if face is None:
            raise BadInput(f"face {tag} is not a face of the chosen solid of {self.name}")
        return outline(face, frame, f"face {tag} of {self.name}")

    def to_bytes(self) -> bytes:
        """Return the part as bytes for another process; what was computed from it stays behind."""
        facts = self.facts.to_json().encode()
        return b"".join(
            [_MAGIC, len(facts).to_bytes(8, "little"), facts, shape_bytes(self.shape, self.as_read)]
        )

    @staticmethod
    def from_bytes(data: bytes) -> Part:
        """Return the part that `to_bytes` wrote; raise `BadInput` when it is not one."""
        if not data.startswith(_MAGIC):
            raise BadInput("these bytes don't hold a part: read the part file again")
        at = len(_MAGIC) + 8
        end = at + int.from_bytes(data[len(_MAGIC) : at], "little")
        shape, as_read = shapes_from(data[end:])
        return Part(PartMetadata.from_json(data[at:end].decode()), shape, as_read)


def shape_bytes(shape: Shape, as_read: Shape) -> bytes:
    """Return the chosen solid and everything read as one block of bytes; what they share is written once."""
    from OCP.BinTools import BinTools, BinTools_FormatVersion
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Compound

    both, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(both)
    builder.Add(both, shape)
    builder.Add(both, as_read)
    stream = io.BytesIO()
    BinTools.Write_s(
        both, stream, False, False, BinTools_FormatVersion.BinTools_FormatVersion_CURRENT
    )
    return stream.getvalue()


def shapes_from(data: bytes) -> tuple[Shape, Shape]:
    """Return the chosen solid and everything read from what `shape_bytes` wrote."""
    from OCP.BinTools import BinTools
    from OCP.TopoDS import TopoDS_Compound, TopoDS_Iterator

    both = TopoDS_Compound()
    BinTools.Read_s(both, io.BytesIO(data))
    if both.IsNull():
        raise BadInput("these bytes don't hold a shape: read the part file again")
    inside = TopoDS_Iterator(both)
    shape = inside.Value()
    inside.Next()
    return shape, inside.Value()


def _key(frame: Frame) -> bytes:
    """Return what tells a frame from others in a cache."""
    return b"".join(a.tobytes() for a in (frame.origin, frame.x, frame.z))
