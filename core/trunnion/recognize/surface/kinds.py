"""The kind of features that parts of curved surfaces have: groups of equal patches in two classes."""

from __future__ import annotations

from trunnion.recognize.contract import FeatureKind, LegendClass

GROUP = "group"
"""A group of equal patches."""
LOCAL = "local"
"""The attribute of a local feature, which gets a cutter of its own."""

KINDS = (
    FeatureKind(
        name=GROUP,
        label="group",
        colour="#56b4e9",
        heading="Groups of equal patches",
        along_axes=("diagonal",),
        # Distinguished within their class by light and dark, the classes by cold and warm.
        classes=(
            LegendClass(
                label="groups of the remaining area",
                colours=("#56b4e9", "#0072b2", "#9ecbe8", "#3d6f99", "#1f8fc4", "#7d9cc0"),
            ),
            LegendClass(
                label="groups of local features",
                colours=("#e67700", "#c23b22", "#f08a5d", "#8c3b1a", "#d55e00", "#b5651d"),
                attribute=LOCAL,
            ),
        ),
    ),
)
