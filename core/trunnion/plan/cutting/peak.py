"""The peak of an operation's load: what the spindle has to give at the largest engagement that its strategy can meet.

Where that passes the limit, the strategy's feed in full width is lowered first, then the depth of cut; a strategy that does not slow down
for itself gets a lower feed. What neither brings below the limit is a finding.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace

from trunnion import registry, tolerance
from trunnion.findings import Finding, warning
from trunnion.model.material import Material
from trunnion.model.operation import CuttingData, Engagement, Operation
from trunnion.model.tool import TAP
from trunnion.plan.cutting.power import NEWTON_METRES, tool_power
from trunnion.settings import Value, checked, choose
from trunnion.units import trimmed

PEAK = "peak "
"""How the sentence on the peak begins."""
LEAST_SHARE = 0.25
"""Share of the feed below which a cutter rubs."""
LEAST_DEPTH = 0.05
"""Depth of cut over the diameter below which roughing by layers makes no sense: another cutter is the remedy."""
ROUNDS = 12
"""Times that a share of the feed is lowered: an engagement that depends on it comes closer to the limit with each."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Peak:
    """A strategy's largest engagement, and the power in kW there."""

    met: Engagement
    power: float


Foresee = Callable[[CuttingData], Peak]
"""From an operation's cutting data to the peak of its load."""


def with_peak(
    operation: Operation,
    earlier: Iterable[Operation],
    material: Material,
    choices: Mapping[str, Value],
) -> Operation:
    """Return an operation whose data know the peak of its load and keep the spindle's limit there where feed and depth can.

    `earlier` are the operations before it in its setup, `choices` a session's settings by full key. Data set by hand keep their numbers,
    and so do those of taps, which their pitch feeds.
    Turning meets no more than its data say: they keep the limit already.
    """
    if not operation.tool.rotates or operation.tool.locked:
        return operation
    meets = _meets(operation, earlier, choices)

    def peak(data: CuttingData) -> Peak:
        met = meets(data)
        return Peak(met=met, power=_power(operation, data, met, material))

    data = operation.data
    if not operation.keeps_data and operation.cutter.form != TAP:
        data = _shallower(_slower(data, peak, material), peak, operation)
    found = peak(data)
    torque = NEWTON_METRES * found.power / data.spindle
    return replace(
        operation,
        data=replace(
            data,
            peak_power=found.power,
            peak_torque=torque,
            peak_at=found.met.at,
            rules=(*_others(data), *_words(data, found)),
        ),
    )


def largest_engagement(
    operation: Operation, earlier: Iterable[Operation], choices: Mapping[str, Value]
) -> Engagement:
    """Return the largest engagement that an operation's strategy can meet with its data."""
    return _meets(operation, earlier, choices)(operation.data)


def _meets(
    operation: Operation, earlier: Iterable[Operation], choices: Mapping[str, Value]
) -> Callable[[CuttingData], Engagement]:
    strategy = registry.get("strategies", operation.strategy)
    settings = checked(choose(strategy.settings, {**choices, **operation.choices}))
    before = _roughed_by(operation, earlier)

    def met(data: CuttingData) -> Engagement:
        found: Engagement = strategy.meets(operation.tool, data, settings, before)
        return found

    return met


def is_overload(data: CuttingData) -> bool:
    """Return whether an operation's load passes the spindle's limit, in steady cutting or at the largest engagement."""
    return _passes(data.highest_power, data.power_limit)


def overloads(operations: Iterable[Operation]) -> tuple[Finding, ...]:
    """Return a finding for every operation whose load passes the spindle's limit."""
    return tuple(_overload(o) for o in operations if not o.suppressed and is_overload(o.data))


def _overload(operation: Operation) -> Finding:
    data = operation.data
    where = f" where {data.peak_at}" if data.peak_at and data.peak_power > data.power else ""
    text = (
        f"{operation.id} asks {trimmed(data.highest_power, 1)} kW of the spindle{where}, {trimmed(data.power_limit, 1)} kW are allowed "
        f"at {trimmed(data.spindle, 0)} 1/min (steady: {trimmed(data.power, 1)} kW)"
    )
    return warning(
        "optimize.load",
        text,
        operation.id,
        remedy="choose a smaller cutter, a smaller depth or width of cut, or a stronger machine",
    )


