"""Colours of the window: the same data for table, legend, viewport and report (`resources/palette`)."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from trunnion.model.feature import Recognition
from trunnion.report.lines import AXIS, MOTIONS
from trunnion.report.palette import OTHER, Palette, load_palette
from trunnion_gui.look.words import kind_words

Rgb = tuple[int, int, int]
READABLE = 4.5
"""Contrast that small words need (WCAG 2, AA)."""


@dataclass(frozen=True, slots=True)
class Theme:
    """The window's colours as `#rrggbb`: one accent, the rest calm."""

    name: str
    window: str
    panel: str
    raised: str
    line: str
    text: str
    muted: str
    accent: str
    accent_text: str
    accent_soft: str
    good: str
    warning: str
    bad: str
    view_top: str
    view_bottom: str
    part: str
    edge: str
    selection: str


@cache
def _themes() -> dict[str, dict[str, str]]:
    return json.loads((files("trunnion_resources") / "palette" / "themes.json").read_text("utf-8"))


@cache
def _palette() -> dict[str, dict[str, str]]:
    return tomllib.loads(
        (files("trunnion_resources") / "palette" / "palette.toml").read_text("utf-8")
    )


@cache
def palette() -> Palette:
    """Return the palette that reports use too."""
    return load_palette()


@cache
def theme(name: str) -> Theme:
    """Return the theme `light` or `dark`."""
    return Theme(name=name, **_themes()[name])


def kinds() -> tuple[str, ...]:
    """Return the kinds of feature that families declare, and the one that represents all others."""
    return (*palette().kinds, OTHER)


_last_colours: list[tuple[Recognition, dict[str, str]]] = []


def feature_colours(found: Recognition) -> dict[str, str]:
    """Return the colour of every feature by id: its kind's, or one of its own.

    Those of the last recognition are kept: table, picture and legend show the same one.
    """
    if not _last_colours or _last_colours[0][0] is not found:
        given = palette().features(found, found.neighbours)
        _last_colours[:] = [(found, {id: hexed(colour) for id, colour in given.items()})]
    return _last_colours[0][1]


def motions() -> dict[str, str]:
    """Return the colour of every kind of motion."""
    return {name: colour for name, colour in _palette()["motions"].items() if name in MOTIONS}


def machine_time() -> dict[str, str]:
    """Return the colour of every part of machining time."""
    return _palette()["machine_time"]


def axis_colour() -> str:
    """Return the colour of the strokes that show how a leaning tool stands."""
    return _palette()["motions"][AXIS]


def guide_colours() -> dict[str, str]:
    """Return the colours of guide lines by kind, and of the places where their elements meet by how."""
    return _palette()["guides"]


def tool_colours() -> dict[str, str]:
    """Return the colours of cutter, shank and holder, and of the tip's path by feed and by rapid."""
    return _palette()["tool"]


def tool_cycle(numbers: Sequence[int]) -> tuple[str, ...]:
    """Return a colour for each of some tools by their number, the same for the same tool."""
    wheel: Sequence[str] = _palette()["tools"]["wheel"]
    rows = {number: n for n, number in enumerate(dict.fromkeys(numbers))}
    return tuple(wheel[rows[number] % len(wheel)] for number in numbers)


def stock_colours(new_theme: Theme) -> tuple[str, str]:
    """Return the colours of the blank's own surface and of what was cut."""
    raw, cut = (_palette()["stock"][name] for name in ("blank", "cut"))
    return (
        (mixed(raw, new_theme.part, 0.3), mixed(cut, new_theme.part, 0.3))
        if new_theme.name == "dark"
        else (raw, cut)
    )


def kind_colour(kind: str) -> str:
    """Return the colour of a kind; kinds without one of their own share that of `other`."""
    return hexed(palette().kind(kind))


def kind_label(kind: str) -> str:
    """Return what a feature of a kind is called, in English; a kind that no family declares by its name."""
    declared = palette().kinds.get(kind)
    return declared.label if declared else kind_words(kind)


def rgb(colour: str) -> Rgb:
    """Return red, green and blue (0 to 255).

    >>> rgb("#4477aa")
    (68, 119, 170)
    """
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)


def hexed(colour: Rgb) -> str:
    """Return red, green and blue (0 to 255) as `#rrggbb`.

    >>> hexed((68, 119, 170))
    '#4477aa'
    """
    return "#{:02x}{:02x}{:02x}".format(*colour)


def mixed(colour: str, other: str, share: float) -> str:
    """Return a colour with a share of another one.

    >>> mixed("#000000", "#ffffff", 0.5)
    '#808080'
    """
    return "#" + "".join(
        f"{round(a + (b - a) * share):02x}" for a, b in zip(rgb(colour), rgb(other))
    )


def contrast(colour: str, ground: str) -> float:
    """Return how well a colour can be read on another, from 1 (not at all) to 21, as WCAG 2 counts it.

    >>> round(contrast("#000000", "#ffffff")), round(contrast("#777777", "#777777"))
    (21, 1)
    """

    def light(of: str) -> float:
        shares = [c / 255.0 for c in rgb(of)]
        linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in shares]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    dark, bright = sorted((light(colour), light(ground)))
    return (bright + 0.05) / (dark + 0.05)


def readable(colour: str, ground: str, text: str) -> str:
    """Return a colour for words on a ground: itself, or with as much of the text's colour as it takes to be read.

    >>> readable("#1660a8", "#ffffff", "#1d2733")
    '#1660a8'
    """
    return next(
        (
            c
            for c in (mixed(colour, text, n / 10.0) for n in range(10))
            if contrast(c, ground) >= READABLE
        ),
        text,
    )
