"""Reads text in word-address format, by a dialect's words and control."""

from __future__ import annotations

from collections.abc import Sequence

from trunnion.model.motion.program import Program
from trunnion.model.setup import Setup
from trunnion.model.tool import AnyTool
from trunnion.post.iso_words import IsoWords
from trunnion.post.readers.tools import by_number
from trunnion.post.readers.word_address.interpreter import Control
from trunnion.shop.kinematics import WorkPosition


def read_iso(
    text: str,
    tools: Sequence[AnyTool],
    setup: Setup,
    work_position: WorkPosition | None,
    words: IsoWords,
    control: type[Control] = Control,
) -> Program:
    """Return the motions of one setup's text, with the line of each block; raise `BadInput` naming the line of what isn't understood.

    `tools` are found by their T number; operations by our comments, else they are called `line N`. `work_position` says where the work
    stands on a machine with rotary axes.
    """
    on_rotary = (
        work_position if work_position is not None and work_position.machine.rotary else None
    )
    return control(words, by_number(tools), setup, on_rotary).read(text)
