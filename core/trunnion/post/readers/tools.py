"""What a text is read with, and whether the text was made for it: the tool list, and where the work stands."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from trunnion.findings import BadInput
from trunnion.model.setup import Setup
from trunnion.model.tool import AnyTool
from trunnion.post.header import tool_line, work_position_lines
from trunnion.post.readers.numbers import shown
from trunnion.post.words import plain
from trunnion.shop.kinematics import WorkPosition

_TOOL = re.compile(r"TOOL (\d+) .* HOLDER ")


def by_number(tools: Sequence[AnyTool]) -> dict[int, AnyTool]:
    """Return tools by their number; raise `BadInput` when two have the same."""
    found: dict[int, AnyTool] = {}
    for tool in tools:
        if found.setdefault(tool.number, tool) != tool:
            raise BadInput(
                f"two tools have the number {tool.number}: {found[tool.number].name} and {tool.name}"
            )
    return found


def check_tool(line: int, comment: str, tools: Mapping[int, AnyTool]) -> None:
    """Raise `BadInput` when a comment is our header's line of a tool and the tool list has another tool of that number."""
    found = _TOOL.match(comment)
    if found is None:
        return
    tool = next((t for n, t in tools.items() if str(n) == found.group(1)), None)
    if tool is None or comment not in [
        plain(tool_line(tool, units), len(comment)) for units in ("mm", "inch")
    ]:
        raise BadInput(
            f"line {line}: the text was made for another tool {shown(found.group(1))} than the tool list has; "
            "post the program anew"
        )


def check_work_position(
    line: int, comment: str, setup: Setup, work_position: WorkPosition | None
) -> None:
    """Raise `BadInput` when a comment is our header's line of where the work stands and it stands elsewhere now."""
    if work_position is None:
        raise BadInput(
            f"line {line}: the text was made for a machine with rotary axes, {setup.machine} has none; post the program anew"
        )
    if comment not in [
        plain(work_position_lines(setup, work_position, units)[0], len(comment))
        for units in ("mm", "inch")
    ]:
        raise BadInput(
            f"line {line}: the text was made for work that stands elsewhere on its machine; post the program anew"
        )
