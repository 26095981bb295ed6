"""An operation's tool, spindle speed and feed changed by a person: the rest of its data follow, and planning leaves all of it alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.model.material import Machine, Material
from trunnion.model.operation import CuttingData, Operation
from trunnion.model.process import ProcessTree
from trunnion.model.spindle import surface_speed
from trunnion.model.tool import FINISHING, TAP, Tool
from trunnion.plan.cutting.drilling import AXIAL
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.cutting.optimize import recomputed
from trunnion.plan.cutting.power import NEWTON_METRES, drilling_power, tool_power
from trunnion.plan.repair.contract import numbered
from trunnion.plan.repair.tool_change import SHAPES, own_shape, with_cutter
from trunnion.settings import Value, checked, choose, setting, settings
from trunnion.shop import Shop
from trunnion.units import trimmed

WHY = "a person chose it"
"""What an operation's rule says of a cutter that was changed by hand."""
BY_HAND = "set by hand"
SPINDLE_RULE, FEED_RULE = "n ", "vf "
"""How sentences of cutting data on a spindle speed and a feed that are set by hand begin."""
SPEED_RULES, FEED_RULES = ("vc ", SPINDLE_RULE), ("fz ", "f ", FEED_RULE)
"""How sentences of cutting data on speeds and on feeds begin: they do not hold any more for what is set by hand."""


@settings("operation")
class OperationChange:
    """What a person may change of one operation beside its strategy's settings; 0 and an empty name leave what is there."""

    tool: str = setting(
        "",
        catalogue="tools",
        label="Tool",
        help="Cutter of the catalogue in the place of the planned one. Speed and feed become those of the tables for it.",
    )
    spindle: float = setting(
        0.0,
        unit="1/min",
        low=0.0,
        high=200_000.0,
        label="Spindle speed",
        help="Spindle speed in the place of the computed one; the feed a minute stays.",
    )
    feed: float = setting(
        0.0,
        unit="mm/min",
        low=0.0,
        high=200_000.0,
        label="Feed",
        help="Feed in the place of the computed one; plunging keeps its share of it.",
    )


def with_change(
    process: ProcessTree,
    id: str,
    change: OperationChange,
    shop: Shop,
    choices: Mapping[str, Value],
) -> ProcessTree:
    """Return the process with an operation changed by hand, its tools numbered anew; `choices` are a session's settings by full key.

    Raises `BadInput` for an operation, a tool or a value that can't be: in one line with what would be allowed.
    """
    check_known(process, id)
    checked(change)
    before = process.operation(id)
    if not before.tool.rotates or before.tool.locked:
        raise BadInput(
            f"{id}: only operations of tools that turn in the spindle can be changed by hand"
        )
    material = shop.material(process.material)
    if change.tool and change.tool != before.tool.name:
        tool = _tool_named(change.tool, before, material, shop)
        process = with_cutter(process, before, tool, WHY)
        cutting = checked(choose(CuttingSettings, {**choices, **before.choices}))
        computed = recomputed(
            replace(process.operation(id), by_hand=False, taught_data=False),
            process,
            material,
            shop,
            cutting,
        )
        planned = before.planned_tool or before.tool.name
        process = process.with_operation(replace(computed, by_hand=True, planned_tool=planned))
    changed = with_speeds(process, process.operation(id), change, shop, choices)
    if changed is before:
        return process
    data = _with_load(changed, material)
    return numbered(process.with_operation(replace(data, by_hand=True)), shop.cribs)


def check_known(process: ProcessTree, id: str) -> None:
    """Raise `BadInput` where a process has no operation of an id, with those that it has."""
    if id not in {o.id for o in process.operations}:
        raise BadInput(
            f"there is no operation {id}; known: {', '.join(o.id for o in process.operations)}"
        )


def with_speeds(
    process: ProcessTree,
    operation: Operation,
    change: OperationChange,
    shop: Shop,
    choices: Mapping[str, Value],
) -> Operation:
    """Return an operation of a process with a spindle speed and a feed as given, the rest of its data after them.

    Raises `BadInput` for what its machine does not have.
    """
    machine = shop.machine(process.setup(operation.setup).machine)
    cutting = checked(choose(CuttingSettings, {**choices, **operation.choices}))
    changed = operation
    if change.spindle > 0.0:
        changed = _with_spindle(changed, change.spindle, machine, cutting)
    if change.feed > 0.0:
        changed = _with_feed(changed, change.feed, machine)
    return changed if changed is operation else _with_load(changed, shop.material(process.material))


