"""What a family of parts brings to the window; as it stands here, the view of families that bring nothing of their own.

A family's view is a subclass under the entry-point group `trunnion.views`, with the family's name. One of each is made for a window; all of
them add their commands, but what they have to show appears only with features of their kinds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QMenu, QWidget

from trunnion.model.feature import Feature, Recognition
from trunnion_gui.document import Document
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import Theme, kind_colour, kind_label
from trunnion_gui.look.words import amount, sentence

if TYPE_CHECKING:
    from trunnion_gui.menus.window_access import WindowAccess

SIZES = ("diameter", "depth", "thickness", "height", "feature_size")
"""Names of sizes, the most important one of a feature first."""
LegendRow = tuple[str, str, str]
"""Colour, words and count; without a colour a heading, without words either a gap."""


def nothing(_feature: Feature) -> str:
    """Return no words."""
    return ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Column:
    """A column of the feature table that one family fills: its title and tip, and what stands in the row of a feature.

    With `is_ticked` a row has a mark instead of words, and `click` is called when the cell is clicked.
    """

    title: str
    tip: str
    words: Callable[[Feature], str] = nothing
    cell_tip: Callable[[Feature], str] = nothing
    is_ticked: Callable[[Feature], bool] | None = None
    click: Callable[[Feature], None] | None = None


@dataclass(frozen=True, slots=True)
class FeatureClass:
    """Features that stand together in table and legend, never none: `name` distinguishes classes, the rest is shown."""

    name: str
    words: str
    colour: str
    features: tuple[Feature, ...]


@dataclass(frozen=True, slots=True)
class Colouring:
    """Other colours of the part than those of its features: the colour of faces by tag, and the rows of the legend."""

    by_face: Callable[[Recognition], dict[int, str]]
    legend: Callable[[], Sequence[LegendRow]]


@dataclass(frozen=True, slots=True)
class Dock:
    """A dock of a family's own: the name it is shown by, its title, and what stands in it."""

    name: str
    title: str
    widget: QWidget


class FamilyView:
    """The look of one family in a window, and what a person can do with its features. A subclass changes what is its own."""

    name = ""
    """The family."""
    kinds: tuple[str, ...] = ()
    """The kinds of feature that this view presents; each kind has one view at most."""
    has_own_colours = False
    """Whether every feature has a colour of its own, which its row in the table shows."""

    allowance_kinds: tuple[str, ...] = ()
    """The kinds of feature that a person may have material left on, as the family's planner says."""

    def __init__(self, document: Document) -> None:
        self.document = document

    # settings

    def owns(self, group: str) -> bool:
        """Return whether a group of settings is for parts of this family alone."""
        return bool(self.name) and self.name in group.split(".")

    # table, legend, words

    def headings(self) -> tuple[str, str]:
        """Return the titles of the columns with a feature's id and its number of faces."""
        return tr("Feature"), tr("Faces")

    def columns(self) -> tuple[Column, ...]:
        """Return the columns behind id, faces and size; hidden while the part has no features of these kinds."""
        return ()

    def classes(self, kind: str, features: Sequence[Feature]) -> tuple[FeatureClass, ...]:
        """Return the classes that the features of a kind stand in."""
        return (
            FeatureClass(kind, sentence(tr(kind_label(kind))), kind_colour(kind), tuple(features)),
        )

    def size(self, feature: Feature) -> str:
        """Return the most important size of a feature, in mm, with the fit or the thread that is demanded; empty without one."""
        found = main_size(feature)
        words = (f"{found} mm" if found else "", *demanded(feature))
        return " ".join(w for w in words if w)

    def remark(self, found: Recognition) -> str:
        """Return what is reported after the counts of a recognition."""
        return ""

    # menus

    def add_face_entries(self, menu: QMenu, tags: tuple[int, ...]) -> None:
        """Add what may be done with some faces to a menu."""

    def add_feature_entries(self, menu: QMenu, feature: Feature) -> None:
        """Add what may be done with a feature of this view to a menu, besides what may be done with any feature."""

    # the window

    def blocks(self) -> dict[str, QWidget]:
        """Return what stands below the results of panels, by the name of the panel."""
        return {}

    def docks(self) -> tuple[Dock, ...]:
        """Return docks that stand as tabs below the picture, behind those that every family has."""
        return ()

    def use_theme(self, theme: Theme) -> None:
        """Draw docks and blocks in the colours of a theme."""

    def add_commands(self, window: WindowAccess) -> None:
        """Add commands to a window's registry; what they reach of the window is made later."""

    def begin(self, window: WindowAccess) -> None:
        """Take up work in a window whose picture is there, before its panels and docks are."""


def demanded(feature: Feature) -> tuple[str, ...]:
    """Return the fit or the thread that is demanded of a feature, as a drawing has it."""
    given = (feature.attributes.get(name) for name in ("fit", "thread"))
    return tuple(str(words) for words in given if words)


def main_size(feature: Feature, names: Iterable[str] = SIZES) -> str:
    """Return the first of some sizes that a feature has, without its unit; empty without any."""
    return next((amount(feature.sizes[name], 2) for name in names if name in feature.sizes), "")
