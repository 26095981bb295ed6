"""Settings: one declaration gives checking, words and messages."""

from __future__ import annotations

import pytest

from trunnion.findings import BadInput
from trunnion.settings import GROUPS, checked, choose, declared, digest, setting, settings


@settings("test.roughing")
class Roughing:
    """A group that only these tests know."""

    stepover: float = setting(
        0.4, unit="of diameter", low=0.05, high=0.95, label="Stepover", help="Width of cut."
    )
    passes: int = setting(2, low=1, high=9, label="Passes", help="How many.")
    climb: bool = setting(True, label="Climb", help="Direction.")
    style: str = setting("spiral", label="Style", help="Pattern.", choices=("spiral", "zigzag"))


def test_values_are_chosen_by_full_key_and_by_name() -> None:
    chosen = choose(Roughing, {"test.roughing.stepover": "0.3", "passes": 4, "other.key": "x"})
    assert (chosen.stepover, chosen.passes, chosen.climb) == (0.3, 4, True)


def test_a_value_out_of_range_is_refused_in_words() -> None:
    with pytest.raises(BadInput) as refused:
        choose(Roughing, {"stepover": 2})
    assert (
        str(refused.value)
        == "Stepover (test.roughing.stepover) must be from 0.05 to 0.95 of diameter; got 2"
    )


@pytest.mark.parametrize(
    ("name", "wrong"),
    [("stepover", "nan"), ("passes", 1.5), ("passes", True), ("climb", "maybe"), ("style", "star")],
)
def test_a_wrong_value_of_each_kind_is_refused(name: str, wrong: object) -> None:
    with pytest.raises(BadInput, match=f"test.roughing.{name}"):
        choose(Roughing, {name: wrong})  # type: ignore[dict-item]


@pytest.mark.parametrize(
    ("text", "value"), [("yes", True), ("Off", False), ("1", True), (False, False)]
)
def test_truth_is_read_in_words(text: str | bool, value: bool) -> None:
    assert choose(Roughing, {"climb": text}).climb is value


def test_constructors_only_store_and_checked_looks() -> None:
    with pytest.raises(BadInput):
        checked(Roughing(stepover=7.0))


def test_words_round_trip() -> None:
    chosen = Roughing(stepover=0.25, style="zigzag")
    assert choose(Roughing, {d.key: getattr(chosen, d.name) for d in declared(Roughing)}) == chosen


def test_a_digest_sees_every_value_and_the_type() -> None:
    assert digest(Roughing()) == digest(Roughing())
    assert digest(Roughing()) != digest(Roughing(stepover=0.41))
    assert digest(1, "a") != digest("a", 1)


def test_every_declared_setting_says_what_it_is() -> None:
    from trunnion.pipeline import Engine

    Engine().settings()
    for group in list(GROUPS.values()):
        for d in declared(group):
            assert d.label and d.help and d.help[-1] == ".", d.key
            assert d.parse(d.default) == d.default, d.key
            assert d.kind in (bool, str) or (d.low is not None and d.high is not None), (
                f"{d.key} needs a range"
            )
            assert d.kind is not float or d.unit, f"{d.key} needs a unit"


def test_two_groups_of_one_name_are_refused() -> None:
    with pytest.raises(ValueError, match="test.roughing"):

        @settings("test.roughing")
        class Other:
            """Takes a name that is taken."""
