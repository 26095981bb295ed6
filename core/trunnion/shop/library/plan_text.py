"""Taught plans as readable text (JSON) and back: strict, with one line for what is wrong."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from trunnion.findings import BadInput
from trunnion.settings import Value
from trunnion.shop.library.signature import PartSignature
from trunnion.shop.library.taught_plan import TaughtOperation, TaughtPlan
from trunnion.shop.plans import Stage

VERSION = 1
"""Version of the text: raised when a reader of an earlier version would misunderstand it."""


def plan_dict(plan: TaughtPlan) -> dict[str, Any]:
    """Return a taught plan as JSON has it."""
    return {
        "version": VERSION,
        "name": plan.name,
        "date": plan.date,
        "part": plan.part,
        "part_digest": plan.part_digest,
        "base": plan.base,
        "signature": plan.signature.as_dict(),
        "stages": [asdict(stage) for stage in plan.stages],
        "operations": [asdict(operation) for operation in plan.operations],
        "settings": dict(sorted(plan.settings.items())),
    }


def plan_text(plan: TaughtPlan) -> str:
    """Return a taught plan as text."""
    return json.dumps(plan_dict(plan), indent=1, ensure_ascii=False)


def plan_of_text(text: str, where: str) -> TaughtPlan:
    """Return the taught plan that a text has; `where` names it in messages.

    Raises `BadInput` for a text of a newer version, and for what is no such plan, naming the field.
    """
    try:
        data = json.loads(text)
    except ValueError as reason:
        raise BadInput(f"{where} is damaged ({reason}): remove the plan and add it anew") from None
    reader = PlanFields(data, where)
    version = reader.number("version")
    if version > VERSION:
        raise BadInput(
            f"{where} was written by a newer version of the program (plan version {version:g}, this one reads {VERSION}): "
            "update the program"
        )
    signature = reader.table("signature")
    return TaughtPlan(
        name=reader.text("name"),
        date=reader.text("date"),
        part=reader.text("part"),
        part_digest=reader.text("part_digest"),
        base=reader.text("base"),
        signature=PartSignature(
            family=signature.text("family"),
            features={k: int(v) for k, v in signature.numbers("features").items()},
            sizes=signature.numbers("sizes"),
            material=signature.text("material"),
            material_group=signature.text("material_group"),
            machine=signature.text("machine"),
        ),
        stages=tuple(_stage(each) for each in reader.tables("stages")),
        operations=tuple(_operation(each) for each in reader.tables("operations")),
        settings=reader.values("settings"),
    )


def _stage(fields: PlanFields) -> Stage:
    return Stage(
        name=fields.text("name"),
        kind=fields.text("kind"),
        strategy=fields.text("strategy"),
        on=fields.texts("on"),
        cutter=fields.text("cutter"),
        finish=fields.flag("finish"),
        after=fields.texts("after"),
        after_all=fields.texts("after_all"),
        rule=fields.text("rule"),
    )


def _operation(fields: PlanFields) -> TaughtOperation:
    return TaughtOperation(
        stage=fields.text("stage"),
        kind=fields.text("kind"),
        planned=fields.text("planned"),
        tool=fields.text("tool"),
        choices=fields.values("choices"),
        spindle=fields.number("spindle"),
        feed=fields.number("feed"),
        count=int(fields.number("count")),
    )


class PlanFields:
    """The fields of one table of the text, each read by its name and kind."""

    def __init__(self, data: Any, where: str) -> None:
        self._where = where
        if not isinstance(data, dict):
            raise self._wrong("a table", data)
        self._data: dict[str, Any] = data

    def text(self, name: str) -> str:
        """Return a text."""
        value = self._get(name)
        if not isinstance(value, str):
            raise self._wrong(f"{name} as a text", value)
        return value

    def texts(self, name: str) -> tuple[str, ...]:
        """Return a list of texts."""
        value = self._get(name)
        if not isinstance(value, list) or not all(isinstance(v, str) for v in value):
            raise self._wrong(f"{name} as a list of texts", value)
        return tuple(value)

    def flag(self, name: str) -> bool:
        """Return true or false."""
        value = self._get(name)
        if not isinstance(value, bool):
            raise self._wrong(f"{name} as true or false", value)
        return value

    def number(self, name: str) -> float:
        """Return a number that is not below 0."""
        value = self._get(name)
        if not _is_number(value):
            raise self._wrong(f"{name} as a number from 0", value)
        return float(value)

    def numbers(self, name: str) -> dict[str, float]:
        """Return numbers above 0 by their names."""
        value = self._mapping(name)
        if not all(_is_number(v) and v > 0 for v in value.values()):
            raise self._wrong(f"{name} as numbers above 0 by name", value)
        return {k: float(v) for k, v in value.items()}

    def values(self, name: str) -> dict[str, Value]:
        """Return values of settings by their keys."""
        value = self._mapping(name)
        if not all(isinstance(v, (bool, int, float, str)) for v in value.values()):
            raise self._wrong(f"{name} as values of settings by key", value)
        return dict(value)

    def table(self, name: str) -> PlanFields:
        """Return a table in this one."""
        return PlanFields(self._get(name), f"{self._where}, {name}")

    def tables(self, name: str) -> tuple[PlanFields, ...]:
        """Return a list of tables in this one."""
        value = self._get(name)
        if not isinstance(value, list):
            raise self._wrong(f"{name} as a list", value)
        return tuple(PlanFields(v, f"{self._where}, {name} {n}") for n, v in enumerate(value, 1))

    def _mapping(self, name: str) -> Mapping[str, Any]:
        value = self._get(name)
        if not isinstance(value, dict):
            raise self._wrong(f"{name} as a table", value)
        return value

    def _get(self, name: str) -> Any:
        if name not in self._data:
            raise self._wrong(name, None)
        return self._data[name]

    def _wrong(self, wanted: str, found: Any) -> BadInput:
        got = "nothing" if found is None else repr(found)
        return BadInput(
            f"{self._where} is damaged: {wanted} is wanted, found {got[:LONGEST]}: remove the plan and add it anew"
        )


LONGEST = 60
"""Characters of a wrong value that a message shows."""


def _is_number(value: Any) -> bool:
    return (
        isinstance(value, (int, float))
        and not isinstance(value, bool)
        and math.isfinite(value)
        and value >= 0
    )
