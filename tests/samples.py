"""Small parts that tests use everywhere: built once a session, written as STEP or IGES, moved, mirrored, turned.

two_pockets_and_a_rib()                                          the path of its STEP file
read(two_pockets_and_a_rib_shape())                              the part, through STEP
read(turned(block_with_pocket_shape(), (1, 2, 3), 40), "igs")    turned about an axis, through IGES
"""

from __future__ import annotations

import gzip
import hashlib
import io
import tempfile
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import cadquery as cq

if TYPE_CHECKING:
    from trunnion.part.part import Part

Triple = Sequence[float]
POCKET = {
    "length": 60.0,
    "width": 36.0,
    "height": 18.0,
    "pocket_length": 36.0,
    "pocket_width": 20.0,
    "depth": 10.0,
    "corner": 4.0,
    "fillet": 2.0,
}
"""Sizes of `block_with_pocket_shape`, mm."""
PANEL = {
    "length": 160.0,
    "width": 100.0,
    "height": 20.0,
    "floor": 4.0,
    "corner": 8.0,
    "fillet": 3.0,
    "rib_top": 14.0,
    "rib": 4.0,
}
"""Sizes of `two_pockets_and_a_rib_shape`, mm: `floor` is the height of every pocket's floor over the bottom, `rib_top` of the rib's top."""


@cache
def box_shape(length: float = 40.0, width: float = 30.0, height: float = 20.0) -> Any:
    """Return a plain box with a corner at the origin."""
    return cq.Workplane("XY").box(length, width, height, centered=False).val().wrapped


@cache
def drilled_block_shape() -> Any:
    """Return the plain box with a through hole of 8 mm at (20, 15)."""
    return (
        cq.Workplane("XY")
        .box(40, 30, 20, centered=False)
        .faces(">Z")
        .workplane(origin=(20, 15, 20))
        .hole(8)
        .val()
        .wrapped
    )


@cache
def block_with_pocket_shape() -> Any:
    """Return a block with a rounded pocket that has a floor fillet; corner at the origin, pocket in the middle, open upward."""
    s = POCKET
    block = cq.Workplane("XY").box(s["length"], s["width"], s["height"], centered=False)
    return (
        block.cut(
            _pocket(
                s["length"] / 2,
                s["width"] / 2,
                s["pocket_length"],
                s["pocket_width"],
                s["height"] - s["depth"],
                s["height"],
                s["corner"],
                s["fillet"],
            )
        )
        .val()
        .wrapped
    )


@cache
def two_pockets_and_a_rib_shape() -> Any:
    """Return a small panel: two pockets beside a low rib, an island with a floor fillet in the left one, an open pocket on the right.

    160 x 100 x 20, outer corners R10. Left pocket x 10 to 68, right pocket x 72 to 125, both y 10 to 90, rib x 68 to 72 with its top at
    14; open pocket x 135 to the side at 160, y 30 to 70. Floors at 4, pocket corners R8, floor fillets R3. Island: cylinder R8 at (36, 50)
    up to 12.
    """
    s = PANEL
    plate = (
        cq.Workplane("XY")
        .box(s["length"], s["width"], s["height"], centered=False)
        .edges("|Z")
        .fillet(10.0)
    )
    left = _pocket(39.0, 50.0, 58.0, 80.0, s["floor"], s["height"], s["corner"], s["fillet"])
    right = _pocket(98.5, 50.0, 53.0, 80.0, s["floor"], s["height"], s["corner"], s["fillet"])
    island = cq.Workplane("XY").circle(8.0).extrude(12.0).translate((36.0, 50.0, 0.0))
    left = (
        left.cut(island)
        .edges(cq.selectors.BoxSelector((26, 40, 3.9), (46, 60, 4.1)))
        .fillet(s["fillet"])
    )
    lowered = (
        cq.Workplane("XY").box(6.0, 64.0, 6.0, centered=False).translate((67.0, 18.0, s["rib_top"]))
    )
    opened = (
        cq.Workplane("XY")
        .box(45.0, 40.0, 16.0, centered=False)
        .translate((135.0, 30.0, s["floor"]))
    )
    opened = (
        opened.edges("|Z and <X")
        .fillet(s["corner"])
        .faces("<Z")
        .edges("not >X")
        .fillet(s["fillet"])
    )
    return plate.cut(left).cut(right).cut(opened).cut(lowered).val().wrapped


@cache
def oblique_cylinder_shape() -> Any:
    """Return a cylinder R10, 60 long, that leans by 30 degrees about y: its sections are ellipses."""
    return (
        cq.Workplane("XY")
        .circle(10.0)
        .extrude(60.0)
        .rotate((0, 0, 0), (0, 1, 0), 30.0)
        .val()
        .wrapped
    )


@cache
def ball_shape() -> Any:
    """Return a ball R10 around the origin with a flat at z = -5."""
    return (
        cq.Workplane("XY")
        .sphere(10.0)
        .cut(cq.Workplane("XY").box(30, 30, 10).translate((0, 0, -10)))
        .val()
        .wrapped
    )


@cache
def dome_on_a_plate_shape() -> Any:
    """Return a plate 60 x 60 x 10 with nearly half a ball R16 on it, its foot rounded by 3."""
    cap = (
        cq.Workplane("XY")
        .sphere(16.0)
        .translate((0, 0, 7))
        .intersect(cq.Workplane("XY").box(60, 60, 40).translate((0, 0, 28)))
    )
    plate = cq.Workplane("XY").box(60, 60, 10).translate((0, 0, 5)).union(cap)
    return (
        plate.edges(cq.selectors.BoxSelector((-20, -20, 9.9), (20, 20, 10.1)))
        .fillet(3.0)
        .val()
        .wrapped
    )


