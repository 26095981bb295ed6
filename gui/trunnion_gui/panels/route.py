"""Panel 4: the route: setups, operations and the plan they come from."""

from __future__ import annotations

from trunnion_gui.i18n import tr
from trunnion_gui.look.words import amount, counted
from trunnion_gui.widgets.panel import Panel


class RoutePanel(Panel):
    """From features to operations."""

    command = "step.route"

    def fill(self) -> None:
        process = self.document.shown.process
        if process is None:
            self.result.setText("")
            return
        cut = [o for o in process.operations if not o.suppressed]
        offsets = ", ".join(
            f"{s.name} {s.work_offset} · {tr('safe height')} {amount(s.clearance, 1)} mm"
            for s in process.setups
        )
        numbers = (
            f"{counted(len(cut), tr('operation'))} · {counted(len(process.tools()), tr('tool'))}"
        )
        self.result.setText(f"{numbers} · {tr('plan')} {process.plan}<br>{offsets}")
