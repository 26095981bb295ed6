"""Tools: rotating ones (mills, drills) in their holders, and turning tools with their inserts."""

from trunnion.model.tool.holder import Holder as Holder
from trunnion.model.tool.insert import CORNERS as CORNERS
from trunnion.model.tool.insert import Insert as Insert
from trunnion.model.tool.insert import TurningTool as TurningTool
from trunnion.model.tool.rotating import FORMS as FORMS
from trunnion.model.tool.rotating import PLAIN_FORMS as PLAIN_FORMS
from trunnion.model.tool.rotating import Tool as Tool
