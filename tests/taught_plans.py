"""Signatures and taught plans that tests make by hand."""

from __future__ import annotations

from trunnion.shop import Stage
from trunnion.shop.library import PartSignature, TaughtOperation, TaughtPlan

RING = PartSignature(
    family="ring",
    features={"boss circle": 3, "boss lobe": 1, "hole": 4},
    sizes={"largest_diameter": 200.0, "wall_thickness": 3.0},
    material="Ti-6Al-4V",
    material_group="S",
    machine="5-axis mill",
)
"""A ring with four bosses and four holes."""


def stage(name: str, **changes) -> Stage:
    """Return a stage on bosses."""
    fields = {
        "kind": "finish",
        "strategy": "surface.waterline",
        "on": ("boss",),
        "cutter": "side",
        "finish": True,
        "after": (),
        "after_all": (),
        "rule": "It is finished.",
    }
    return Stage(name=name, **{**fields, **changes})


def plan(name: str = "ring A", signature: PartSignature = RING, **changes) -> TaughtPlan:
    """Return a plan with two stages."""
    fields = {
        "date": "2026-03-01",
        "part": "ring",
        "part_digest": "0123456789abcdef",
        "base": "Casing",
        "stages": (stage("sides"), stage("feet", on=("pocket",), after_all=("sides",))),
        "operations": (
            TaughtOperation(
                stage="sides",
                kind="boss",
                planned="EM D12",
                tool="EM D10",
                choices={"surface.waterline.scallop": 0.02},
                spindle=5000.0,
                feed=900.0,
                count=4,
            ),
        ),
        "settings": {"route.wall_allowance": 0.4},
    }
    return TaughtPlan(name=name, signature=signature, **{**fields, **changes})
