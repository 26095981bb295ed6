"""Every rule that a panel's typical plan may name for a stage's cutter."""

from __future__ import annotations

from trunnion.plan.panel.freeform_tasks import FREEFORM_TASK_MAKERS
from trunnion.plan.panel.hole_tasks import HOLE_TASK_MAKERS
from trunnion.plan.panel.tasks import PLANE_TASK_MAKERS

TASK_MAKERS = {**PLANE_TASK_MAKERS, **FREEFORM_TASK_MAKERS, **HOLE_TASK_MAKERS}
"""The rule behind each word that a typical plan gives for its cutter."""
