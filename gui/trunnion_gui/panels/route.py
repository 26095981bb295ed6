"""Panel 4: the route: setups, operations, the plan they come from, and the plan library."""

from __future__ import annotations

from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import Theme
from trunnion_gui.look.words import amount, counted
from trunnion_gui.panels.library import LibraryBlock
from trunnion_gui.widgets.panel import Panel


class RoutePanel(Panel):
    """From features to operations."""

    command = "step.route"

    def build(self) -> None:
        super().build()
        self.library = LibraryBlock(self.document, self.registry)
        self.content.addWidget(self.library)

    def use_theme(self, theme: Theme) -> None:
        self.library.use_theme(theme)
        super().use_theme(theme)

    def fill(self) -> None:
        self.library.follow()
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
