"""Kinds of features that panels have, and the pocket paper's model of a pocket.

"Slicing Recognition of Aircraft Integral Panel Generalized Pocket" (2.2): centre, top, bottom, guide profile (each guide line by the part
face it lies on), islands, auxiliary features, identification. Colours are those of Okabe and Ito (2008).
"""

from __future__ import annotations

from trunnion.model.feature import Feature, GeneralizedPocket, Recognition, Size
from trunnion.recognize.contract import FeatureKind

GUIDES = ("wall", "inner_convergence", "outer_convergence", "corner")
"""Roles of the faces that a guide profile's lines lie on."""


def generalized_pocket(feature: Feature, found: Recognition) -> GeneralizedPocket:
    """Return the paper's model of a pocket, made from what the feature already says."""
    inside = tuple(
        f for f in found if feature.id in (f.attributes.get("in"), f.attributes.get("nested_in"))
    )
    attributes = feature.attributes
    return GeneralizedPocket(
        identification=str(attributes.get("identification", feature.kind.replace("_", " "))),
        through=bool(attributes.get("through", not feature.with_role("floor"))),
        centre=_centre(attributes.get("centre")),
        top=_height(feature, "top_z"),
        bottom=_height(feature, "floor_z"),
        guide=tuple(f for f in feature.faces if f.role in GUIDES),
        islands=tuple(f for f in inside if f.kind == "island"),
        auxiliary=tuple(f for f in inside if f.kind != "island"),
    )


def _centre(value: Size | None) -> tuple[float, ...]:
    if not isinstance(value, tuple) or len(value) not in (2, 3):
        return ()
    return tuple(float(v) for v in value)


def _height(feature: Feature, size: str) -> float | None:
    value = feature.sizes.get(size)
    return float(value) if isinstance(value, (int, float)) else None


KINDS = (
    FeatureKind(name="pocket", label="pocket", colour="#0072b2", pocket=generalized_pocket),
    FeatureKind(
        name="open_pocket", label="open pocket", colour="#56b4e9", pocket=generalized_pocket
    ),
    FeatureKind(name="island", label="island", colour="#e69f00"),
    FeatureKind(name="rib", label="rib", colour="#d55e00"),
    FeatureKind(name="pit", label="pit", colour="#882255"),
    FeatureKind(name="fringe", label="fringe", colour="#44aa99"),
    FeatureKind(name="profile", label="profile", colour="#009e73"),
    FeatureKind(name="chamfer", label="chamfer", colour="#999933"),
    FeatureKind(name="datum", label="datum", colour="#c9ced3"),
    FeatureKind(name="hole", label="hole", colour="#cc79a7"),
    FeatureKind(name="boss", label="boss", colour="#e69f00"),
)
"""What the recogniser makes, and what else a person may call a feature of a panel."""
