"""Reads Sinumerik text, ours or edited by hand, into motions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from trunnion.findings import BadInput
from trunnion.model.setup import Setup
from trunnion.model.tool import AnyTool
from trunnion.post.iso_words import IsoWords
from trunnion.post.readers.numbers import shown
from trunnion.post.readers.sinumerik.blocks import DWELL_WORD, split_sinumerik_line
from trunnion.post.readers.sinumerik.modes import SinumerikModes
from trunnion.post.readers.sinumerik.moves import SinumerikMover
from trunnion.post.readers.tip_modes import TipControl
from trunnion.post.readers.word_address.blocks import Block
from trunnion.post.words import plain
from trunnion.shop.kinematics import WorkPosition


class SinumerikControl(TipControl):
    """A Sinumerik: words with `=`, calls of cycles, TRAORI and CYCLE800."""

    modes_class = SinumerikModes
    mover_class = SinumerikMover

    def __init__(
        self,
        words: IsoWords,
        tools: Mapping[int, AnyTool],
        setup: Setup,
        work_position: WorkPosition | None,
    ) -> None:
        # F of a dwell is a word of its own here: the reader must not take it for a feed.
        letters = {**words.letters, "dwell": DWELL_WORD}
        super().__init__(replace(words, letters=letters), tools, setup, work_position)

    def split(self, number: int, line: str) -> tuple[Block | None, tuple[str, ...]]:
        """Return the words of a line and its comment."""
        return split_sinumerik_line(number, line, self.number_of)

    def number_of(self, line: int, name: str) -> float:
        """Return the number of the tool with a name, as names are written; raise `BadInput` unless there is just one."""
        found = [n for n, t in self.state.tools.items() if _bare(t.name) == _bare(name)]
        if len(found) != 1:
            known = ", ".join(t.name for t in self.state.tools.values())
            what = "is not in the tool list" if not found else "is the name of several tools"
            raise BadInput(f'line {line}: T="{shown(name)}" {what}; it has {known}')
        return float(found[0])

    def run(self, block: Block) -> None:
        """Do what one line says, then the cycle that it calls, or that is in force at its position."""
        modes, moves = self.modes, self.moves
        assert isinstance(modes, SinumerikModes) and isinstance(moves, SinumerikMover)
        before = modes.cycle
        super().run(block)
        if modes.called is not None:
            cycle, modes.called = modes.called, None
            moves.cut_cycle(block, cycle)
        elif (
            before is not None
            and before is modes.cycle
            and not {"X", "Y", "Z"}.isdisjoint(block.words)
        ):
            if self.language.machine in block.codes:
                raise BadInput(
                    f"line {block.line}: {self.language.machine} while {before.name} is in force; put MCALL first"
                )
            moves.cut_cycle(block, before)


def _bare(name: str) -> str:
    """Return a tool's name without what its spelling in a text may differ by: case, spaces and underscores."""
    return plain(name, 1000).casefold().replace(" ", "").replace("_", "")