def _roughed_by(operation: Operation, earlier: Iterable[Operation]) -> Operation | None:
    """Return the operation with the largest cutter that roughed an operation's feature before, or the blank where none is the feature's."""
    roughing = [o for o in earlier if not o.suppressed and not o.faces and o.kind != "face"]
    own = [o for o in roughing if o.feature == operation.feature]
    return max(own or roughing, key=lambda o: o.cutter.diameter, default=None)


def _power(operation: Operation, data: CuttingData, met: Engagement, material: Material) -> float:
    feed, teeth = met.share * data.feed, operation.cutter.teeth * data.spindle
    return tool_power(material, operation.cutter, feed / teeth, met.depth, met.width, feed)


def _slower(data: CuttingData, peak: Foresee, material: Material) -> CuttingData:
    """Return data with the feed in full width, or that of a strategy that doesn't slow down by itself, lowered to the limit if it goes."""
    share = 1.0
    for _ in range(ROUNDS):
        found = peak(data)
        if not _passes(found.power, data.power_limit):
            break
        wanted = (data.power_limit / found.power) ** (1.0 / (1.0 - material.force_exponent))
        least = min(
            LEAST_SHARE / (found.met.share * share) if found.met.slows else LEAST_SHARE / share, 1.0
        )
        lower = max(wanted, least)
        if lower >= 1.0 - tolerance.PARAMETRIC:
            break
        data = (
            replace(data, slot_share=data.slot_share * lower)
            if found.met.slows
            else _fed(data, lower, material)
        )
        share *= 1.0 if found.met.slows else lower
    return data


def _fed(data: CuttingData, share: float, material: Material) -> CuttingData:
    """Return data at a share of their feed; power goes with its power of 1 - m_c."""
    power = data.power * share ** (1.0 - material.force_exponent)
    rule = (
        f"vf {trimmed(data.feed * share, 0)} mm/min: the spindle's limit at the largest engagement"
    )
    return replace(
        data,
        feed=data.feed * share,
        plunge_feed=data.plunge_feed * share,
        feed_per_tooth=data.feed_per_tooth * share,
        removal_rate=data.removal_rate * share,
        power=power,
        torque=data.torque * power / data.power,
        rules=(*data.rules, rule),
    )


def _shallower(data: CuttingData, peak: Foresee, operation: Operation) -> CuttingData:
    """Return data of roughing by layers with a smaller depth of cut, where the lowest feed alone doesn't keep the limit."""
    found = peak(data)
    if not (_passes(found.power, data.power_limit) and found.met.slows and not operation.faces):
        return data
    share = max(
        data.power_limit / found.power,
        min(LEAST_DEPTH * operation.cutter.diameter / data.depth, 1.0),
    )
    rule = f"ap {trimmed(data.depth * share, 2)} mm: the spindle's limit at full width"
    return replace(
        data,
        depth=data.depth * share,
        routed_depth=data.depth,
        removal_rate=data.removal_rate * share,
        power=data.power * share,
        torque=data.torque * share,
        rules=(*data.rules, rule),
    )


def _others(data: CuttingData) -> tuple[str, ...]:
    """Return the rules that say nothing of the peak: data set by hand keep theirs from run to run."""
    return tuple(rule for rule in data.rules if not rule.startswith(PEAK))


def _words(data: CuttingData, found: Peak) -> tuple[str, ...]:
    if not found.met.at:
        return ()
    fed = f" at {trimmed(found.met.share, 2)} of the feed" if found.met.share < 1.0 else ""
    eased = (
        f"; the feed there times {trimmed(data.slot_share, 2)}: the spindle's limit"
        if data.slot_share < 1.0
        else ""
    )
    return (
        f"{PEAK}{trimmed(found.power, 1)} kW where {found.met.at}: ae {trimmed(found.met.width, 2)}, "
        f"ap {trimmed(found.met.depth, 2)}{fed}{eased}",
    )


def _passes(power: float, limit: float) -> bool:
    return power > limit * (1.0 + tolerance.PARAMETRIC)
