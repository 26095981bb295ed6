"""What colours mean: which face has which, and the rows of the legend that explain them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from trunnion.model.feature import Recognition
from trunnion.model.guides import GuideCurve
from trunnion_gui.families.contract import LegendRow
from trunnion_gui.families.views import Views
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import (
    Theme,
    axis_colour,
    feature_colours,
    guide_colours,
    kind_colour,
    motions,
    stock_colours,
    tool_colours,
)
from trunnion_gui.look.words import sentence

GAP: LegendRow = ("", "", "")


def features_by_face(found: Recognition) -> dict[int, str]:
    """Return the colour of every face by tag; the smaller feature wins a face that two features have, as it wins the click."""
    colours = dict.fromkeys(found.unexplained, kind_colour("unexplained"))
    own = feature_colours(found)
    for feature in sorted(found, key=lambda f: -len(f.tags)):
        colours.update(dict.fromkeys(feature.tags, own[feature.id]))
    return colours


def features(found: Recognition, views: Views) -> list[LegendRow]:
    """Return the rows of what was found: the classes of features with their number."""
    rows = [(c.colour, c.words, str(len(c.features))) for c in views.classes(found)]
    if found.unexplained:
        rows.append((kind_colour("unexplained"), tr("Unexplained"), str(len(found.unexplained))))
    return rows


def paths(shown: Sequence[str], any_leans: bool) -> list[LegendRow]:
    """Return the rows of the kinds of motion that are shown; of the strokes along the tool, where any leans."""
    rows = [(motions()[m], sentence(tr(m)), "") for m in shown]
    return [*rows, (axis_colour(), tr("Tool axis"), "")] if any_leans and "cut" in shown else rows


def guides(lines: Sequence[GuideCurve]) -> list[LegendRow]:
    """Return the rows of the kinds of guide lines and corners that are shown, with their number."""
    kinds = Counter(line.kind.value for line in lines)
    relations = Counter(r.value for line in lines for r in line.relations)
    colour = guide_colours()
    return [
        (colour[name], tr(words), str(count[name]))
        for count, known in ((kinds, _GUIDES), (relations, _RELATIONS))
        for name, words in known.items()
        if count[name]
    ]


_GUIDES = {
    "wall": "Guide line",
    "foot": "Foot of a wall beside",
    "area": "Rim of an area",
    "axis": "Axis",
    "contour": "Contour",
}
_RELATIONS = {
    "TO": "Comes to the next wall",
    "PAST": "Goes past the end",
    "TANTO": "Goes on tangentially",
}


def playing(theme: Theme) -> list[LegendRow]:
    """Return the rows of the playback: stock, tool, and the path of the tip."""
    raw, cut = stock_colours(theme)
    tool = tool_colours()
    return [
        (raw, tr("Blank"), ""),
        (cut, tr("Cut surface"), ""),
        GAP,
        *((tool[name], sentence(tr(name)), "") for name in ("cutter", "shank", "holder")),
        GAP,
        *((tool[name], sentence(tr(name)), "") for name in ("feed", "rapid")),
    ]
