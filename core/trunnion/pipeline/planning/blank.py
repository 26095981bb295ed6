"""The blank of a session: made around the part, or read from a file; and whether the part is in it."""

from __future__ import annotations

import hashlib
from functools import lru_cache
from pathlib import Path

import numpy as np

from trunnion import tolerance
from trunnion.findings import BadInput, Finding, error
from trunnion.geometry.frame import Frame
from trunnion.geometry.mesh import welded
from trunnion.model.blank import Blank
from trunnion.model.material import Material
from trunnion.model.session import Session
from trunnion.pipeline.context import Context
from trunnion.plan.blank import (
    AUTOMATIC,
    CYLINDER,
    FILE,
    FINISH_TURNED,
    RING_TURNED,
    TURNED,
    BlankSettings,
    make_bar,
    make_blank,
    make_envelope,
    make_faceted,
    make_finish_turned,
    make_ring_turned,
)
from trunnion.progress import Progress
from trunnion.recognize.contract import usual_blank
from trunnion.settings import checked, choose

ROUND = (CYLINDER, TURNED, FINISH_TURNED, RING_TURNED)
"""Kinds of blank whose size depends on how far the part reaches from an axis: triangles tell."""


def kind_of(session: Session) -> str:
    """Return the kind of blank that a session asks for: the usual one of its family where it is left to the program."""
    kind = choose(BlankSettings, session.choices).kind
    if kind == AUTOMATIC and session.recognition is not None:
        return usual_blank(session.recognition.family)
    return str(kind)


def blank_of(session: Session, context: Context, frame: Frame, progress: Progress) -> Blank:
    """Return the blank by the session's settings, in a frame; raise `BadInput` when there is no such one."""
    settings = checked(choose(BlankSettings, session.choices))
    if settings.material not in context.shop.materials:
        raise BadInput(
            f"there is no material {settings.material} in the catalogue; known: {', '.join(sorted(context.shop.materials))}"
        )
    material = context.shop.materials[settings.material]
    kind = kind_of(session)
    if kind == FILE:
        return _read(session, frame, material, settings.file, progress)
    if kind == TURNED:
        mesh = context.part.mesh()
        return make_envelope(frame, frame.to_local(mesh.points), mesh.triangles, material, settings)
    if kind == FINISH_TURNED:
        mesh = context.part.mesh()
        points = frame.to_local(mesh.points)
        return make_finish_turned(frame, points, mesh.triangles, mesh.face, material)
    if kind == RING_TURNED:
        return make_ring_turned(frame, context.part.mesh(), context.part.graph(), material)
    low, high = context.box(frame)
    if kind == CYLINDER:
        points = frame.to_local(context.part.mesh().points)
        return make_bar(frame, low, high, points, material, settings)
    return make_blank(frame, low, high, material, settings)


def _read(
    session: Session, frame: Frame, material: Material, file: str, progress: Progress
) -> Blank:
    from trunnion.part.read.fixture import read_fixture

    if not file:
        raise BadInput(
            "a blank of kind file needs one: choose blank.file, a STEP, IGES or STL file"
        )
    mesh = read_fixture(file, progress=progress)
    try:
        points, triangles = welded(mesh, tolerance.COINCIDENT)
        return make_faceted(frame, points, triangles, material, file_digest(file))
    except ValueError as reason:
        raise BadInput(f"{file}: {reason}; give the file of one closed solid") from None


def source_of(session: Session) -> str:
    """Return the digest of the file that the blank is to be read from, empty where it is none.

    A file that is gone counts as the one that the blank was read from: the session has all of it.
    """
    settings = choose(BlankSettings, session.choices)
    if settings.kind != FILE:
        return ""
    return file_digest(settings.file) or (session.blank.source if session.blank is not None else "")


def file_digest(file: str) -> str:
    """Return a short digest of a file's bytes, empty when it can't be read."""
    path = Path(file)
    try:
        found = path.stat()
        return _digest(str(path.resolve()), found.st_mtime_ns, found.st_size)
    except OSError:
        return ""


@lru_cache(maxsize=4)
def _digest(path: str, changed: int, size: int) -> str:
    """Return the digest of a file as it was changed last: it is needed whenever a window looks what is stale."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()[:16]


def too_small(blank: Blank, context: Context) -> tuple[Finding, ...]:
    """Return an error where the part stands out of its blank; a backing may, there is nothing of it in a file's blank."""
    if blank.is_box:
        corners = np.stack(context.part.box(blank.frame))
        if blank.inward(corners).min() >= -tolerance.SEW:
            return ()
    mesh = context.part.mesh()
    points = mesh.points[np.unique(mesh.triangles[~np.isin(mesh.face, context.part.backing)])]
    inward = blank.inward(blank.frame.to_local(points))
    if inward.min() >= -tolerance.SEW:
        return ()
    worst = int(np.argmin(inward))
    position = ", ".join(f"{v:.2f}" for v in points[worst])
    away = f"by {-inward[worst]:.2f} mm" if np.isfinite(inward[worst]) else "wholly"
    return (
        error(
            "blank.too-small",
            f"the part stands out of its blank {away} at ({position})",
            remedy="choose a larger blank, or one in the part's coordinates",
        ),
    )
