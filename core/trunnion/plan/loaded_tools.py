"""Planning with the tools in the machine alone: what planners then choose from, and what they could not plan with it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from trunnion.findings import BadInput, Finding, Severity, info, warning
from trunnion.model.process import ProcessTree
from trunnion.plan.settings import RouteSettings
from trunnion.settings import Value, checked, choose
from trunnion.shop import Shop
from trunnion.shop.crib import Crib

CODE = "route.only-in-machine"


def is_restricted(choices: Mapping[str, Value]) -> bool:
    """Return whether only tools in the machine may be planned with; `choices` are a session's settings by full key."""
    return checked(choose(RouteSettings, choices)).only_in_machine


def planning_shop(shop: Shop, machines: Iterable[str], choices: Mapping[str, Value]) -> Shop:
    """Return the shop that planners choose from: all of it, or with only the tools in some machines where a person wants that.

    Turning tools are those in these machines and in all others that turn: which of them turns a part is the planner's choice. Raises
    `BadInput` where no tool that the catalogue knows is in the machines.
    """
    if not is_restricted(choices):
        return shop
    used = tuple(dict.fromkeys(machines))
    lathes = (m.name for m in shop.machines.values() if m.work_spindle is not None)
    cutters = frozenset[str]().union(*(shop.crib(m).names for m in used))
    turning = cutters.union(*(shop.crib(m).names for m in lathes))
    restricted = shop.with_tools(cutters, turning)
    if not restricted.cutters and not restricted.turning:
        raise BadInput(
            f"no tool of the catalogue is in {' or '.join(used)}, and only tools in the machine may be used: put some in "
            f'(trunnion tools crib --machine "{used[0]}" --put NAME=T), or set route.only_in_machine = false'
        )
    return restricted


def loaded_findings(
    process: ProcessTree, shop: Shop, choices: Mapping[str, Value]
) -> list[Finding]:
    """Return what a person should know of a plan from the tools in the machines alone: that it is one, operations whose tool is not in the
    machine of their setup, and tools in it that the catalogue doesn't know. Nothing where the whole catalogue is planned with."""
    if not is_restricted(choices):
        return []
    cribs = {s.machine: shop.crib(s.machine) for s in process.setups}
    return [
        _summary(process, cribs),
        *_missing(process, cribs),
        *(f for crib in cribs.values() for f in _unknown(crib, shop)),
    ]


def _summary(process: ProcessTree, cribs: Mapping[str, Crib]) -> Finding:
    counts = [(len(c.tools), m) for m, c in cribs.items()]
    words = " and ".join(f"the {n} {'tool' if n == 1 else 'tools'} in {m}" for n, m in counts)
    text = f"only {words} may be used"
    is_short = any(f.severity in (Severity.ERROR, Severity.WARNING) for f in process.findings)
    if not is_short:
        return info(CODE, text)
    remedy = (
        "where a finding wants another tool: put one into the machine that the catalogue has, "
        "or set route.only_in_machine = false"
    )
    return warning(CODE, f"{text}, and not all could be planned as it should be", remedy=remedy)


def _missing(process: ProcessTree, cribs: Mapping[str, Crib]) -> Sequence[Finding]:
    """Return a warning for each tool that is not in the machine of an operation's setup."""
    absent: dict[tuple[str, str], list[str]] = {}
    for operation in process.operations:
        machine, name = process.setup(operation.setup).machine, operation.tool.name
        if not operation.suppressed and cribs[machine].tool(name) is None:
            absent.setdefault((machine, name), []).append(operation.id)
    return [
        warning(
            "route.not-in-machine",
            f"{name} is not in {machine}",
            *ids,
            remedy="put it into the machine, or give the operations another tool",
        )
        for (machine, name), ids in absent.items()
    ]


def _unknown(crib: Crib, shop: Shop) -> Sequence[Finding]:
    names = [t.name for t in crib.tools if t.name not in shop.names]
    if not names:
        return []
    return [
        warning(
            "route.unknown-tool",
            f"tools in {crib.machine} that the catalogue does not have are not planned with",
            *names,
            remedy="add them to the tools folder under these names, or take them out of the crib",
        )
    ]
