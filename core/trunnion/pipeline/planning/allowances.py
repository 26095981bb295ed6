"""Material that a person has features keep, put on what was recognised."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from trunnion.findings import BadCall
from trunnion.model.session import Session
from trunnion.plan.allowances import FeatureAllowance, allowance_of, with_allowance
from trunnion.plan.contract import allowance_planner
from trunnion.settings import checked, choose


def with_feature_allowance(
    session: Session,
    ids: Iterable[str],
    *,
    wall_allowance: float | None = None,
    floor_allowance: float | None = None,
) -> Session:
    """Return the session with what some features are to keep on walls, and on floors or tops, mm; None leaves it as it is.

    Raises `BadInput` as `plan.allowances.with_allowance` does, and for an amount that is not allowed.
    """
    found = session.recognition
    if found is None:
        raise BadCall("no features yet: recognize first")
    given = {"wall_allowance": wall_allowance, "floor_allowance": floor_allowance}
    amounts = {field: amount for field, amount in given.items() if amount is not None}
    planner = allowance_planner(found.family)
    for id in dict.fromkeys(ids):
        known = next((f for f in found if f.id == id), None)
        before = allowance_of(known) if known is not None else choose(FeatureAllowance, {})
        found = with_allowance(found, [id], checked(replace(before, **amounts)), planner)
    return session if found is session.recognition else replace(session, recognition=found)
