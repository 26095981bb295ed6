"""Kinds of features of a turned disc."""

from __future__ import annotations

from trunnion.recognize.contract import FeatureKind

END, RIM, BEVEL, SLOT = "disc_end", "disc_rim", "disc_bevel", "disc_slot"
SHARP = "left_sharp"
"""The attribute of a bevel that is not cut: the edge stays as the rim leaves it."""

KINDS = (
    FeatureKind(name=END, label="disc end", colour="#b8c4ce"),
    FeatureKind(name=RIM, label="disc rim", colour="#117733"),
    FeatureKind(name=BEVEL, label="rim bevel", colour="#cc6677"),
    FeatureKind(name=SLOT, label="milled slot", colour="#332288"),
)
