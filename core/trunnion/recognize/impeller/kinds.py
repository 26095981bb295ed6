"""Kinds of features that impellers have, and the roles of their faces. Colours are those of Okabe and Ito (2008) and Tol (2021)."""

from __future__ import annotations

from trunnion.recognize.contract import FeatureKind

BLADE, SPLITTER, HUB, BORE, PLANE, PROFILE, HOLE = (
    "blade",
    "splitter",
    "hub",
    "bore",
    "plane",
    "profile",
    "hole",
)
SHROUD, PRESSURE, SUCTION, ROOT_FILLET = "shroud", "pressure", "suction", "root_fillet"
LEADING_EDGE, TRAILING_EDGE = "leading_edge", "trailing_edge"
FACE, SIDE, CHAMFER = "face", "side", "chamfer"
PAIR = "pair"
"""The attribute of the two features that are programmed for all: one neighbouring pair of blades."""

KINDS = (
    FeatureKind(name=BLADE, label="blade", colour="#0072b2"),
    FeatureKind(name=SPLITTER, label="splitter", colour="#e69f00"),
    FeatureKind(name=HUB, label="hub", colour="#44aa99"),
    FeatureKind(name=BORE, label="bore", colour="#882255"),
    FeatureKind(name=PLANE, label="plane", colour="#c9ced3"),
    FeatureKind(name=PROFILE, label="profile", colour="#009e73"),
    FeatureKind(name=HOLE, label="hole", colour="#cc79a7"),
)
