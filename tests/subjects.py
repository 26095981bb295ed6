"""What the suites of `tests/conformance` run over: everything registered, ours and packages', and small parts that need it.

A package's own sample parts lie in its folder `samples`, as ours do; a family is looked at on the parts that are taken for it.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from importlib.resources import as_file
from types import MappingProxyType
from typing import Any

import pytest

import samples
from long_mark import mostly_long
from own_packages import names, with_own_packages
from seeded.casings import short_ring
from seeded.impellers import small_impeller
from shaped_parts import bowl
from trunnion import registry
from trunnion.findings import BadInput, Cancelled
from trunnion.model.session import Session
from trunnion.part.part import Part
from trunnion.pipeline import Engine
from trunnion.pipeline.planning.family import ratings
from trunnion.plan.turning.drive import RevolvedDrive
from trunnion.progress import Progress
from trunnion.settings import Value, checked, choose, declared

FAMILIES, PLANNERS, STRATEGIES = names("families"), names("planners"), names("strategies")
with with_own_packages():
    TURNING = [n for n in STRATEGIES if registry.get("strategies", n).drive is RevolvedDrive]
MILLING = [n for n in STRATEGIES if n not in TURNING]
"""Strategies that turn the work, and those whose tools rotate."""
DEAR = ("channel.rough", "channel.hub", "impeller")
"""Strategies and families whose paths take long: checks that make them several times, or prove them, are of the long tests."""
MOST_CALLS = 100_000
"""Calls of the interpreter between two looks at cancel: less than 0.1 s (measured: 250 000 take 0.15 s)."""

BOWL = {"surface.scallop": 0.02}
"""Choices for the small part of curved surfaces: wide passes."""
SHELL = {"setup.machine": "Trunnion 650"}
"""Choices for the small casing: bosses all round ask for five axes."""
WHEEL = {
    "setup.machine": "Trunnion 650",
    "impeller.scallop": 0.2,
    "impeller.layer": 4.0,
    "verify.coverage": 0.3,
}
"""Choices for the small wheel: on five axes, coarse, and without what no ball reaches in its sharp roots."""


@cache
def engines() -> dict[str, tuple[Engine, Session]]:
    """Return an engine and its session with features for each small part, by the part's name."""
    found = {}
    for name, file, choices in (
        ("pockets", samples.written(samples.two_pockets_and_a_rib_shape()), {}),
        ("bowl", samples.written(bowl(20.0, 16.0, 8.0, 6.0).shape, name="bowl"), BOWL),
        ("shell", samples.written(short_ring(), name="shell-with-bosses"), SHELL),
        ("wheel", samples.written(small_impeller(), name="wheel"), WHEEL),
    ):
        found[name] = _recognized(file, choices)
    for folder in registry.resource_folders("samples")[1:]:
        for sample in sorted(folder.iterdir(), key=lambda f: f.name) if folder.is_dir() else ():
            with as_file(sample) as file:
                found[sample.name] = _recognized(file)
    return found


def _recognized(
    file: Any, choices: Mapping[str, Value] = MappingProxyType({})
) -> tuple[Engine, Session]:
    """Return an engine with a part and choices for it, and its session with features."""
    engine = Engine()
    session = engine.with_choices(engine.open(file), choices)
    return engine, engine.run(session, until="recognize")


def part_of(engine: Engine) -> Part:
    return engine.context.part


@cache
def own(family: str) -> tuple[Engine, Session]:
    """Return an engine with a small part that is taken for a family, and its session with features."""
    for engine, session in engines().values():
        if ratings(part_of(engine).graph())[0].name == family:
            return engine, session
    raise AssertionError(f"no small part is taken for a {family}: add a sample to its package")


def foreign(family: str) -> list[Part]:
    """Return the small parts that are taken for another family."""
    return [part_of(e) for e, _ in engines().values() if part_of(e) is not part_of(own(family)[0])]


@cache
def until(family: str, step: str) -> Session:
    """Return the session of a family's small part after a step."""
    engine, session = own(family)
    return engine.run(session, until=step)


def dear_ones_long(names: list[str]) -> list[Any]:
    """Return strategies or families for `parametrize`, those whose paths take long marked long."""
    return mostly_long(names, *(n for n in names if n not in DEAR))


def is_one_line(words: str) -> bool:
    """Return whether words are one line for a person."""
    return bool(words.strip()) and "\n" not in words and "Error" not in words


def check_settings(group: type) -> None:
    """Check that a group of settings says all that forms, pages and messages are made of, and refuses a wrong value in words."""
    assert group.__doc__ and group.GROUP
    assert checked(choose(group, {})) == group()
    for each in declared(group):
        assert each.label and each.help, each.key
        if each.kind in (int, float):
            assert each.low is not None and each.high is not None and each.low < each.high, each.key
            assert each.low <= each.default <= each.high, each.key
        wrong = each.high + 1.0 if each.kind in (int, float) else 5 if each.kind is str else "maybe"
        with pytest.raises(BadInput) as refused:
            choose(group, {each.key: wrong})
        assert each.key in str(refused.value) and is_one_line(str(refused.value))


class Watch:
    """A progress that counts looks and the calls between two of them, and asks to stop at a look where told."""

    def __init__(self, stop_at: int = sys.maxsize) -> None:
        self.looks, self.most, self._calls, self._stop_at = 0, 0, 0, stop_at

    def look(self) -> bool:
        """Count a look; return whether to stop."""
        self.looks, self.most, self._calls = self.looks + 1, max(self.most, self._calls), 0
        return self.looks >= self._stop_at

    def _count(self, frame: object, event: str, argument: object) -> None:
        self._calls += event in ("call", "c_call")

    @contextmanager
    def watching(self) -> Iterator[Progress]:
        """Give the progress, and count while it is used."""
        before = sys.getprofile()
        sys.setprofile(self._count)
        try:
            yield Progress(lambda *_: None, self.look)
        finally:
            sys.setprofile(before)
            self.most = max(self.most, self._calls)


def check_cancel(work: Callable[[Progress], Any]) -> None:
    """Check that a piece of work looks at its progress often enough, and stops half-way where it is asked to.

    It must have been done once before: what is imported, compiled or kept the first time doesn't count.
    """
    whole = Watch()
    with whole.watching() as progress:
        work(progress)
    assert whole.looks > 0 and whole.most <= MOST_CALLS
    with pytest.raises(Cancelled):
        work(Progress(cancelled=Watch(stop_at=whole.looks // 2 + 1).look))


__all__ = [
    "DEAR",
    "FAMILIES",
    "PLANNERS",
    "STRATEGIES",
    "check_cancel",
    "check_settings",
    "dear_ones_long",
    "engines",
    "foreign",
    "is_one_line",
    "own",
    "part_of",
    "until",
    "with_own_packages",
]
