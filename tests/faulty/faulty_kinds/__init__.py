"""A package of its own, for the tests, whose kind of part ends the process that looks at prisms: by a crash, by its memory, or never."""

from __future__ import annotations

import os
import time

import numpy as np

from trunnion.recognize.contract import Suitability

SIDES = {"crash": 5, "memory": 7, "sleep": 9}
"""Sides of the prisms by what happens to who looks at them."""
_BLOCK = 1 << 25
"""Numbers in a piece of the memory that is taken: 256 MB."""


class FaultyKind:
    """Prisms that nobody can look at."""

    name, noun = "faulty", "a faulty prism"

    def suits(self, graph):
        """Return that no part is one, unless it is a prism of `SIDES`."""
        sides = len(graph) - 2
        if sides == SIDES["crash"]:
            os.abort()
        kept = []
        while sides == SIDES["memory"]:
            kept.append(np.ones(_BLOCK))
            time.sleep(0.02)
        while sides == SIDES["sleep"]:
            time.sleep(0.02)
        return Suitability(score=0.0, explained=0.0, reason="no prism to crash at")
