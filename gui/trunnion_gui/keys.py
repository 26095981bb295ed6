"""What colours mean: which face has which, and the rows of the legend that explain them."""

from __future__ import annotations

from collections.abc import Sequence

from trunnion.model.feature import Feature, Recognition
from trunnion.report.palette import GROUP
from trunnion_gui.colours import (
    Theme,
    axis_colour,
    class_colours,
    feature_colours,
    kind_colour,
    motions,
    radius_colour,
    radius_steps,
    stock_colours,
    tool_colours,
)
from trunnion_gui.i18n import tr
from trunnion_gui.words import kind_words, sentence

Row = tuple[str, str, str]
"""Colour, words and count; without a colour a heading, without words either a gap."""
GAP: Row = ("", "", "")


def features_by_face(found: Recognition) -> dict[int, str]:
    """Return the colour of every face by tag; the smaller feature wins a face that two features have, as it wins the click."""
    colours = dict.fromkeys(found.unexplained, kind_colour("unexplained"))
    own = feature_colours(found)
    for feature in sorted(found, key=lambda f: -len(f.tags)):
        colours.update(dict.fromkeys(feature.tags, own[feature.id]))
    return colours


def radii_by_face(found: Recognition) -> dict[int, str]:
    """Return the colour of the smallest concave radius of each face's group, by tag; faces without one are left out."""
    return {tag: radius_colour(radius) for f in found for tag in f.tags if (radius := concave_radius(f)) is not None}


def features(found: Recognition) -> list[Row]:
    """Return the rows of what was found: kinds with their number, groups of equal patches in their two classes."""
    rows = []
    for kind, n in found.counts().items():
        if kind != GROUP:
            rows.append((kind_colour(kind), sentence(tr(kind_words(kind))), str(n)))
            continue
        local = sum(bool(f.attributes.get("local")) for f in found.of_kind(GROUP))
        counted = zip(class_colours(), (tr("Remaining area"), tr("Local features")), (n - local, local), strict=True)
        rows += [(colour, words, str(count)) for colour, words, count in counted if count]
    if found.unexplained:
        rows.append((kind_colour("unexplained"), tr("Unexplained"), str(len(found.unexplained))))
    return rows


def radii() -> list[Row]:
    """Return the rows of the steps of radii."""
    return [("", tr("Smallest concave radius"), ""), *((colour, words, "") for colour, words in radius_steps())]


def paths(shown: Sequence[str], any_leans: bool) -> list[Row]:
    """Return the rows of the kinds of motion that are shown; of the strokes along the tool, where any leans."""
    rows = [(motions()[m], sentence(tr(m)), "") for m in shown]
    return [*rows, (axis_colour(), tr("Tool axis"), "")] if any_leans and "cut" in shown else rows


def playing(theme: Theme) -> list[Row]:
    """Return the rows of the playback: stock, tool, and the way of the tip."""
    raw, cut = stock_colours(theme)
    tool = tool_colours()
    return [(raw, tr("Blank"), ""), (cut, tr("Cut surface"), ""), GAP,
            *((tool[name], sentence(tr(name)), "") for name in ("cutter", "shank", "holder")), GAP,
            *((tool[name], sentence(tr(name)), "") for name in ("feed", "rapid"))]


def concave_radius(feature: Feature) -> float | None:
    """Return the smallest concave radius of a group of patches in mm, None where nothing is concave."""
    value = feature.sizes.get("concave_radius")
    return float(value) if isinstance(value, (int, float)) and 0.0 < value < float("inf") else None
