"""The sizes, tolerances, fits and threads that a part file gives of its faces, for features and planning.

Defined on the floor of geometry, below the part that carries them.
"""

from __future__ import annotations

from trunnion.geometry.dimension import DIAMETER, Dimension

__all__ = ["DIAMETER", "Dimension"]
