"""The skin of a part: triangles so fine that a path over them is a path over the faces themselves."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

import numpy as np

from trunnion import tolerance
from trunnion.geometry.frame import Frame
from trunnion.geometry.sheet.skin import Skin
from trunnion.part.shape.refine_mesh import opened
from trunnion.progress import NO_PROGRESS, Progress

if TYPE_CHECKING:
    from trunnion.part.part import Part


def skin_of(
    part: Part,
    frame: Frame,
    chord: float,
    progress: Progress = NO_PROGRESS,
    fine: Collection[int] | None = None,
) -> Skin:
    """Return the skin of a whole part in a frame, within a chord error (mm) on the faces of the tags in `fine` (all when not given).

    Other faces are within `tolerance.CHORD`, or `chord` where that is more. `Skin.bound` is what was measured on the fine ones.
    """
    chords = {
        tag: chord if fine is None or tag in fine else max(chord, tolerance.CHORD)
        for tag in part.tags
    }
    made = opened(part, chords, progress)
    wanted = np.isin(made.tag, [tag for tag in made.tag.tolist() if fine is None or tag in fine])
    return Skin(
        points=frame.to_local(made.points),
        normals=frame.local_direction(made.normals),
        triangles=made.triangles,
        face=made.tag[made.face],
        bound=float(made.bound[wanted].max(initial=0.0)),
    )
