"""LinuxCNC's tool table: a tool a line, in letters with numbers, in the unit of the machine.

Source: LinuxCNC user manual, "Tool Table Format", and the reader that loads it (`tooldata_common.cc`, `emctool.h` of release 2.9).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from trunnion.findings import BadInput
from trunnion.shop.cutters import Cutter
from trunnion.shop.exchange.assumptions import all_completed, read_tools
from trunnion.shop.exchange.contract import ExchangeContext, ReadTools, WrittenTools
from trunnion.shop.exchange.description import ToolDescription, text
from trunnion.shop.exchange.files import MOST_TOOLS, read_bytes, text_in
from trunnion.shop.exchange.numbering import numbered
from trunnion.shop.exchange.readback import lost
from trunnion.shop.exchange.scaling import scaled, unscaled

LONGEST_COMMENT = 39
"""Bytes of a comment that LinuxCNC keeps (`CANON_TOOL_COMMENT_SIZE`, which counts a closing zero)."""
MOST_POCKETS = 1000
"""The highest pocket (`CANON_POCKETS_MAX` less one)."""
_WORD = re.compile(
    r"([TPDXYZABCUVWIJQ])([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]{1,3})?)", re.IGNORECASE
)
_WHOLE = "TPQ"
_OFFSETS = "XYABCUVW"
_LATHE = "IJQ"
_ENDS = str.maketrans({"\t": " ", "\r": " "})


class LinuxCncFormat:
    """Tool tables, `tool.tbl`. A line holds number, pocket, diameter, length and a comment: all else of a tool is assumed."""

    name = "linuxcnc"
    title = "LinuxCNC's tool table"
    suffixes = (".tbl",)

    def read(self, path: Path, context: ExchangeContext) -> ReadTools:
        """Return the tools of a table; its comments become their names."""
        return read_tools(_described(text_in(read_bytes(path), path), str(path), context), context)

    def write(
        self, cutters: Sequence[Cutter], path: Path, context: ExchangeContext
    ) -> WrittenTools:
        """Return the table; tools without a number get the lowest free ones, and every tool the pocket of its number where there is one."""
        numbers, invented = numbered(cutters)
        used = [n for n in numbers if n <= MOST_POCKETS]
        spare = iter(sorted(set(range(1, MOST_POCKETS + 1)) - set(used)))
        lines = []
        for cutter, number in zip(cutters, numbers, strict=True):
            pocket = number if number <= MOST_POCKETS else next(spare, None)
            if pocket is None:
                raise BadInput(
                    f"{path}: a table has room for {MOST_POCKETS} tools; got {len(cutters)}"
                )
            lines.append(_line(cutter, number, pocket, context))
        table = "".join(lines)
        requested = [
            replace(c, tool=replace(c.tool, number=n))
            for c, n in zip(cutters, numbers, strict=True)
        ]
        again = all_completed(_described(table, str(path), context), context)
        losses = (*invented, *lost(requested, again, self.title, _REASONS))
        return WrittenTools(files={path: table.encode()}, losses=losses)


_REASONS = {
    "name": f"a comment keeps {LONGEST_COMMENT} bytes on one line",
    "gauge_length": "without the holder the length alone can't be checked",
}


def _line(cutter: Cutter, number: int, pocket: int, context: ExchangeContext) -> str:
    tool = cutter.tool
    diameter, length = (unscaled(v, context.scale) for v in (tool.diameter, tool.gauge_length))
    return f"T{number} P{pocket} D{diameter!r} Z{length!r} ;{_comment(tool.name)}\n"


def _comment(name: str) -> str:
    """Return a name as a comment holds it: one line, cut to what LinuxCNC keeps."""
    return (
        text(name, "", "name")
        .encode("utf-8", "replace")[:LONGEST_COMMENT]
        .decode("utf-8", "ignore")
        .strip()
    )


def _described(table: str, source: str, context: ExchangeContext) -> Iterator[ToolDescription]:
    lines = table.split("\n")
    if len(lines) > MOST_TOOLS:
        raise BadInput(f"{source}: {len(lines)} lines are more than the {MOST_TOOLS} that are read")
    for n, line in enumerate(lines, 1):
        words, _, comment = line.translate(_ENDS).partition(";")
        if words.strip():
            yield _tool(words.split(), comment, f"{source}: line {n}", context)


def _tool(words: list[str], comment: str, source: str, context: ExchangeContext) -> ToolDescription:
    found = _words(words, source)
    if "T" not in found or "P" not in found:
        raise BadInput(f"{source}: a tool needs a number T and a pocket P")
    description = ToolDescription(source=source)
    values = description.values
    values["number"] = int(found["T"])
    name = text(comment, source, "the comment")
    if name:
        values["name"] = name
    if found.get("D", 0.0) != 0.0:
        values["diameter"] = scaled(found["D"], context.scale)
    if found.get("Z", 0.0) > 0.0:
        values["gauge_length"] = scaled(found["Z"], context.scale)
    elif "Z" in found:
        description.ignore("Z", found["Z"], "no length of a tool: an offset from another one")
    if found["P"] != found["T"]:
        description.ignore("P", int(found["P"]), "the catalogue has no pockets")
    for letter in _OFFSETS:
        description.ignore(letter, found.get(letter), "the catalogue has no offsets")
    if any(found.get(letter) for letter in _LATHE):
        description.refusal = "it is a turning tool (I, J or Q): the table doesn't say which"
    return description


def _words(words: list[str], source: str) -> dict[str, float]:
    found: dict[str, float] = {}
    for word in words:
        match = _WORD.fullmatch(word)
        if match is None:
            raise BadInput(
                f"{source}: {word[:20]!r} is not understood; since LinuxCNC 2.4 a table has T P D X Y Z A B C U V W I J Q with numbers"
            )
        letter, value = match[1].upper(), float(match[2])
        if letter in found:
            raise BadInput(f"{source}: {letter} stands twice")
        if abs(value) > _FARTHEST or (letter in _WHOLE and (value != int(value) or value < 0.0)):
            raise BadInput(f"{source}: {letter} can't be {match[2][:20]}")
        found[letter] = value
    return found


_FARTHEST = 2.0**31
"""Above the numbers of tools that the control's integers hold, and any length."""
