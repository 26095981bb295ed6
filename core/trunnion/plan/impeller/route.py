"""The route of an impeller: channels roughed, blades and splitters finished from tip to root, the hub, the root fillets, holes beside the
bore."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from trunnion.findings import Finding, error, face_tags, info
from trunnion.model.operation import CuttingData, Operation
from trunnion.model.process import ProcessTree
from trunnion.model.tool import Tool
from trunnion.plan.cutting.milling import (
    cutting_data,
    roughing_depth,
)
from trunnion.plan.freeform.cutters.choice import named
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.plan.freeform.keys import ALLOWANCE, SCALLOP
from trunnion.plan.holes.route import RULES as HOLE_RULES
from trunnion.plan.holes.route import plan_holes, reached_holes
from trunnion.plan.impeller.cutters import (
    WheelSizes,
    in_fillet,
    in_wide_parts,
    on_hub,
    on_walls,
    through_channel,
)
from trunnion.plan.impeller.settings import ImpellerRouteSettings
from trunnion.plan.impeller.wheel import BLADE, EDGES, HOLE, HUB, ROOT, SPLITTER, WALLS, Wheel
from trunnion.plan.process import process_of
from trunnion.plan.setups.state import SetupPlanState
from trunnion.settings import Value
from trunnion.shop import Stage, TypicalPlan
from trunnion.units import trimmed

WIDE, CHANNEL, WALL, HUB_CUTTER, FILLET = "wide", "channel", "walls", "hub", "fillet"
CUTTER_RULES = (WIDE, CHANNEL, WALL, HUB_CUTTER, FILLET, *HOLE_RULES)
"""Words that a typical plan may give for a stage's cutter."""
ROLES = {WALL: (*WALLS, *EDGES), FILLET: ROOT}
"""Roles of the faces that a stage finishes, by its rule for the cutter."""
ROUGH = "rough"
"""Kind of the operations that rough channels."""
WIDTH = 0.5
"""Of the cutter's diameter: how far apart the passes of a layer lie. The first of them is a full slot anyhow."""
LEFT = 2.0
"""Times the roughing allowance: how deep finishing cuts at most, where walls twist away from the tool that roughed along them."""


@dataclass(slots=True, kw_only=True)
class ImpellerPlanState(SetupPlanState):
    """What is known while an impeller is planned, and the operations so far."""

    wheel: Wheel
    sizes: WheelSizes
    settings: ImpellerRouteSettings

    def cutter(self, rule: str) -> Tool | None:
        """Return the cutter of a stage by its rule, the one that a person named before all others."""
        s = self.settings
        tools = self.shop.tools_for(self.material.iso_group, "surface")
        wanted = {WIDE: s.wide_cutter, CHANNEL: s.rough_cutter, WALL: s.finish_cutter}.get(
            rule, s.fillet_cutter
        )
        if wanted:
            return named(self.shop, wanted)
        if rule == WIDE:
            narrow = self.cutter(CHANNEL)
            return narrow and in_wide_parts(
                tools,
                self.sizes,
                s.rough_allowance,
                narrow,
                lambda tool: self.rough_data(tool).removal_rate,
            )
        if rule == CHANNEL:
            return through_channel(tools, self.sizes, s.rough_allowance)
        if rule == WALL:
            return on_walls(tools, self.sizes, s.rough_allowance)
        return on_hub(tools, self.sizes) if rule == HUB_CUTTER else in_fillet(tools, self.sizes)

    def rough_data(self, tool: Tool) -> CuttingData:
        """Return the cutting data of a cutter that roughs channels."""
        s = self.settings
        bears = roughing_depth(tool, self.material, self.cutting)
        depth = min(bears, s.layer) if s.layer > 0.0 else bears
        return cutting_data(
            tool, self.material, self.machine, ROUGH, self.cutting, depth, WIDTH * tool.diameter
        )


def make_impeller_route(state: ImpellerPlanState, plan: TypicalPlan) -> ProcessTree:
    """Return the process of an impeller: operations in cutting order; what is not planned is in its findings."""
    holes = reached_holes(state, state.recognition.of_kind(HOLE))
    for stage in plan.stages:
        if stage.cutter in HOLE_RULES:
            plan_holes(state, stage, holes)
        else:
            _plan_stage(state, stage)
    _add_turned(state)
    setups = state.used_setups()
    return process_of(
        _in_order(state.operations, plan, [s.name for s in setups]),
        state.findings,
        plan=plan,
        material=state.material,
        setups=setups,
        shop=state.shop,
    )


