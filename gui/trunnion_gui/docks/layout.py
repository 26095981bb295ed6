"""The docks of every part, and where they stand at first."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QWidget

from trunnion_gui.arrangement import BELOW, RIGHT, Arrangement
from trunnion_gui.docks.code import CodeDock
from trunnion_gui.docks.deviation import DeviationDock
from trunnion_gui.docks.features import FeatureDock
from trunnion_gui.docks.listing import ListingDock
from trunnion_gui.docks.messages import MessagesDock
from trunnion_gui.docks.process import ProcessDock
from trunnion_gui.docks.properties import PropertiesDock
from trunnion_gui.document import Document
from trunnion_gui.families.views import Views
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import Theme

Tab = tuple[str, str, QWidget]
"""Name, title and what stands in a dock."""


class Docks:
    """What stands right of the picture and below it; families' own docks are tabs below."""

    def __init__(self, document: Document, views: Views) -> None:
        self._views = views
        self.features, self.process = FeatureDock(document, views), ProcessDock(document)
        self.properties, self.messages = PropertiesDock(document, views), MessagesDock(document)
        self.code, self.listing, self.deviation = (
            CodeDock(document),
            ListingDock(document),
            DeviationDock(document),
        )

    def table(self) -> tuple[tuple[Qt.DockWidgetArea, tuple[Tab, ...]], ...]:
        """Return, area by area from above, the docks that stand behind each other, the first one in front."""
        return (
            (
                RIGHT,
                (
                    ("features", tr("Features"), self.features),
                    ("process", tr("Process tree"), self.process),
                ),
            ),
            (RIGHT, (("properties", tr("Properties"), self.properties),)),
            (
                BELOW,
                (
                    ("messages", tr("Messages"), self.messages),
                    ("code", tr("G-code"), self.code),
                    ("listing", tr("Listing"), self.listing),
                    ("deviation", tr("Deviation"), self.deviation),
                    *(
                        (dock.name, dock.title, dock.widget)
                        for view in self._views
                        for dock in view.docks()
                    ),
                ),
            ),
        )

    def arrange(self, arrangement: Arrangement) -> None:
        """Put all docks into a window."""
        for area, tabs in self.table():
            if len(tabs) > 1:
                arrangement.add_tabs(area, *tabs)
            else:
                arrangement.add(*tabs[0], area)

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        for dock in (self.process, self.messages, self.code, self.deviation):
            dock.use_theme(theme)
