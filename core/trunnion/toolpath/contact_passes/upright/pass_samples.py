"""Positions along passes that stock is asked for at, and passes with long moves in steps: pieces of them end between two tips."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.toolpath.contact_passes.passes import Pass, spaced


@dataclass(frozen=True, slots=True, eq=False)
class PassSamples:
    """Positions `tips` (n, 3) along passes, the number `owner` (n,) of the pass that each is on, and the number `move` (n,) of its move on
    that."""

    tips: Floats
    owner: Ints
    move: Ints

    @staticmethod
    def on(passes: Sequence[Pass], step: float) -> PassSamples:
        """Return positions no farther apart than a step (mm)."""
        tips, owner, moves = list[Floats](), list[Ints](), list[Ints]()
        for k, one in enumerate(passes):
            positions, move = spaced(one.tip, step)
            tips.append(positions)
            moves.append(move)
            owner.append(np.full(len(positions), k))
        return PassSamples(np.concatenate(tips), np.concatenate(owner), np.concatenate(moves))


@dataclass(frozen=True, slots=True, eq=False)
class RefinedPass:
    """A pass with some of its moves in steps, and which of its tips (k,) are `new`."""

    path: Pass
    new: Bools

    @staticmethod
    def of(one: Pass, moves: Ints, step: float) -> RefinedPass:
        """Return a pass with some moves (m,) of it in steps of `step` mm at most."""
        tip, move = spaced(one.tip, step)
        new = np.diff(move, prepend=-1) == 0
        new[-1] = False
        rows = np.flatnonzero(~new | np.isin(move, moves))
        tip, move, new = tip[rows], move[rows], new[rows]
        if not new.any():
            return RefinedPass(one, new)
        start, end = one.tip[move], one.tip[move + 1]
        length = np.linalg.norm(end - start, axis=1)
        share = np.linalg.norm(tip - start, axis=1) / np.maximum(length, tolerance.PARAMETRIC)
        normal, axis = (_between(of, move, share) for of in (one.normal, one.axis))
        normal[~new], axis[~new] = one.normal, one.axis
        return RefinedPass(Pass(tip=tip, axis=axis, normal=normal, closed=one.closed), new)

    def piece(self, moves: slice) -> Pass:
        """Return what some moves cut, without tips that are new but for both ends."""
        kept = ~self.new
        kept[: moves.start] = kept[moves.stop + 1 :] = False
        kept[[moves.start, moves.stop]] = True
        return self.path.of(kept)


def _between(directions: Floats, move: Ints, share: Floats) -> Floats:
    """Return unit directions (n, 3) at shares of moves from one of the directions (k, 3) to the next; the first of the two where opposite
    ones have none half-way."""
    first = directions[move]
    found = first + share[:, None] * (directions[move + 1] - first)
    size = np.linalg.norm(found, axis=1, keepdims=True)
    return np.divide(found, size, out=first, where=size > tolerance.PARAMETRIC)
