"""Turned discs in the window: what is turned and what is milled, and an edge that may be left sharp."""

from __future__ import annotations

from dataclasses import replace

from trunnion_gui.actions import Command
from trunnion_gui.edits import recognition_of
from trunnion_gui.families.contract import Column, FamilyView, FeatureClass
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import kind_colour
from turned_disc.kinds import BEVEL, END, RIM, SHARP, SLOT


def left_sharp(id, value):
    """Return the edit that leaves a bevel uncut, or has it cut again."""

    def edit(session):
        found = recognition_of(session)
        features = tuple(
            replace(f, attributes={**f.attributes, SHARP: value}, by_hand=True) if f.id == id else f
            for f in found
        )
        return replace(session, recognition=replace(found, features=features))

    return edit


class TurnedDiscView(FamilyView):
    """The view of turned discs."""

    name = "turned_disc"
    kinds = (END, RIM, BEVEL, SLOT)

    def owns(self, group):
        return super().owns(group) or group == "disc.bevel"

    def columns(self):
        return (
            Column(
                title=tr("Sharp"),
                tip=tr("The edge stays as the rim leaves it"),
                is_ticked=lambda f: bool(f.attributes.get(SHARP)),
                click=self.turn,
            ),
        )

    def classes(self, kind, features):
        words = (
            tr("Milled")
            if kind == SLOT
            else f"{tr('Turned')} · {super().classes(kind, features)[0].words}"
        )
        return (FeatureClass(kind, words, kind_colour(kind), tuple(features)),)

    def add_feature_entries(self, menu, feature):
        if feature.kind == BEVEL:
            words = (
                tr("Cut the bevel") if feature.attributes.get(SHARP) else tr("Leave the edge sharp")
            )
            menu.addAction(words, lambda: self.turn(feature))

    def add_commands(self, shell):
        shell.registry.add(
            Command(
                id="disc.sharp",
                text="Leave the edge sharp",
                menu="Disc",
                help="Do not cut the bevel of the selected rim",
                run=self.turn_selected,
                enabled=lambda: self.selected() is not None,
            )
        )

    def selected(self):
        """Return the selected bevel, None where another thing is selected."""
        feature = self.document.feature(self.document.selection.current.id)
        return feature if feature is not None and feature.kind == BEVEL else None

    def turn_selected(self):
        """Leave the selected bevel uncut, or have it cut again."""
        if (feature := self.selected()) is not None:
            self.turn(feature)

    def turn(self, feature):
        """Leave a bevel uncut, or have it cut again."""
        if feature.kind == BEVEL:
            value = not feature.attributes.get(SHARP)
            self.document.edit(tr("Leave the edge sharp"), left_sharp(feature.id, value))
