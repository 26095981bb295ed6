"""Faces that enclose no material: the side they are machined from, and the part with a backing that is planned and proven for them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from trunnion.findings import BadInput, Finding, info, warning
from trunnion.geometry.frame import WORLD, Frame
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import checked, choose, setting, settings

if TYPE_CHECKING:
    from trunnion.part.open_side import OpenSide
    from trunnion.part.part import Part

SIDES = ("auto", "normals", "+x", "-x", "+y", "-y", "+z", "-z")


@settings("open")
class OpenSettings:
    """Which side of faces that enclose no material is machined, and how thick the material behind them is. A solid has no use for it."""

    side: str = setting(
        "auto",
        choices=SIDES,
        label="Side of open faces",
        help="Where the tool comes from to faces that enclose no material: an axis of the file, the side that the "
        "file's normals point to, or auto: the one that sees most of the faces, +z before the others.",
    )
    backing: float = setting(
        5.0,
        unit="mm",
        low=0.1,
        high=500.0,
        label="Backing of open faces",
        help="Material under the lowest point of faces that enclose none, down to a flat base.",
    )


def used_settings(part: Part) -> tuple[type, ...]:
    """Return the settings that open faces are machined by; none for a part that encloses material."""
    return () if part.is_closed else (OpenSettings,)


def side_of(part: Part, choices: Mapping[str, Any]) -> OpenSide:
    """Return the side that open faces are machined from; raise `BadInput` where none serves."""
    from trunnion.part.open_side import open_side

    return open_side(part, checked(choose(OpenSettings, choices)).side)


def with_backing(part: Part, choices: Mapping[str, Any], progress: Progress = NO_PROGRESS) -> Part:
    """Return a part as it is planned and proven: open faces with a backing, any other as it is; raise `BadInput` where none can be made."""
    if part.is_closed:
        return part
    from trunnion.part.backing import backed

    progress.at(0.0, "backing of open faces")
    side, thickness = side_of(part, choices), checked(choose(OpenSettings, choices)).backing
    return progress.aside(lambda _: backed(part, side, thickness))


def frame_and_finding(part: Part, choices: Mapping[str, Any]) -> tuple[Frame | None, Finding]:
    """Return the frame that open faces are machined in, None where no side serves, and what is to be said of it."""
    try:
        side = side_of(part, choices)
    except BadInput as reason:
        return None, warning(
            "open.no-side",
            str(reason),
            remedy="without a side they can be grouped and exported only",
        )
    known = next((n for n, d in _axes().items() if np.allclose(side.direction, d)), "")
    seen = known or "({:.4f}, {:.4f}, {:.4f})".format(*(side.direction + 0.0))
    frame = WORLD if known == "+z" else side.frame()
    return frame, info(
        "open.side",
        f"the faces ({len(part.tags)}) enclose no material: they are machined from {seen}, on a backing that the program adds",
        remedy="choose open.side to machine them from another side, open.backing for the material behind them",
    )


def _axes() -> dict[str, tuple[float, float, float]]:
    from trunnion.part.open_side import SIDES as AXES

    return AXES
