"""Drilling cycles of controls that say a cycle once and then the positions it is cut at, a line a hole."""

from __future__ import annotations

import numpy as np

from trunnion.model.motion.cycle import BACK_OFF
from trunnion.model.motion.toolpath import Motion
from trunnion.model.spindle import FeedMode
from trunnion.post.ticks import WrittenCycle, WrittenPath
from trunnion.post.writer.cycles import feed_of
from trunnion.post.writer.feed import dwell_text
from trunnion.post.writer.modal import WrittenState
from trunnion.units import trimmed


class CycleCallWriter:
    """Writes the cycles of a section as calls. Where the control goes another way, their motions are to be written out."""

    def __init__(self, modal: WrittenState) -> None:
        self.modal, self.words = modal, modal.words
        self.call = ""

    def lines(self, path: WrittenPath, block: WrittenCycle) -> list[str]:
        """Return the lines of a cycle, none where its motions must be written out."""
        kind, modal = block.cycle.kind, self.modal
        template = self.words.cycle_calls.get(kind)
        height = int(path.point[block.first - 1, 2])
        if template is None or modal.feeds.mode is FeedMode.INVERSE or height < block.retract:
            return []
        if kind in self.words.fed_to_plane and block.end != block.retract:
            return []
        x, y, _ = path.point[block.last].tolist()
        feed = modal.feed_text(feed_of(path, block), x)
        call = template.format(**self.values(block, feed))
        lines = []
        if call != self.call:
            lines = self.defined(call, feed)
            self.call = call
        lines.append(self.position(x, y))
        modal.reached(path.point[block.last].tolist(), modal.angle or [], Motion.RAPID)
        return lines

    def defined(self, call: str, feed: str) -> list[str]:
        """Return the lines that say a cycle for the positions after them, and its feed."""
        modal = self.modal
        switch = (
            [modal.switched(modal.feeds.mode)] if modal.feeds.mode is not modal.feed_mode else []
        )
        fed = [*switch, "F" + feed] if switch or feed != modal.feed else []
        modal.feed = feed
        return [*self.ended(), *([" ".join(fed)] if fed else []), call]

    def position(self, x: int, y: int) -> str:
        """Return the line of a hole, its place in ticks."""
        text = self.modal.scale.text
        return self.modal.rapid([f"X{text(x)}", f"Y{text(y)}"])

    def values(self, block: WrittenCycle, feed: str) -> dict[str, str]:
        """Return what stands in the braces of a call: heights, peck and pitch as lengths, the dwell in seconds."""
        cycle, modal = block.cycle, self.modal
        scale = modal.scale
        peck = int(scale.ticks(np.array(cycle.peck)))
        return {
            "end": scale.text(block.end),
            "plane": scale.text(block.retract),
            "bottom": scale.text(block.bottom),
            "first": scale.text(block.retract - peck),
            "peck": scale.text(peck),
            "back_off": scale.text(int(scale.ticks(np.array(BACK_OFF)))),
            "dwell": dwell_text(cycle.dwell, self.words.dwell_parts) if cycle.dwell else "0",
            "feed": feed,
            "pitch": trimmed(cycle.pitch / scale.unit, PITCH_DECIMALS),
            "spindle": trimmed(modal.feeds.spindle, 0),
        }

    def ended(self) -> list[str]:
        """Return the line that ends a cycle, none where there is none."""
        begun, self.call = self.call, ""
        return [self.words.cycle_end] if begun and self.words.cycle_end else []


PITCH_DECIMALS = 6
"""Decimals of a pitch: 20 threads an inch are 1.27 mm, 11 are 2.309091 mm."""
