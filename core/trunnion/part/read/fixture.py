"""Reads fixtures: STEP and IGES in a process with limits as parts are, STL as triangles."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.geometry.mesh import Mesh
from trunnion.part.read.limits import ReadLimits
from trunnion.progress import NO_PROGRESS, Progress

CHORD = 0.02
"""mm: how far triangles may be from a fixture's faces; clamps are not placed as exactly."""
ANGLE = 0.3
"""Largest turn from triangle to triangle, radians."""
STL = ".stl"
MOST_TRIANGLES = 5_000_000
_MEGA = 1 << 20
_HEADER = 84
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)


def read_fixture(
    path: str | Path, *, limits: ReadLimits | None = None, progress: Progress = NO_PROGRESS
) -> Mesh:
    """Return the triangles of a fixture's file in its own coordinates, mm; all solids of a STEP or IGES file together.

    Raises `BadInput` with one line for a file that can't be used, `Cancelled` on request.
    """
    file, limits = Path(path), limits or ReadLimits()
    if file.suffix.lower() == STL:
        progress.at(0.0, f"reading {file.name}")
        return stl_mesh(_bytes_of(file, limits), str(file))
    from trunnion.part.read.part_file import read_part
    from trunnion.part.shape.tessellate import tessellated
    from trunnion.part.topology.identity import faces_of

    part = read_part(file, limits=limits, progress=progress)
    mesh = tessellated(part.as_read, dict(enumerate(faces_of(part.as_read), 1)), CHORD, ANGLE)
    if not len(mesh.triangles):
        raise BadInput(f"{file}: holds no faces")
    return mesh


def stl_mesh(data: bytes, name: str) -> Mesh:
    """Return the mesh of an STL file's bytes, binary or text; its normals are not trusted. Every triangle has face 1.

    Raises `BadInput` for anything else.
    """
    corners = _binary(data) if _is_binary(data) else _text(data, name)
    if not len(corners):
        raise BadInput(f"{name}: not an STL file with triangles")
    if len(corners) > MOST_TRIANGLES:
        raise BadInput(
            f"{name}: {len(corners)} triangles are more than the {MOST_TRIANGLES} that are read; make the mesh coarser"
        )
    if not np.isfinite(corners).all():
        raise BadInput(f"{name}: holds numbers that are not finite")
    points, rows = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    triangles = rows.reshape(-1, 3)
    flat = (
        (triangles[:, 0] == triangles[:, 1])
        | (triangles[:, 1] == triangles[:, 2])
        | (triangles[:, 2] == triangles[:, 0])
    )
    triangles = triangles[~flat]
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    if float((a * np.cross(b, c)).sum()) < 0.0:
        triangles = triangles[:, ::-1]
    return Mesh(points, triangles, np.ones(len(triangles), np.int64))


def _is_binary(data: bytes) -> bool:
    """Return whether the length of a file fits its count of triangles: text may begin with any word, also with `solid`."""
    return (
        len(data) >= _HEADER
        and len(data)
        == _HEADER + int.from_bytes(data[_HEADER - 4 : _HEADER], "little") * _RECORD.itemsize
    )


def _binary(data: bytes) -> Floats:
    return np.frombuffer(data, _RECORD, offset=_HEADER)["corners"].astype(np.float64)


def _text(data: bytes, name: str) -> Floats:
    found = _VERTEX.findall(data)
    if len(found) % 3:
        raise BadInput(f"{name}: the last triangle of the STL file is cut off; copy it again")
    try:
        return np.array(found, dtype="S").astype(np.float64).reshape(-1, 3, 3)
    except ValueError:
        raise BadInput(f"{name}: a corner in the STL file is no number") from None


def _bytes_of(file: Path, limits: ReadLimits) -> bytes:
    try:
        with file.open("rb") as stream:
            data = stream.read(limits.size * _MEGA + 1)
    except OSError as reason:
        raise BadInput(f"{file}: can't be read ({reason.strerror or reason})") from None
    if len(data) > limits.size * _MEGA:
        raise BadInput(f"{file}: larger than the limit of {limits.size} MB for a fixture")
    return data