def _tool_named(name: str, operation: Operation, material: Material, shop: Shop) -> Tool:
    """Return a cutter of the catalogue that can stand in an operation's place: one that leaves its own shape only for the same."""
    found = next((c for c in shop.cutters if c.tool.name == name), None)
    if found is None:
        raise BadInput(f"{operation.id}: there is no tool {name} in the catalogue")
    if material.iso_group not in found.suits:
        raise BadInput(
            f"{operation.id}: {name} is not made for {material.name} (group {material.iso_group}); choose one that is"
        )
    now = operation.cutter
    if (found.tool.form in SHAPES or now.form in SHAPES) and found.tool.form != now.form:
        raise BadInput(
            f"{operation.id}: {name} can't do the work of {now.name}: a {now.form} tool is needed"
        )
    if now.form == TAP and own_shape(found.tool) != own_shape(now):
        raise BadInput(
            f"{operation.id}: {name} cuts another thread than {now.name}: choose a tap of D {trimmed(now.diameter, 3)} "
            f"and pitch {trimmed(now.pitch, 3)} mm"
        )
    return found.tool


def _with_spindle(
    operation: Operation, spindle: float, machine: Machine, cutting: CuttingSettings
) -> Operation:
    if not machine.spindle_low <= spindle <= machine.spindle_high:
        raise BadInput(
            f"{operation.id}: {machine.name} turns its spindle at {trimmed(machine.spindle_low, 0)} to "
            f"{trimmed(machine.spindle_high, 0)} 1/min, not at {trimmed(spindle, 0)}"
        )
    if abs(spindle - operation.data.spindle) <= tolerance.COINCIDENT:
        return operation
    now = _at_its_pitch(operation, spindle, machine)
    data = replace(
        now,
        spindle=spindle,
        speed=float(surface_speed(spindle, operation.cutter.diameter)),
        feed_per_tooth=now.feed / (operation.cutter.teeth * spindle),
        power_limit=machine.power_at(spindle) * cutting.power_share,
        rules=(
            *_without(now.rules, *SPEED_RULES, *FEED_RULES),
            f"n {trimmed(spindle, 0)} 1/min: {BY_HAND}",
        ),
    )
    return replace(operation, data=data)


def _at_its_pitch(operation: Operation, spindle: float, machine: Machine) -> CuttingData:
    """Return the data of an operation; those of a tap with the feed of its pitch at a spindle speed."""
    now, tool = operation.data, operation.cutter
    if tool.form != TAP:
        return now
    feed = tool.pitch * spindle
    if not float(spindle).is_integer():
        raise BadInput(
            f"{operation.id}: a tap turns at a whole number of revolutions a minute, not at {spindle:g}"
        )
    if feed > machine.feed_max:
        raise BadInput(
            f"{operation.id}: at {trimmed(spindle, 0)} 1/min the pitch asks for {trimmed(feed, 0)} mm/min, {machine.name} feeds at most "
            f"{trimmed(machine.feed_max, 0)}"
        )
    return replace(
        now, feed=feed, plunge_feed=feed, removal_rate=now.removal_rate * feed / now.feed
    )


def _with_feed(operation: Operation, feed: float, machine: Machine) -> Operation:
    now = operation.data
    if operation.cutter.form == TAP and abs(feed - now.feed) > tolerance.COINCIDENT:
        raise BadInput(
            f"{operation.id}: a tap's feed is its pitch times the spindle speed; change the spindle speed"
        )
    if feed > machine.feed_max:
        raise BadInput(
            f"{operation.id}: {machine.name} feeds at most {trimmed(machine.feed_max, 0)} mm/min, not {trimmed(feed, 0)}"
        )
    if abs(feed - now.feed) <= tolerance.COINCIDENT:
        return operation
    data = replace(
        now,
        feed=feed,
        feed_per_tooth=feed / (operation.cutter.teeth * now.spindle),
        plunge_feed=now.plunge_feed * feed / now.feed,
        removal_rate=now.removal_rate * feed / now.feed,
        rules=(*_without(now.rules, *FEED_RULES), f"vf {trimmed(feed, 0)} mm/min: {BY_HAND}"),
    )
    return replace(operation, data=data)


def _without(rules: tuple[str, ...], *beginnings: str) -> tuple[str, ...]:
    return tuple(r for r in rules if not r.startswith(beginnings))


def _with_load(operation: Operation, material: Material) -> Operation:
    """Return an operation whose power and torque are those of its speed and feed."""
    data, tool = operation.data, operation.cutter
    if operation.kind in AXIAL and tool.form not in (*FINISHING, TAP):
        power = drilling_power(material, tool, data.feed_per_tooth, data.feed)
    else:
        power = tool_power(material, tool, data.feed_per_tooth, data.depth, data.width, data.feed)
    return replace(
        operation,
        data=replace(data, power=power, torque=NEWTON_METRES * power / data.spindle),
    )
