"""A planner's process brought to what a taught plan does: its cutters where they fit, its choices, its cutting data.

Every operation says whether it comes from the plan. A cutter of the plan that does not fit the part stays away, and the planner's own
choice is kept with the reason.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.model.feature import Recognition
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.model.tool import Tool
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.cutting.optimize import recomputed
from trunnion.plan.library.teach import kinds_of
from trunnion.plan.manual.operation_change import OperationChange, with_speeds
from trunnion.plan.repair.contract import numbered
from trunnion.plan.repair.tool_change import ROUGH_FORMS, SHAPES, own_shape, with_cutter
from trunnion.plan.tool_choice import depth_reached
from trunnion.settings import Value, checked, choose
from trunnion.shop import Shop
from trunnion.shop.library import TaughtOperation, TaughtPlan
from trunnion.units import trimmed


@dataclass(frozen=True, slots=True, kw_only=True)
class FollowedPlan:
    """A process that follows a taught plan, and how many of its operations come from the plan, of these with another `cutter`."""

    process: ProcessTree
    taught: int
    other_cutter: int


def followed(
    process: ProcessTree,
    plan: TaughtPlan,
    recognition: Recognition,
    shop: Shop,
    choices: Mapping[str, Value],
) -> FollowedPlan:
    """Return a planner's process, made by the stages of a taught plan, with what the plan's operations have; `choices` are a session's
    settings by full key."""
    work = _Work(plan=plan, shop=shop, choices=choices, kinds=kinds_of(recognition))
    taught = other_cutter = 0
    for id in [o.id for o in process.operations]:
        operation = process.operation(id)
        known = plan.of_stage(operation.group, work.kinds.get(operation.feature, ""))
        if not known:
            process = process.with_operation(_with_rule(operation, work.is_new))
            continue
        process, fits = work.applied(process, operation, known)
        taught += 1
        other_cutter += not fits
    return FollowedPlan(
        process=numbered(process, shop.cribs), taught=taught, other_cutter=other_cutter
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Work:
    """A plan at work: the shop, a session's settings, and the kinds of features by their ids."""

    plan: TaughtPlan
    shop: Shop
    choices: Mapping[str, Value]
    kinds: Mapping[str, str]

    @property
    def is_new(self) -> str:
        return f"Not in the taught plan {self.plan.name}: its part had no such work; by the plan's stage alone."

    def applied(
        self, process: ProcessTree, operation: Operation, known: Sequence[TaughtOperation]
    ) -> tuple[ProcessTree, bool]:
        """Return the process with an operation as the plan has it, and whether the plan's cutter is taken."""
        taught, refused = self._taught(process, operation, known)
        if taught is None:
            words = (
                f"From the taught plan {self.plan.name}, with another cutter: {refused.words}; {operation.tool.name} is the planner's "
                "own choice."
            )
            return process.with_operation(_with_rule(operation, words)), False
        rule = f"From the taught plan {self.plan.name}: stage, choices and cutter."
        changed = operation
        if taught.tool != operation.tool.name:
            process = self._with_cutter(process, operation, taught.tool)
            changed = process.operation(operation.id)
        if taught.choices:
            keys = (*changed.own_choices, *taught.choices)
            changed = replace(
                changed,
                choices={**changed.choices, **taught.choices},
                own_choices=tuple(dict.fromkeys(keys)),
            )
        changed, note = self._with_data(process, changed, taught)
        return process.with_operation(_with_rule(changed, f"{rule}{note}")), True

    def _taught(
        self, process: ProcessTree, operation: Operation, known: Sequence[TaughtOperation]
    ) -> tuple[TaughtOperation | None, _Refused]:
        """Return what the plan does where the planner takes this cutter; else its thickest cutter that fits, or None. With it comes the
        refusal of the plan's cutter that is nearest to the planner's."""
        now = operation.tool.name
        refused: list[_Refused] = []
        fitting: list[TaughtOperation] = []
        for taught in sorted(known, key=lambda t: (t.planned != now, t.tool != now)):
            reason = self._refusal(process, operation, taught)
            if not reason and now in (taught.planned, taught.tool):
                return taught, _Refused()
            if reason:
                refused.append(_Refused(tool=taught.tool, reason=reason))
            else:
                fitting.append(taught)
        nearest = min(refused, key=lambda r: self._distance(r.tool, operation), default=_Refused())
        best = max(fitting, key=lambda t: (self._diameter(t.tool), t.tool), default=None)
        return best, nearest

    def _distance(self, name: str, operation: Operation) -> tuple[bool, float, str]:
        """Return how far a cutter is from an operation's: another form or corner counts more than any diameter (mm)."""
        tool, now = self._cutter(name), operation.tool
        if tool is None or not isinstance(now, Tool):
            return True, math.inf, name
        same = _same_foot(tool, now, finishes=bool(operation.faces))
        return not same, abs(tool.diameter - now.diameter), name

    def _diameter(self, name: str) -> float:
        tool = self._cutter(name)
        return tool.diameter if tool is not None else 0.0

    def _cutter(self, name: str) -> Tool | None:
        return next((c.tool for c in self.shop.cutters if c.tool.name == name), None)

    def _refusal(self, process: ProcessTree, operation: Operation, taught: TaughtOperation) -> str:
        """Return why a cutter of the plan does not fit an operation; empty where it does."""
        if taught.tool == operation.tool.name:
            return ""
        if not isinstance(operation.tool, Tool):
            return "another tool turns this contour"
        tool = self._cutter(taught.tool)
        if tool is None:
            return "the catalogue does not have it any more"
        group = self.shop.material(process.material).iso_group
        if not any(c.tool.name == tool.name and group in c.suits for c in self.shop.cutters):
            return f"it is not made for the material group {group}"
        if _is_in_use(process, operation, tool):
            return "another operation of the stage has it here"
        planned = self._cutter(taught.planned) or tool
        return refusal(tool, planned, operation)

    def _with_cutter(self, process: ProcessTree, operation: Operation, name: str) -> ProcessTree:
        """Return the process with a cutter of the plan and the tables' data for it."""
        tool = self._cutter(name)
        assert tool is not None
        why = f"the taught plan {self.plan.name} has it here"
        process = with_cutter(process, operation, tool, why)
        own = checked(choose(CuttingSettings, {**self.choices, **operation.choices}))
        material = self.shop.material(process.material)
        data = recomputed(process.operation(operation.id), process, material, self.shop, own)
        return process.with_operation(replace(data, planned_tool=operation.tool.name))

    def _with_data(
        self, process: ProcessTree, operation: Operation, taught: TaughtOperation
    ) -> tuple[Operation, str]:
        """Return an operation with the spindle speed and feed that a person had set, and why not in words."""
        if not (taught.spindle or taught.feed):
            return operation, ""
        if process.material != self.plan.signature.material:
            return (
                operation,
                f" Its speeds were set by hand for {self.plan.signature.material}: those of the tables are kept.",
            )
        change = OperationChange(tool="", spindle=taught.spindle, feed=taught.feed)
        try:
            changed = with_speeds(process, operation, change, self.shop, self.choices)
        except BadInput as reason:
            return operation, f" Its speeds are not taken: {reason}."
        return replace(changed, taught_data=True), ""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Refused:
    """A cutter of a plan that does not fit an operation, and why."""

    tool: str = ""
    reason: str = ""

    @property
    def words(self) -> str:
        return f"{self.tool} does not fit here ({self.reason})"


