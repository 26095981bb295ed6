"""Triangles that later steps will want of a part: they are begun in the process that has read it, while this one is at the steps before.

What is begun here and not wanted costs time of another processor; what is wanted and was not begun is made when it is wanted. Results
are the same either way.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from trunnion import registry, tolerance
from trunnion.model.session import Session
from trunnion.part.work import MeshWork, RefinedMeshWork
from trunnion.pipeline.context import Context
from trunnion.pipeline.planning.blank import ROUND, kind_of
from trunnion.plan.contract import SkinPlanner, planner_for
from trunnion.registry import PLANNERS

if TYPE_CHECKING:
    from trunnion.part.part import Part


def before_recognition(part: Part) -> None:
    """Begin the triangles that pictures show."""
    part.begin(MeshWork(part.picture_chord))


def before_blank(session: Session, context: Context) -> None:
    """Begin the triangles that tell how large a round blank is, where one is asked for."""
    if kind_of(session) in ROUND:
        context.part.begin(MeshWork())


def before_route(session: Session, context: Context) -> None:
    """Begin the skins that the family's planner always looks at, in their order."""
    found = session.recognition
    if found is None or found.doubt or found.family not in registry.names(PLANNERS):
        return
    if not context.part.is_closed:
        # What is planned then is another part: this one with its backing.
        return
    planner = planner_for(found.family)
    if isinstance(planner, SkinPlanner):
        for chord in planner.skins:
            context.part.begin(RefinedMeshWork.of(context.part.tags, chord))


def before_proof(session: Session, context: Context) -> None:
    """Begin the triangles that leaning tools are proven against, where something is planned and a machine can lean one."""
    if session.process is None or not session.process.operations:
        return
    machines = [context.shop.machines[s.machine] for s in session.setups if s.machine]
    if context.part.is_closed and any(m.rotary for m in machines):
        context.part.begin(RefinedMeshWork.of(context.part.tags, tolerance.FACET_CHORD))
