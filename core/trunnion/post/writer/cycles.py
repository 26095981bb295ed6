"""Drilling cycles in the words of a control: a line a hole, as long as the control's cycle goes just as the path does."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.model.motion.cycle import CycleKind
from trunnion.model.motion.toolpath import Motion
from trunnion.model.spindle import FeedMode
from trunnion.post.iso_words import code_of
from trunnion.post.ticks import WrittenCycle, WrittenPath
from trunnion.post.writer.feed import dwell_text
from trunnion.post.writer.modal import WrittenState


@dataclass(slots=True, kw_only=True)
class CycleSeries:
    """Cycles of one kind, peck and dwell that follow each other.

    `level` is Z where they began, `bottom` and `retract` those of the last hole, in ticks.
    """

    kind: CycleKind
    deep: tuple[str, ...]
    level: int
    bottom: int | None = None
    retract: int | None = None


class CycleWriter:
    """Writes the cycles of a section. Where the control has none, or would end one elsewhere, their motions are to be written out."""

    def __init__(self, modal: WrittenState) -> None:
        self.modal, self.words = modal, modal.words
        self.series: CycleSeries | None = None
        self.returns = ""

    def lines(self, path: WrittenPath, block: WrittenCycle) -> list[str]:
        """Return the lines of a cycle, none where its motions must be written out."""
        kind, modal = block.cycle.kind, self.modal
        if kind not in self.words.cycles or modal.feeds.mode is FeedMode.INVERSE:
            return []
        height = path.point[block.first - 1].tolist()[2]
        if kind in self.words.fed_to_plane and block.end != block.retract:
            return []
        series, before = self.series_of(block, height), self.series
        if series is None:
            return []
        ended = self.ended() if series is not before else []
        self.series = series
        line = self.line(path, block, series)
        modal.reached(path.point[block.last].tolist(), modal.angle or [], -1)
        return [*ended, line]

    def series_of(self, block: WrittenCycle, height: int) -> CycleSeries | None:
        """Return the series that a cycle goes on with or begins, from a height in ticks; None where neither goes and ends as it does.

        A control that is below the level where a series began, and not above the retract plane, goes to the next hole and up at once; one
        whose series began below the retract plane goes down to that before it goes to the hole. Both are left to the motions themselves.
        """
        if height < block.retract and not self.words.rises_first:
            return None
        begun = CycleSeries(kind=block.cycle.kind, deep=self.deep(block), level=height)
        known, plane = self.series, block.retract
        if known is not None and (known.kind, known.deep) == (begun.kind, begun.deep):
            returns = height > plane and block.end == known.level
            if min(height, known.level) >= plane and (block.end == plane or returns):
                return known
        return begun if block.end == plane or (height > plane and block.end == height) else None

    def deep(self, block: WrittenCycle) -> tuple[str, ...]:
        """Return the words of peck and dwell."""
        letters, cycle, scale = self.words.letters, block.cycle, self.modal.scale
        peck = scale.text(int(scale.ticks(np.array(cycle.peck))))
        found = [letters["peck"] + peck] if cycle.peck > 0.0 else []
        if cycle.kind is CycleKind.DWELL or cycle.kind is CycleKind.BORE:
            dwell = dwell_text(cycle.dwell, self.words.dwell_parts) if cycle.dwell else "0"
            found.append(letters["dwell"] + dwell)
        return tuple(found)

    def line(self, path: WrittenPath, block: WrittenCycle, series: CycleSeries) -> str:
        """Return the words of one hole: what changes, but always where it is."""
        modal, words, text = self.modal, self.words, self.modal.scale.text
        parts, (x, y, _) = [], path.point[block.last].tolist()
        if modal.feeds.mode is not modal.feed_mode:
            parts.append(modal.switched(modal.feeds.mode))
        returns = words.return_levels[block.end == block.retract]
        if returns != self.returns:
            parts.append(returns)
        begins = series.bottom is None
        if begins:
            parts.append(words.cycles[series.kind])
        parts += ["X" + text(x), "Y" + text(y)]
        if block.bottom != series.bottom:
            parts.append("Z" + text(block.bottom))
        if block.retract != series.retract:
            parts.append(words.letters["retract"] + text(block.retract))
        parts += series.deep if begins else ()
        if (feed := modal.feed_text(feed_of(path, block), x)) != modal.feed:
            parts.append("F" + feed)
        modal.feed, self.returns = feed, returns
        series.bottom, series.retract = block.bottom, block.retract
        return " ".join(parts)

    def ended(self) -> list[str]:
        """Return the line that ends a series, none where there is none or the next motion ends it."""
        code = code_of(self.words, "no motion") if self.series is not None else ""
        self.series = None
        return [code] if code else []


def feed_of(path: WrittenPath, block: WrittenCycle) -> float:
    """Return the feed of a cycle in mm/min."""
    rows = slice(block.first, block.last + 1)
    return float(path.feed[rows][path.motion[rows] != Motion.RAPID][0])
