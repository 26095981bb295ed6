"""Curved surfaces in the window: groups of equal patches in two classes, the remaining area and local features, with their radii."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtWidgets import QMenu, QWidget

from trunnion.model.feature import Feature, Recognition
from trunnion_gui.document import Document
from trunnion_gui.families.contract import (
    Colouring,
    Column,
    Dock,
    FamilyView,
    FeatureClass,
    main_size,
)
from trunnion_gui.families.surface import appearance
from trunnion_gui.families.surface.accuracy import AccuracyDock
from trunnion_gui.families.surface.areas import AreasBlock
from trunnion_gui.families.surface.commands import add_commands
from trunnion_gui.families.surface.cutting import CutBar
from trunnion_gui.families.surface.efficiency import EfficiencyBlock
from trunnion_gui.families.surface.estimate import EstimateSource
from trunnion_gui.families.surface.export import ExportDialog
from trunnion_gui.families.surface.groups import GROUP, is_local
from trunnion_gui.families.surface.jobs import PatchJobs
from trunnion_gui.families.surface.tools import PatchTools
from trunnion_gui.i18n import tr
from trunnion_gui.look import icons
from trunnion_gui.look.colours import Theme
from trunnion_gui.menus.window_access import WindowAccess
from trunnion_gui.widgets.layout import stacked


class SurfaceView(FamilyView):
    """The view of curved surfaces."""

    name = "surface"
    kinds = (GROUP,)
    has_own_colours = True
    by_radius = Colouring(appearance.radii_by_face, appearance.radius_legend)

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self.jobs = PatchJobs(document)
        self.tools = PatchTools(document, self.jobs)
        self.estimate = EstimateSource(document)
        self.areas, self.accuracy = AreasBlock(document), AccuracyDock(document, self.jobs)
        self.efficiency = EfficiencyBlock(document)
        self.optimizing = stacked(self.areas, self.efficiency)
        self.estimate.arrived.connect(self.areas.show_estimate)
        self.tools.cut_wanted.connect(self.begin_cut)

    def headings(self) -> tuple[str, str]:
        return tr("Group"), tr("n")

    def columns(self) -> tuple[Column, ...]:
        return (
            *appearance.radius_columns(),
            Column(
                title=tr("Local"),
                tip=tr("A local feature gets a cutter of its own; click to change"),
                is_ticked=is_local,
                click=lambda f: self.tools.set_local([f.id], not is_local(f)),
            ),
        )

    def classes(self, kind: str, features: Sequence[Feature]) -> tuple[FeatureClass, ...]:
        return appearance.classes(kind, features)

    def size(self, feature: Feature) -> str:
        return main_size(feature)

    def remark(self, found: Recognition) -> str:
        local = sum(is_local(f) for f in found.of_kind(GROUP))
        return tr(", {n} of them local features").format(n=local) if local else ""

    def add_face_entries(self, menu: QMenu, tags: tuple[int, ...]) -> None:
        self.tools.add_entries(menu, tags)

    def add_feature_entries(self, menu: QMenu, feature: Feature) -> None:
        self.tools.add_entries(menu, feature.tags)
        selected = self.document.selection.current
        if selected.kind == "faces" and not set(selected.faces) <= set(feature.tags):
            menu.addAction(
                icons.icon("move_faces"),
                tr("Take the selected faces in"),
                lambda: self.jobs.move(selected.faces, feature.id),
            )

    def add_commands(self, window: WindowAccess) -> None:
        add_commands(self, window)

    def begin(self, window: WindowAccess) -> None:
        self.cutting = CutBar(self.document, self.jobs, window.viewport.scene)
        window.viewport.add_bar(self.cutting)
        window.viewport.add_tool(self.cutting)
        self.export_dialog = ExportDialog(self.document, self.jobs, window.viewport.window())

    def begin_cut(self, face: int, by_plane: bool) -> None:
        """Begin to cut a face (0: the one that is clicked next), by a plane or along a line that is drawn."""
        if self.document.has_part:
            self.cutting.begin(face, by_plane)

    def blocks(self) -> dict[str, QWidget]:
        return {"optimize": self.optimizing}

    def docks(self) -> tuple[Dock, ...]:
        return (Dock("accuracy", tr("Size error"), self.accuracy),)

    def use_theme(self, theme: Theme) -> None:
        self.accuracy.use_theme(theme)
        self.efficiency.use_theme(theme)
