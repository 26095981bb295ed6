"""The fixes `tool` and `smaller_tool`: an operation gets the next cutter of the catalogue that reaches farther, or that is smaller.

The form and the corner radius stay: they make the shape of a floor's fillet and the scallops of a surface.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from trunnion import tolerance
from trunnion.findings import Fix
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.model.tool import BUTTON, FINISHING, TAP, THREAD_MILL, Tool
from trunnion.plan.freeform.keys import EARLIER
from trunnion.plan.repair.contract import RepairJob
from trunnion.plan.tool_choice import depth_reached

SHAPES = ("drill", *FINISHING, TAP, THREAD_MILL, "form", BUTTON)
"""Forms that leave their own shape in the part, whatever they cut."""
MARGIN = 0.5
"""mm that a tool has to reach farther than what was measured."""
WHY = "the proof asked for it"
"""What an operation's rule says of a cutter that a fix chose."""
ROUGH_FORMS = ("flat", "bull")
"""Forms that may stand for one another where nothing of the cutter's foot stays on the part."""


def with_longer_tool(process: ProcessTree, fix: Fix, job: RepairJob) -> ProcessTree | None:
    """Return the process with a cutter that is as thick and farther-reaching, or the next smaller one that reaches as far."""
    operation = process.operation(fix.operation)
    now = operation.cutter
    wanted = depth_reached(now) + fix.amount + MARGIN
    return _with(
        process, operation, job, lambda t: t.radius <= now.radius and depth_reached(t) >= wanted
    )


def with_smaller_tool(process: ProcessTree, fix: Fix, job: RepairJob) -> ProcessTree | None:
    """Return the process with the next smaller cutter that reaches as far."""
    operation = process.operation(fix.operation)
    now = operation.cutter
    return _with(
        process,
        operation,
        job,
        lambda t: (
            t.radius < now.radius - tolerance.COINCIDENT
            and depth_reached(t) >= depth_reached(now) - tolerance.COINCIDENT
        ),
    )


def _with(
    process: ProcessTree, operation: Operation, job: RepairJob, fits: Callable[[Tool], bool]
) -> ProcessTree | None:
    found = next_tool(process, operation, job, fits)
    return None if found is None else with_cutter(process, operation, found)


def next_tool(
    process: ProcessTree, operation: Operation, job: RepairJob, fits: Callable[[Tool], bool]
) -> Tool | None:
    """Return the largest cutter in an operation's stead that fits, the shortest of these; None where there is none."""
    now = operation.cutter
    forms = ROUGH_FORMS if now.form in ROUGH_FORMS and not operation.faces else (now.form,)
    found = [
        t
        for t in job.milling_tools(process, forms)
        if t.name != now.name and fits(t) and _same_foot(t, now, bool(operation.faces))
    ]
    return min(found, key=lambda t: (-t.diameter, depth_reached(t), t.name), default=None)


def own_shape(tool: Tool) -> tuple[object, ...]:
    """Return what of a tool stays in the part where its form is one of `SHAPES`."""
    return (
        tool.form,
        tool.diameter,
        tool.point_angle,
        tool.outline,
        tool.pitch,
        tool.pitch_low,
        tool.pitch_high,
        tool.fit,
    )


def _same_foot(tool: Tool, now: Tool, finishes: bool) -> bool:
    """Return whether a cutter leaves the same shape at its foot: a ball's is its radius, and roughing leaves none. A drill's or a form
    cutter's shape is that of the hole."""
    if now.form in SHAPES:
        return own_shape(tool) == own_shape(now)
    if not finishes:
        return tool.corner_radius <= max(now.corner_radius, tolerance.COINCIDENT)
    return now.form == "ball" or abs(tool.corner_radius - now.corner_radius) <= tolerance.COINCIDENT


def with_cutter(
    process: ProcessTree, operation: Operation, tool: Tool, why: str = WHY
) -> ProcessTree:
    """Return the process with another cutter for an operation, `why` in words; what mills after it knows its new name."""
    now = operation.cutter
    data = operation.data
    share = tool.diameter / now.diameter
    changed = replace(
        operation,
        tool=tool,
        data=replace(data, width=min(data.width * share, tool.diameter)),
        rules=(*operation.rules, f"{tool.name} instead of {now.name}: {why}."),
    )
    done = process.with_operation(changed)
    faces = set(operation.faces)
    followers = (
        o
        for o in process.operations
        if o.choices.get(EARLIER) == now.name and faces & set(o.faces) and o.id != operation.id
    )
    for o in followers:
        done = done.with_operation(replace(o, choices={**o.choices, EARLIER: tool.name}))
    return done
