"""Words written where they belong: one size, or the names of what is there."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from trunnion_gui.look.colours import Theme


def draw_label(view: Any, text: str, at: tuple[float, ...], theme: Theme) -> None:
    """Write a text at a point of the part, or nothing when the text is empty."""
    view.remove_actor("size", render=False)
    view.remove_actor("size-labels", render=False)
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