def refusal(tool: Tool, planned: Tool, operation: Operation) -> str:
    """Return why a taught cutter does not fit where a planner takes the operation's own; empty where it does.

    The planner's choice measures the part: the largest cutter that goes in, reaching as deep as is needed. A taught cutter fits where it is
    no thicker and no shorter than that, or where the part leaves as much space as the taught one did, by what the planner took there
    (`planned`). It leaves the same shape: a finishing cutter the same corner, a drill the same hole.
    """
    now = operation.cutter
    if not _same_foot(tool, now, finishes=bool(operation.faces)):
        return f"it leaves another shape than {now.name}"
    if (
        tool.diameter > now.diameter + tolerance.COINCIDENT
        and now.diameter < planned.diameter - tolerance.COINCIDENT
    ):
        return f"the gap is too narrow for D {trimmed(tool.diameter, 2)}, D {trimmed(now.diameter, 2)} goes in"
    reach, needed = depth_reached(tool), depth_reached(now)
    if reach < needed - tolerance.COINCIDENT and needed > depth_reached(planned) + (
        tolerance.COINCIDENT
    ):
        return f"it is too short: it reaches {trimmed(reach, 1)} mm, {now.name} reaches {trimmed(needed, 1)} mm"
    return ""


def _same_foot(tool: Tool, now: Tool, *, finishes: bool) -> bool:
    """Return whether a cutter leaves the shape that another one does at its foot."""
    if now.form in SHAPES or tool.form in SHAPES:
        return own_shape(tool) == own_shape(now)
    if not finishes and now.form in ROUGH_FORMS:
        return tool.form in ROUGH_FORMS
    if tool.form != now.form:
        return False
    return now.form == "ball" or abs(tool.corner_radius - now.corner_radius) <= tolerance.COINCIDENT


def _is_in_use(process: ProcessTree, operation: Operation, tool: Tool) -> bool:
    """Return whether another operation of the same stage cuts the same feature with a cutter: falling sizes stay different ones."""
    return any(
        o.id != operation.id
        and o.group == operation.group
        and o.tool.name == tool.name
        and o.direction == operation.direction
        and set(o.all_features) & set(operation.all_features)
        for o in process.of_setup(operation.setup)
    )


def _with_rule(operation: Operation, rule: str) -> Operation:
    return replace(operation, rules=(*operation.rules, rule))
