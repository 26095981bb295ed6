"""Every rule that a panel's typical plan may name for a stage's cutter."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from trunnion.model.feature import Feature
from trunnion.plan.panel.freeform.finishing_tasks import (
    curved_floor_tasks,
    curved_semi_tasks,
    floor_tasks,
    side_tasks,
    swarf_floor_tasks,
)
from trunnion.plan.panel.freeform.overhang_tasks import overhang_rim_tasks
from trunnion.plan.panel.freeform.roughing_tasks import layer_tasks, rest_layer_tasks
from trunnion.plan.panel.freeform.slope_tasks import slope_rough_tasks, slope_tasks
from trunnion.plan.panel.freeform.swarf_tasks import (
    leaning_fillet_tasks,
    overhung_floor_tasks,
    swarf_foot_tasks,
    swarf_rough_tasks,
    swarf_tasks,
)
from trunnion.plan.panel.hole_tasks import HOLE_TASK_MAKERS
from trunnion.plan.panel.outline_tasks import OUTLINE_TASK_MAKERS
from trunnion.plan.panel.pit_tasks import PIT_TASK_MAKERS
from trunnion.plan.panel.tasks import PLANE_TASK_MAKERS, OperationTask, PanelPlanState
from trunnion.shop import Stage

FREEFORM_TASK_MAKERS: Mapping[
    str, Callable[[PanelPlanState, Stage, Sequence[Feature]], list[OperationTask]]
] = {
    "layers": layer_tasks,
    "rest_layers": rest_layer_tasks,
    "leaning_floor": floor_tasks,
    "swarf_floor": swarf_floor_tasks,
    "overhang_rim": overhang_rim_tasks,
    "swarf_rough": swarf_rough_tasks,
    "swarf": swarf_tasks,
    "swarf_foot": swarf_foot_tasks,
    "leaning_fillet": leaning_fillet_tasks,
    "overhung_floor": overhung_floor_tasks,
    "sides": side_tasks,
    "curved_semi": curved_semi_tasks,
    "curved_floor": curved_floor_tasks,
    "slopes_rough": slope_rough_tasks,
    "slopes": slope_tasks,
}
"""The rule behind each word that a typical plan gives for the cutter of a stage on leaning walls, slopes and curved floors."""
NEEDED = frozenset({"layers", "sides"})
"""Rules without which a typical plan knows no leaning walls."""
SWARF = frozenset({"swarf", "swarf_floor"})
"""Rules without which a typical plan swarf mills nothing: floors under walls that a flank finishes come after these."""
TASK_MAKERS = {
    **PLANE_TASK_MAKERS,
    **OUTLINE_TASK_MAKERS,
    **FREEFORM_TASK_MAKERS,
    **PIT_TASK_MAKERS,
    **HOLE_TASK_MAKERS,
}
"""The rule behind each word that a typical plan gives for its cutter."""
