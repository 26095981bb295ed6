"""Typical plans: the order of work for a family of parts, as data that a shop changes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from trunnion.shop.reading import CatalogueEntry, by_name, entries


@dataclass(frozen=True, slots=True, kw_only=True)
class Stage:
    """One stage of a typical plan: an operation of `kind` by `strategy` for every feature of the kinds in `on` (`blank`: once a setup).

    `cutter` names the rule that chooses the tool (the family's planner says which there are), `finish` says whether it cuts to size (else
    it leaves the route's allowances); `after` names earlier stages that must be done on the same feature and on those of another kind
    beside it, `after_all` those that must be done on every feature; `rule` says why, in words.
    """

    name: str
    kind: str
    strategy: str
    on: tuple[str, ...]
    cutter: str
    finish: bool
    after: tuple[str, ...]
    after_all: tuple[str, ...]
    rule: str


@dataclass(frozen=True, slots=True, kw_only=True)
class TypicalPlan:
    """The stages of a family's work in order."""

    name: str
    title: str
    family: str
    stages: tuple[Stage, ...]


def load_plans(user_folder: Path | None) -> dict[str, TypicalPlan]:
    """Return the typical plans by name, in the order in which a family takes the first: a user's before those of registered packages,
    these before the program's, then by file name, then as they stand in the file. One replaces another of its name as a whole."""
    found = list(entries("plans", user_folder))
    folder = {entry.name: layer for layer, entry in found}
    by_id = by_name(found)
    return {name: _plan(by_id[name]) for name in sorted(by_id, key=lambda name: -folder[name])}


def _plan(entry: CatalogueEntry) -> TypicalPlan:
    title, family = entry.text("title"), entry.text("family")
    stages: list[Stage] = []
    for table in entry.tables("stage"):
        stage = _stage(table)
        unknown = [
            name
            for name in (*stage.after, *stage.after_all)
            if name not in {s.name for s in stages}
        ]
        if unknown:
            raise table.wrong(f"after names {unknown[0]!r}, which is no earlier stage")
        if stage.name in {s.name for s in stages}:
            raise table.wrong(f"the stage {stage.name!r} is given twice")
        stages.append(stage)
    entry.done()
    return TypicalPlan(name=entry.name, title=title, family=family, stages=tuple(stages))


def _stage(entry: CatalogueEntry) -> Stage:
    stage = Stage(
        name=entry.text("name"),
        kind=entry.text("kind"),
        strategy=entry.text("strategy"),
        on=entry.texts("on"),
        cutter=entry.text("cutter"),
        finish=entry.flag("finish"),
        after=entry.texts("after", ()),
        after_all=entry.texts("after_all", ()),
        rule=entry.text("rule"),
    )
    entry.done()
    return stage
