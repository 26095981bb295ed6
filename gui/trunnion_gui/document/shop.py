"""The shop as the window has it: the catalogues, what is in the machines, and tool libraries on their way in and out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from trunnion.shop.crib import Crib, CribTool
from trunnion_gui.storage import preferences
from trunnion_gui.worker import shop_requests
from trunnion_gui.worker.requests import Work
from trunnion_gui.worker.shop_requests import LibraryExchange, ShopView

if TYPE_CHECKING:
    from trunnion_gui.document.document import Document

ONLY_IN_MACHINE = "route.only_in_machine"
"""Key of the setting that plans with the tools in the machine alone."""
_MACHINE = "shopMachine"


class ShopCatalogue(QObject):
    """What the worker has of the shop (`view`, None before it was requested) and the `machine` whose crib is shown."""

    changed = Signal()
    """There are other catalogues or cribs, or another machine is shown."""
    requested = Signal()
    """The worker was asked for something; what is shown stays until it replies."""
    replied = Signal()
    """The worker has replied."""
    read = Signal(object)
    """A `LibraryExchange` that a person may take over."""
    taken = Signal(object)
    """A `LibraryExchange` that was taken over."""
    written = Signal(object)
    """A `LibraryExchange` that was written."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._document = document
        self.view: ShopView | None = None
        self.machine = ""

    @property
    def crib(self) -> Crib:
        """The tools in the machine that is shown."""
        found = self.view.cribs.get(self.machine) if self.view is not None else None
        return found or Crib(machine=self.machine)

    @property
    def is_waiting(self) -> bool:
        """Whether the worker has not replied yet: it may be at a job."""
        return self.view is None or any(map(self._document.jobs.awaits, _REQUESTS))

    def loaded(self, name: str) -> CribTool | None:
        """Return a tool of the machine that is shown by its name, None where it is not there."""
        return self.crib.tool(name)

    def refresh(self) -> None:
        """Request the catalogues anew."""
        self._document.jobs.forget(shop_requests.view)
        self._document.jobs.query(shop_requests.view, finish=self._take_view)

    def show_machine(self, machine: str) -> None:
        """Show the crib of another machine, at the next start too."""
        if machine and machine != self.machine:
            self.machine = machine
            preferences.remember(_MACHINE, machine)
            self.changed.emit()

    def put(self, name: str, number: int = 0, pocket: int = 0) -> None:
        """Put a tool into the machine, or give it another T number and pocket."""
        self._change(shop_requests.put, name, number, pocket)

    def take(self, name: str) -> None:
        """Take a tool out of the machine."""
        self._change(shop_requests.take, name)

    def set_wear(self, name: str, length: float, radius: float) -> None:
        """Keep the measured wear of a tool in the machine."""
        self._change(shop_requests.wear, name, length, radius)

    def read_library(self, path: str, unit: str = "mm") -> None:
        """Read a tool library to see what taking it over would bring and lose."""
        self._document.jobs.forget(shop_requests.read_library)
        self._query(shop_requests.read_library, path, unit, finish=self.read.emit)

    def take_library(self, path: str, unit: str) -> None:
        """Take a tool library over into the user's folder."""
        self._query(shop_requests.take_library, path, unit, finish=self._finish_taken)

    def write_library(self, names: tuple[str, ...], path: str) -> None:
        """Write tools as a library of another program."""
        self._query(
            shop_requests.write_library, names, path, self.machine, finish=self.written.emit
        )

    def _change(self, work: Work, *arguments: Any) -> None:
        self._query(work, self.machine, *arguments, finish=self._take_cribs)

    def _query(self, work: Work, *arguments: Any, finish: Any) -> None:
        def finished(value: Any) -> None:
            finish(value)
            self.replied.emit()

        self._document.jobs.query(work, *arguments, finish=finished)
        self.requested.emit()

    def _take_view(self, view: ShopView) -> None:
        self.view = view
        known = [m.name for m in view.machines]
        if self.machine not in known:
            process = self._document.session.process
            planned = process.setups[0].machine if process is not None and process.setups else ""
            remembered = preferences.word(_MACHINE)
            wanted = (self.machine, planned, remembered, *view.cribs, *known)
            self.machine = next((m for m in wanted if m in known), "")
        self.changed.emit()

    def _take_cribs(self, cribs: Mapping[str, Crib]) -> None:
        if self.view is not None:
            view = self.view
            self.view = ShopView(view.tools, view.machines, view.materials, view.formats, cribs)
        self.changed.emit()
        self._document.refresh_states()

    def _finish_taken(self, taken: LibraryExchange) -> None:
        self.taken.emit(taken)
        self.refresh()
        self._document.refresh_groups()
        self._document.refresh_states()


_REQUESTS: tuple[Work, ...] = (
    shop_requests.view,
    shop_requests.put,
    shop_requests.take,
    shop_requests.wear,
    shop_requests.read_library,
    shop_requests.take_library,
    shop_requests.write_library,
)