def _plan_stage(state: ImpellerPlanState, stage: Stage) -> None:
    if stage.cutter == WIDE and not state.settings.wide_first:
        return
    tool = state.cutter(stage.cutter)
    if tool is None and stage.cutter == WIDE:
        return
    if tool is None:
        state.findings.append(_no_cutter(state, stage))
        return
    if stage.cutter in ROLES:
        for kind in stage.on:
            features = [f for f in state.wheel.blades if f.kind == kind]
            tags = tuple(t for f in features for t in f.with_role(*ROLES[stage.cutter]))
            if tags:
                _add(state, stage, f"{stage.name}-{kind}", features[0].id, tool, tags)
        return
    for f in state.recognition.of_kind(*stage.on)[:1]:
        name = f"{f.id}-{WIDE}" if stage.cutter == WIDE else f.id
        _add(state, stage, name, f.id, tool, f.tags if stage.finish else ())


def _add(
    state: ImpellerPlanState,
    stage: Stage,
    name: str,
    feature: str,
    tool: Tool,
    tags: tuple[int, ...],
) -> None:
    s = state.settings
    choices: dict[str, Value]
    if stage.finish:
        height = s.height()
        depth = LEFT * s.rough_allowance
        width = stepover_on_plane(tool.corner_radius, height)
        data = cutting_data(
            tool, state.material, state.machine, stage.kind, state.cutting, depth, width
        )
        choices = {SCALLOP: height, ALLOWANCE: 0.0}
        why = f"{tool.name}: scallops of {trimmed(1000.0 * height, 1)} um, {trimmed(width, 3)} mm between passes on a plane."
    else:
        data = state.rough_data(tool)
        choices = {ALLOWANCE: s.rough_allowance}
        if stage.cutter == WIDE:
            share = state.sizes.share_of(tool.diameter + 2.0 * s.rough_allowance)
            choices["channel.rough.wide"] = True
            goes = f"fits into {trimmed(100.0 * share, 0)} % of the channels"
        else:
            goes = f"the narrowest channel is {trimmed(state.sizes.channel, 2)} mm wide"
        why = (
            f"{tool.name}: {goes}, blades are {trimmed(state.sizes.height, 1)} mm high; "
            f"layers of {trimmed(data.depth, 2)} mm, {trimmed(s.rough_allowance, 2)} mm are left."
        )
    copies = len(state.wheel.copies)
    rules = (
        stage.rule,
        why,
        f"One period of the wheel is programmed and turned to {copies} places.",
    )
    state.operations.append(
        Operation(
            id=f"{stage.kind}-{name}".replace(" ", "-"),
            kind=stage.kind,
            strategy=stage.strategy,
            feature=feature,
            setup=state.setup.name,
            tool=tool,
            data=data,
            faces=tags,
            choices=choices,
            rules=rules,
            group=stage.name,
        )
    )


def _in_order(
    operations: Sequence[Operation], plan: TypicalPlan, setups: Sequence[str]
) -> list[Operation]:
    """Return the operations, which stand in the order of the plan's stages, setup by setup with what comes before each."""
    before = {s.name: set(s.after_all) | set(s.after) for s in plan.stages}
    return [
        replace(
            o,
            after=tuple(sorted(other.id for other in operations if other.group in before[o.group])),
        )
        for o in sorted(operations, key=lambda o: setups.index(o.setup))
    ]


def _add_turned(state: ImpellerPlanState) -> None:
    """Tell of the features that no operation cuts: what is turned, or bored, before the channels are milled."""
    cut = {t for o in state.operations for t in o.faces}
    others = [f for f in state.recognition if f.kind not in (BLADE, SPLITTER, HUB, HOLE)]
    left = [f for f in others if not set(f.tags) & cut]
    if left:
        state.findings.append(
            info(
                "route.turned",
                f"{', '.join(f.id for f in left)}: turned or bored before the channels are milled, as tips, outlet and the hub's nose are",
                *(f.id for f in left),
                remedy="give the blank these surfaces, or add operations for what it has not",
            )
        )


def _no_cutter(state: ImpellerPlanState, stage: Stage) -> Finding:
    s = state.sizes
    tags = tuple(t for f in state.recognition.of_kind(*stage.on) for t in f.tags)
    return error(
        "route.no-cutter",
        f"{stage.name}: no tapered ball of the catalogue goes through a channel {trimmed(s.channel, 2)} mm wide between blades "
        f"{trimmed(s.height, 1)} mm high, with root fillets of {trimmed(s.fillet, 2)} mm",
        *(f.id for f in state.recognition.of_kind(*stage.on)),
        *face_tags(tags),
        remedy="add a slimmer or longer cutter to the tools folder, or leave a smaller allowance",
    )
