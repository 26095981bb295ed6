"""Words written where they belong: one size, or the names of what is there."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from trunnion_gui.look.colours import Theme


def draw_label(
    view: Any, text: str, at: tuple[float, ...], theme: Theme, to: tuple[float, ...] = ()
) -> None:
    """Write a text at a point of the part, or nothing when the text is empty; a distance has a line to the point `to`, its text midway."""
    for name in ("size", "size-labels", "size-points", "dimension"):
        view.remove_actor(name, render=False)
    if text and len(to) == len(at):
        view.add_lines(
            np.array([at, to], dtype=float), color=theme.selection, width=4, name="dimension"
        )
        at = tuple(0.5 * (a + b) for a, b in zip(at, to, strict=True))
    if text:
        view.add_point_labels(
            np.array([at], dtype=float),
            [text],
            name="size",
            font_size=15,
            text_color=theme.text,
            shape_color=theme.panel,
            shape_opacity=0.92,
            point_color=theme.selection,
            point_size=11,
            always_visible=True,
            pickable=False,
            reset_camera=False,
            shape="rounded_rect",
            margin=5,
        )


def draw_names(
    view: Any, names: Sequence[tuple[str, tuple[float, float, float]]], theme: Theme
) -> None:
    """Write words at places of the part, or nothing; those that would lie on others are left out."""
    view.remove_actor("names", render=False)
    view.remove_actor("names-labels", render=False)
    view.remove_actor("names-points", render=False)
    if names:
        view.add_point_labels(
            np.array([position for _, position in names], dtype=float),
            [words for words, _ in names],
            name="names",
            font_size=12,
            text_color=theme.text,
            shape_color=theme.panel,
            shape_opacity=0.85,
            show_points=False,
            always_visible=True,
            pickable=False,
            reset_camera=False,
            shape="rounded_rect",
            margin=3,
        )
