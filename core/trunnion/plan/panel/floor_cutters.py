"""Cutters of floors by time: a wider flat goes over a floor in fewer passes, and is worth a tool change where it saves more than that."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from trunnion.model.tool import Tool
from trunnion.plan.cutting.milling import CuttingSettings, cutting_data
from trunnion.plan.panel.tasks import OperationTask, PanelPlanState
from trunnion.settings import choose
from trunnion.units import SECONDS_PER_MINUTE

FLOOR, FLOOR_WIDTH = "floor", 0.6
"""The rule of floors' stages; and how far apart passes over a floor are, over the diameter of the cutter's flat."""


def floor_time(state: PanelPlanState, task: OperationTask, tool: Tool) -> float:
    """Return about how long in min a cutter goes over a floor: its area over the distance of passes times the feed."""
    width = FLOOR_WIDTH * (tool.diameter - 2.0 * tool.corner_radius)
    area = (task.requirement.wanted or task.requirement.envelope_area).area
    data = cutting_data(
        tool,
        state.material,
        state.machine,
        task.stage.kind,
        choose(CuttingSettings, state.choices),
        state.settings.floor_allowance,
        width,
    )
    return area / (width * data.feed)


def quicker_floors(
    state: PanelPlanState, tasks: Iterable[OperationTask], fits: Mapping[str, Sequence[Tool]]
) -> dict[str, Tool]:
    """Return cutters for floors in the place of those that they have, where these save time: of those that fit, in use or not, the one that
    saves most together over all floors, less a tool change where it is not in use, and so on until none saves any.
    """
    floors = [t for t in tasks if t.stage.cutter == FLOOR]
    own = {t.id: state.tools[t.id] for t in floors}
    kept = {tool.name for id, tool in state.tools.items() if id not in own}
    times = {t.id: {tool.name: floor_time(state, t, tool) for tool in fits[t.id]} for t in floors}
    named = {tool.name: tool for t in floors for tool in fits[t.id]}
    change = state.machine.tool_change_s / SECONDS_PER_MINUTE
    while True:
        used = kept | {tool.name for tool in own.values()}
        saved = {
            name: sum(
                max(times[id].get(own[id].name, 0.0) - found[name], 0.0)
                for id, found in times.items()
                if name in found
            )
            - (0.0 if name in used else change)
            for name in sorted(named)
        }
        best = max(saved, key=lambda name: saved[name], default="")
        if not best or saved[best] <= 0.0:
            break
        for id, found in times.items():
            if best in found and found[best] < found.get(own[id].name, 0.0):
                own[id] = named[best]
    return own