@cache
def two_blocks_shape() -> Any:
    """Return two separate solids: the plain box, and a smaller one beside it."""
    small = cq.Shape.cast(box_shape(10.0, 10.0, 10.0)).translate(cq.Vector(60, 0, 0))
    return cq.Compound.makeCompound([cq.Shape.cast(box_shape()), small]).wrapped


@cache
def open_box_shape() -> Any:
    """Return the plain box's shell without its top face."""
    faces = cq.Workplane(cq.Shape.cast(box_shape())).faces("not >Z").vals()
    return cq.Shell.makeShell(faces).wrapped


def _pocket(
    x: float,
    y: float,
    length: float,
    width: float,
    floor: float,
    top: float,
    corner: float,
    fillet: float,
) -> Any:
    body = (
        cq.Workplane("XY")
        .box(length, width, top - floor, centered=(True, True, False))
        .edges("|Z")
        .fillet(corner)
    )
    return body.faces("<Z").edges().fillet(fillet).translate((x, y, floor))


def block_with_pocket(suffix: str = "step") -> Path:
    """Return the file of `block_with_pocket_shape`."""
    return written(block_with_pocket_shape(), suffix, name="block_with_pocket")


def two_pockets_and_a_rib(suffix: str = "step") -> Path:
    """Return the file of `two_pockets_and_a_rib_shape`."""
    return written(two_pockets_and_a_rib_shape(), suffix, name="two_pockets_and_a_rib")


def moved(shape: Any, by: Triple) -> Any:
    """Return a shape moved by (x, y, z)."""
    return cq.Shape.cast(shape).translate(cq.Vector(*by)).wrapped


def turned(shape: Any, axis: Triple, degrees: float, about: Triple = (0.0, 0.0, 0.0)) -> Any:
    """Return a shape turned about any axis through a point."""
    end = [a + d for a, d in zip(about, axis, strict=True)]
    return cq.Shape.cast(shape).rotate(cq.Vector(*about), cq.Vector(*end), degrees).wrapped


def turned_direction(direction: Triple, axis: Triple, degrees: float) -> tuple[float, ...]:
    """Return where a direction looks when it is turned with a shape."""
    tip = cq.Vertex.makeVertex(*direction)
    return cq.Shape.cast(turned(tip.wrapped, axis, degrees)).Center().toTuple()


def mirrored(shape: Any, plane: str = "YZ") -> Any:
    """Return a shape mirrored in a plane through the origin."""
    return cq.Shape.cast(shape).mirror(plane).wrapped


def renumbered(shape: Any) -> Any:
    """Return a solid with its faces in the opposite order."""
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Shell, TopoDS_Solid

    builder, shell, solid = BRep_Builder(), TopoDS_Shell(), TopoDS_Solid()
    builder.MakeShell(shell)
    for face in reversed(cq.Shape.cast(shape).Faces()):
        builder.Add(shell, face.wrapped)
    shell.Closed(True)
    builder.MakeSolid(solid)
    builder.Add(solid, shell)
    return solid


_FOLDER = tempfile.TemporaryDirectory(prefix="trunnion-samples-")
_FILES: dict[tuple[bytes, str, str, str], Path] = {}
_PARTS: dict[tuple[Path, int | None], Part] = {}


def written(shape: Any, suffix: str = "step", unit: str = "mm", name: str = "sample") -> Path:
    """Return the file of a shape, written once a session: `suffix` step, stp, stpz, igs or iges; `unit` mm, inch or metre."""
    from OCP.BinTools import BinTools

    from trunnion.part.write import write_iges, write_step

    stream = io.BytesIO()
    BinTools.Write_s(shape, stream)
    key = hashlib.sha256(stream.getvalue()).digest(), suffix, unit, name
    if key not in _FILES:
        path = Path(tempfile.mkdtemp(dir=_FOLDER.name)) / f"{name}.{suffix}"
        write = write_iges if suffix in ("igs", "iges") else write_step
        write(shape, path, unit=unit)
        if suffix == "stpz":
            path.write_bytes(gzip.compress(path.read_bytes(), mtime=0))
        _FILES[key] = path
    return _FILES[key]


def read(shape: Any, suffix: str = "step", unit: str = "mm", solid: int | None = None) -> Part:
    """Return the part of a shape that was written to a file and read back, once a session and, for speed, in this process."""
    return read_path(written(shape, suffix, unit), solid)


def read_path(file: Path, solid: int | None = None) -> Part:
    """Return the part of a file, read once a session and, for speed, in this process."""
    from trunnion.part.read.request import ReadRequest
    from trunnion.part.read.text import check_iges, check_step
    from trunnion.part.read.transfer import read_file

    if (file, solid) not in _PARTS:
        data = file.read_bytes()
        is_iges = file.suffix in (".igs", ".iges")
        request = ReadRequest(
            file=file.name,
            path=str(file),
            name=file.stem,
            digest=hashlib.sha256(data).hexdigest(),
            kind="iges" if is_iges else "step",
            listed=(check_iges if is_iges else check_step)(data, file.name),
            solid=solid,
            size=len(data),
        )
        _PARTS[file, solid] = read_file(file, request)
    return _PARTS[file, solid]
