"""The window of the shop beside the main one: tools, machines and materials, and what is in the machines."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QCloseEvent
from PySide6.QtWidgets import QLabel, QTabWidget, QVBoxLayout, QWidget

from trunnion.findings import Finding
from trunnion_gui.document import Document
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import Theme
from trunnion_gui.shop.catalogue_page import CataloguePage
from trunnion_gui.shop.tools_page import ToolsPage
from trunnion_gui.storage import preferences
from trunnion_gui.widgets.notice import Notice

_GEOMETRY = "shopGeometry"


class ShopWindow(QWidget):
    """Follows the document's shop. It is never modal: the main window works on beside it."""

    def __init__(self, document: Document, parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Window)
        self._shop = document.shop
        self.setObjectName("shop")
        self.setWindowTitle(f"{tr('Shop')} – Trunnion")
        self.setWindowIcon(parent.windowIcon())
        self.resize(1180, 760)
        self.notice = Notice()
        self.waiting = QLabel(tr("Reading the catalogues; a running job is finished first"))
        self.waiting.setObjectName("muted")
        self.tools = ToolsPage(document)
        self.machines = CataloguePage(tr("Control"), "machines")
        self.materials = CataloguePage(tr("Group"), "materials")
        self.pages = QTabWidget()
        self.pages.setDocumentMode(True)
        for page, words in (
            (self.tools, tr("Tools")),
            (self.machines, tr("Machines")),
            (self.materials, tr("Materials")),
        ):
            self.pages.addTab(page, words)
        lines = QVBoxLayout(self)
        lines.setContentsMargins(0, 0, 0, 4)
        lines.addWidget(self.notice)
        lines.addWidget(self.pages, 1)
        lines.addWidget(self.waiting)
        self.waiting.setContentsMargins(10, 0, 10, 4)
        for signal in (self._shop.changed, self._shop.requested, self._shop.replied):
            signal.connect(self.follow)
        document.jobs.changed.connect(self.follow)
        document.noticed.connect(self._report)
        geometry = preferences.arrangement(_GEOMETRY)
        if geometry is not None:
            self.restoreGeometry(geometry)

    def open(self, page: str) -> None:
        """Show the window at a page (`tools`, `machines`, `materials`), with the catalogues as they are now."""
        pages = {"tools": self.tools, "machines": self.machines, "materials": self.materials}
        self.pages.setCurrentWidget(pages[page])
        self._shop.refresh()
        self.follow()
        self.show()
        self.raise_()
        self.activateWindow()

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self.tools.use_theme(theme)

    def follow(self) -> None:
        """Show the catalogues and whether the worker still has to reply."""
        self.waiting.setVisible(self._shop.is_waiting)
        view = self._shop.view
        if view is not None:
            self.machines.show_rows(view.machines)
            self.materials.show_rows(view.materials)

    def closeEvent(self, event: QCloseEvent) -> None:
        preferences.remember(_GEOMETRY, self.saveGeometry())
        super().closeEvent(event)

    def _report(self, finding: Finding) -> None:
        if self.isVisible():
            self.notice.show_finding(finding)
            self.tools.reload()
            self.follow()
