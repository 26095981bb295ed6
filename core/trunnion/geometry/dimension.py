"""A dimension of faces: a size that a file gives as data (semantic PMI), with its tolerance, fit and thread.

It lies on this floor because the part carries it: the part knows nothing of the model. `model.dimension` is where features and planning
take it from.
"""

from __future__ import annotations

from dataclasses import dataclass

DIAMETER = "diameter"
"""The kind of dimension that ISO 10303-47 calls a `dimensional_size` named diameter."""


@dataclass(frozen=True, slots=True)
class Dimension:
    """A size of faces as a file gives it, in mm whatever the file's unit.

    `kind` is `DIAMETER`; `value` the nominal size, of a file that gives nothing but limits the lower one (the upper one where there is no
    lower); `upper` and `lower` the deviations from `value`, None where the file gives none; `fit` a tolerance class of ISO 286-1 ("H7",
    holes in capitals) or ""; `thread` its designation as the file writes it ("M6x1", "1/4-20 UNC") or ""; `text` what the file calls the
    dimension; `faces` the 1-based tags of the faces of the chosen solid that have this size, ascending. The `value` of a thread may be its
    own diameter (12 of M12) while the faces are those of the hole that it is cut in (10.2).
    """

    kind: str
    value: float
    upper: float | None = None
    lower: float | None = None
    fit: str = ""
    thread: str = ""
    text: str = ""
    faces: tuple[int, ...] = ()
