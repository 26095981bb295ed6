"""How a tool comes into the spindle and to the first point of a section; lines without their numbers.

After a tool change, and where the rotary axes must unwind, they turn at the top of the machine; then XY on top, then down with the tool's
length.
"""

from __future__ import annotations

from collections.abc import Iterator

from trunnion.model.motion.toolpath import Motion
from trunnion.model.tool import AnyTool
from trunnion.post.words import plain
from trunnion.post.writer.modal import WrittenState

LONGEST_NAME = 32
"""Characters of a tool's name that tool tables hold."""


def tool_change(modal: WrittenState, tool: AnyTool, spindle: str) -> Iterator[str]:
    """Yield the lines that bring a tool into the spindle, which is to turn at a speed; where it is is not known after them."""
    filled = {"tool": tool.number, "name": plain(tool.name, LONGEST_NAME), "spindle": spindle}
    yield from (line.format(**filled) for line in modal.words.tool_change)
    modal.tool, modal.at, modal.coolant = tool.number, None, "off"


def coolant(modal: WrittenState, wanted: str) -> Iterator[str]:
    """Yield the lines that switch the coolant; another one is switched off before."""
    if modal.coolant not in ("off", wanted):
        yield modal.words.coolant["off"]
    yield modal.words.coolant[wanted]
    modal.coolant = wanted


def approach(
    modal: WrittenState, tool: AnyTool, point: list[int], angle: list[int], changed: bool
) -> Iterator[str]:
    """Yield the lines of the first rapid, to a point and angles in ticks; `changed` after a tool change."""
    words, rapid = modal.words, modal.rapid
    plane_words = modal.plane.words(point, modal.scale.text)
    across = " ".join(w for w in plane_words if not w.startswith("Z"))
    down = next(w for w in plane_words if w.startswith("Z"))
    turn = " ".join(
        f"{letter}{modal.degrees.text(v)}" for letter, v in zip(modal.letters, angle, strict=True)
    )
    length = words.tool_length.format(tool=tool.number)
    unwinds = not changed and angle != (modal.angle or [])
    if unwinds:
        yield words.top
    if changed or unwinds:
        if turn:
            yield rapid([turn])
        yield rapid([across])
        yield rapid([length, down])
    else:
        yield from [length] if length else []
        yield rapid([across, down, turn])
    modal.reached(point, angle, Motion.RAPID)
    modal.feed = ""
