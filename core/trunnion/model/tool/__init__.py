"""Tools: rotating ones (mills, drills) in their holders, and turning tools with their inserts."""

from trunnion.findings import BadInput
from trunnion.model.tool.holder import Holder as Holder
from trunnion.model.tool.insert import CORNERS as CORNERS
from trunnion.model.tool.insert import Insert as Insert
from trunnion.model.tool.insert import TurningTool as TurningTool
from trunnion.model.tool.lead import BORING_BAR as BORING_BAR
from trunnion.model.tool.lead import FINISHING as FINISHING
from trunnion.model.tool.lead import REAMER as REAMER
from trunnion.model.tool.lead import TAP as TAP
from trunnion.model.tool.mill import T_SLOT as T_SLOT
from trunnion.model.tool.rotating import BUTTON as BUTTON
from trunnion.model.tool.rotating import FORMS as FORMS
from trunnion.model.tool.rotating import PLAIN_FORMS as PLAIN_FORMS
from trunnion.model.tool.rotating import Tool as Tool
from trunnion.model.tool.thread_mill import THREAD_MILL as THREAD_MILL

AnyTool = Tool | TurningTool
"""A tool that an operation may hold: one that rotates, or one that stands still while the work turns."""


def rotating(tool: AnyTool, operation: str) -> Tool:
    """Return a tool that rotates; raise `BadInput` for a turning tool."""
    if isinstance(tool, Tool):
        return tool
    raise BadInput(
        f"operation {operation}: {tool.name} is a turning tool; this needs one that rotates"
    )
