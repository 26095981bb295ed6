"""Kinds of features that casings have ("Feature-based automatic NC programming for aero-engine casings", 3.1): boss, hole, profile, pocket.

They share names, words and colours with those of other families; colours are those of Okabe and Ito (2008).
"""

from __future__ import annotations

from trunnion.recognize.contract import FeatureKind

BOSS, HOLE, PROFILE, POCKET = "boss", "hole", "profile", "pocket"
TOP, SIDE, ROOT_FILLET = "top", "side", "root_fillet"
FACE = "face"
BOTTOM, RESTRICT = "bottom", "restrict"

AROUND = ("theta", "theta_low", "theta_high", "toe_theta_low", "toe_theta_high")
"""Sizes that count from the frame's x, degrees."""
ALONG = ("z", "z_low", "z_high", "toe_z_low", "toe_z_high", "x", "y", "top_z", "half_angle", "tilt")
"""Sizes that count from the lower end face, and which end is the lower one the file says."""

KINDS = (
    FeatureKind(name=BOSS, label="boss", colour="#e69f00", along_axes=(*AROUND, *ALONG)),
    FeatureKind(name=HOLE, label="hole", colour="#cc79a7", along_axes=("x", "y", "top_z")),
    FeatureKind(name=PROFILE, label="profile", colour="#009e73", along_axes=("z_low", "z_high")),
    FeatureKind(name=POCKET, label="pocket", colour="#0072b2", along_axes=(*ALONG,)),
)
