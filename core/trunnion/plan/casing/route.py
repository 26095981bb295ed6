"""The route of a casing from its largest turned state: bottoms roughed, bosses' tops, bottoms, sides and fillets finished, holes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from trunnion.findings import face_tags, info, warning
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.casing.boss_route import FILLET, SIDE_CUTTER, TOP_CUTTER, plan_boss
from trunnion.plan.casing.bottom_route import (
    BOTTOM_CUTTER,
    FOOT,
    LAYERS,
    REST_LAYERS,
    grounds_in_order,
    plan_floor,
    plan_grounds,
    plan_layers,
)
from trunnion.plan.casing.interrupted_route import GAPS, plan_gaps
from trunnion.plan.casing.plan_state import CasingPlanState
from trunnion.plan.casing.recess.route import (
    RECESS_FILLET,
    RECESS_SIDE,
    plan_recess,
    remaining_recesses,
)
from trunnion.plan.holes.route import RULES, plan_holes, reached_holes
from trunnion.plan.process import process_of
from trunnion.plan.turning.operations import RULES as TURNING_RULES
from trunnion.recognize.casing.kinds import BOSS, HOLE, POCKET, PROFILE
from trunnion.shop import Stage, TypicalPlan

CUTTER_RULES = (
    LAYERS,
    REST_LAYERS,
    BOTTOM_CUTTER,
    FOOT,
    TOP_CUTTER,
    SIDE_CUTTER,
    FILLET,
    GAPS,
    RECESS_SIDE,
    RECESS_FILLET,
    *RULES,
    *TURNING_RULES,
)
"""Words that a typical plan may give for a stage's cutter."""


def make_casing_route(state: CasingPlanState, plan: TypicalPlan) -> ProcessTree:
    """Return the process of a casing: operations in cutting order; what is not planned is in its findings."""
    progress = state.progress
    state.progress = progress.part(0.0, 0.4)
    plan_grounds(state)
    state.progress = progress.part(0.4, 0.7)
    holes = reached_holes(state, state.recognition.of_kind(HOLE))
    state.progress = progress.part(0.7, 1.0)
    for stage in state.progress.each([s for s in plan.stages if s.cutter not in TURNING_RULES]):
        if stage.cutter in (LAYERS, REST_LAYERS, BOTTOM_CUTTER, FOOT):
            for pocket in grounds_in_order(state):
                if stage.cutter in (LAYERS, REST_LAYERS):
                    plan_layers(state, stage, pocket)
                else:
                    plan_floor(state, stage, pocket)
        elif stage.cutter == GAPS:
            for pocket in grounds_in_order(state):
                plan_gaps(state, stage, pocket)
        elif stage.cutter in (RECESS_SIDE, RECESS_FILLET):
            for pocket in grounds_in_order(state):
                plan_recess(state, stage, pocket)
        elif stage.cutter in RULES:
            plan_holes(state, stage, holes)
        else:
            for boss in state.recognition.of_kind(BOSS):
                plan_boss(state, stage, boss)
    state.findings.extend(remaining_recesses(state))
    _add_turned(state)
    setups = state.used_setups(state.turned.setups if state.turned is not None else ())
    turned = state.turned.operations if state.turned is not None else ()
    return process_of(
        _in_order(
            [*turned, *state.operations],
            plan.stages,
            [s.name for s in setups],
            {pocket: len(state.hosts_of(pocket)) for pocket in state.hosts},
        ),
        state.findings,
        plan=plan,
        material=state.material,
        setups=setups,
        shop=state.shop,
    )


def _in_order(
    operations: Sequence[Operation],
    stages: Sequence[Stage],
    setups: Sequence[str],
    depths: Mapping[str, int],
) -> list[Operation]:
    """Return the operations, which stand in the order of the plan's stages, setup by setup with what comes before each; within a stage
    those of one tool follow each other, larger tools first where they rough, and those in recesses, by the `depths` of these, come after
    what they are sunk into."""
    before = {s.name: set(s.after_all) | set(s.after) for s in stages}
    rank = {s.name: n for n, s in enumerate(stages)}
    first: dict[tuple[str, str], int] = {}
    for n, o in enumerate(operations):
        first.setdefault((o.group, o.tool.name), n)
    ranked = sorted(
        enumerate(operations),
        key=lambda e: (
            setups.index(e[1].setup),
            rank[e[1].group],
            depths.get(e[1].feature, 0),
            first[e[1].group, e[1].tool.name],
            e[0],
        ),
    )
    return [
        replace(
            o,
            after=tuple(sorted(p.id for p in operations if p.group in before[o.group])),
        )
        for _, o in ranked
    ]


def _add_turned(state: CasingPlanState) -> None:
    """Tell what must come turned where it isn't turned here, and which pockets' sides no operation cuts."""
    cut = {t for o in state.operations for t in o.faces}
    profiles = state.recognition.of_kind(PROFILE)
    if state.turned is not None:
        state.findings.extend(state.turned.findings)
    else:
        state.findings.append(
            info(
                "route.turned",
                f"{', '.join(f.id for f in profiles) or 'faces of revolution'} and the bottoms where no boss is beside them come turned: "
                "the blank has them",
                *(f.id for f in profiles),
                remedy="turn the part to the blank's outline before it is milled, or choose a blank that is turned here "
                "(blank.kind = turned, blank.bored = yes)",
            )
        )
    reported = {w for f in state.findings for w in f.where}
    for feature in state.recognition:
        open_tags = set(feature.tags) - cut
        if (
            feature.kind == POCKET
            and feature.id not in state.grounds
            and feature.id not in reported
        ):
            state.findings.append(
                warning(
                    "route.not-planned",
                    f"{feature.id}: nothing of the blank stands in it, or it is not milled all round from outside",
                    feature.id,
                    *face_tags(tuple(open_tags)),
                    remedy="add operations by hand where material is left",
                )
            )
