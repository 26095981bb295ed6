"""What is known of a setup's freeform pockets while it is planned, and the form of every operation that is requested for them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from trunnion.findings import Refused, face_tags, warning
from trunnion.geometry.plane.region import Region
from trunnion.model.feature import Feature
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.choice import AreaCutters
from trunnion.plan.freeform.reach import AreaSamples
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.panel.freeform.pocket import FreeformPocket
from trunnion.plan.panel.freeform.settings import LeaningSettings
from trunnion.plan.panel.tasks import OperationTask, PanelPlanState
from trunnion.plan.prismatic.lean import POCKETS
from trunnion.plan.tool_choice import Candidates, ToolRequirement
from trunnion.settings import Value, choose
from trunnion.shop import Stage


@dataclass(slots=True, kw_only=True)
class FreeformPlanning:
    """What is known of a setup's freeform pockets while it is planned: their spaces, and the cutters of their sides and curved floors with
    the samples that these were chosen by, all cutters that finish them by surface passes, the ids of those whose overhang rims are cut, and
    by their ids the cutters whose flank finishes walls of theirs, with the tags of these, and those for the feet of walls that lean over.
    """

    curved: SurfaceSpace
    settings: LeaningSettings
    pockets: dict[str, FreeformPocket | None] = field(default_factory=dict)
    cutters: dict[tuple[str, str], tuple[AreaSamples, AreaCutters]] = field(default_factory=dict)
    finishing: dict[str, list[Tool]] = field(default_factory=dict)
    rims: set[str] = field(default_factory=set)
    swarf: dict[str, tuple[Tool, tuple[int, ...]] | None] = field(default_factory=dict)
    feet: dict[str, Tool | None] = field(default_factory=dict)


def planning_of(state: PanelPlanState) -> FreeformPlanning | None:
    if state.curved is None:
        return None
    if state.freeform is None:
        state.freeform = FreeformPlanning(
            curved=state.curved(), settings=choose(LeaningSettings, state.choices)
        )
    known: FreeformPlanning = state.freeform
    return known


def pockets_of(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[tuple[FreeformPlanning, FreeformPocket]]:
    """Return the freeform pockets of a stage; one without free space is told of once and left out."""
    mine = [
        f
        for f in features
        if f.kind in stage.on and f.kind in POCKETS and state.space.is_freeform(f)
    ]
    known = planning_of(state) if mine else None
    if known is None:
        return []
    for feature in state.progress.each(mine):
        if feature.id not in known.pockets:
            try:
                known.pockets[feature.id] = FreeformPocket.of(
                    feature,
                    state.space,
                    known.curved,
                    state.adjacent.get(feature.id, frozenset()),
                )
            except Refused as reason:
                known.pockets[feature.id] = None
                state.findings.append(
                    warning("route.not-planned", str(reason), feature.id, *face_tags(feature.tags))
                )
    return [(known, p) for f in mine if (p := known.pockets[f.id]) is not None]


def layer_height(pocket: FreeformPocket, settings: LeaningSettings) -> float:
    """Return the largest height of a pocket's layers in mm: their steps stand out of the leaning walls by no more than is wanted."""
    lean = settings.step / pocket.growth if pocket.growth > 0.0 else math.inf
    return min(lean, settings.layer) if pocket.curved else lean


def kept_off(area: Region, distance: float) -> Region:
    return area.offset(-distance) or area


def pocket_task(
    state: PanelPlanState,
    stage: Stage,
    pocket: FreeformPocket,
    id: str,
    requirement: ToolRequirement,
    faces: tuple[int, ...],
    choices: Mapping[str, Value],
    engagement: Callable[[Tool], tuple[float, float]],
    found: Candidates | None = None,
    why: str = "",
) -> OperationTask:
    low, high = pocket.mouth.box()
    middle = 0.5 * (low + high)
    return OperationTask(
        id=id,
        stage=stage,
        feature=pocket.feature.id,
        position=(float(middle[0]), float(middle[1])),
        requirement=requirement,
        faces=faces,
        height=state.space.top - pocket.bottom,
        width=float(np.min(high - low)),
        found=found,
        why=why,
        choices=choices,
        engagement=engagement,
    )
