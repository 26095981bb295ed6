"""Random panels on some features of which a person has material left on purpose, on walls, floors, tops and outlines.

The panels are those of other kinds of random parts; what a shop gets is a project in which the amounts have been typed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from random import Random

from seeded.edged_panels import edged_panel
from seeded.leaning_panels import leaning_panel
from seeded.panels import panel
from seeded.parts import Seeded
from trunnion.model.feature import Feature, Recognition

MAKERS = (panel, panel, edged_panel, leaning_panel)
AMOUNTS = (0.1, 0.2, 0.3, 0.5, 1.0)
"""mm: what is left for grinding, for fitting, or for another shop."""
SHARE = 0.4
"""Of the features that can keep anything, about so many do."""


@dataclass(frozen=True, slots=True)
class KeptPanel(Seeded):
    """A panel with the seed of what its features keep."""

    seed: int

    def written(self, folder: Path) -> Path:
        """Return a project in a folder in which the amounts stand."""
        from trunnion.pipeline import Engine
        from trunnion.pipeline.planning.allowances import with_feature_allowance

        engine = Engine()
        session = engine.open(Seeded.written(self, folder))
        session = replace(session, choices={"recognize.family": "panel"})
        session = engine.run(session, until="recognize")
        for id, wall, floor in _amounts(self.seed, session.recognition):
            session = with_feature_allowance(
                session, [id], wall_allowance=wall, floor_allowance=floor
            )
        path = folder / f"{self.name}.trunnion"
        engine.save(session, path)
        return path


def kept_panel(seed: int) -> KeptPanel:
    """Return the random panel of a seed."""
    made = MAKERS[seed % len(MAKERS)](seed)
    return KeptPanel(
        f"kept-{seed:02d}", made.shape, made.unit, made.counts, made.smallest_radius, seed
    )


def _amounts(seed: int, recognition: Recognition) -> list[tuple[str, float | None, float | None]]:
    """Return what some features keep on walls and on floors or tops, mm; None where there is nothing to keep it on."""
    from trunnion.plan.contract import allowance_planner

    draw = Random(f"kept {seed}")
    kinds = allowance_planner(recognition.family).allowance_kinds
    able = [f for f in recognition if f.kind in kinds]
    some = [f for f in able if draw.random() < SHARE] or able[:1]
    found = []
    for feature in some:
        wall, floor = draw.choice((0.0, *AMOUNTS)), draw.choice((0.0, *AMOUNTS))
        if _is_freeform(feature):
            wall = floor
        found.append(
            (
                feature.id,
                wall if feature.kind != "island" and feature.with_role("wall", *LEANING) else None,
                floor if feature.with_role("floor", "top") else None,
            )
        )
    return found


LEANING = ("inner_convergence", "outer_convergence")


def _is_freeform(feature: Feature) -> bool:
    """Return whether walls lean or a floor is curved: its operations leave one amount on all of its faces."""
    return bool(feature.with_role(*LEANING)) or "floor_z_max" in feature.sizes
