"""Panels in the window: pockets, ribs, islands and walls look as features of any family do."""

from __future__ import annotations

from trunnion_gui.families.contract import FamilyView


class PanelView(FamilyView):
    """The view of panels."""

    name = "panel"
    allowance_kinds = ("pocket", "open_pocket", "island", "rib", "boss", "profile")
