"""Answers that are kept: worked out once, the longest unused forgotten first; and regions told apart by their loops."""

from __future__ import annotations

from pytest import approx

from trunnion.geometry.cache import Cache
from trunnion.geometry.plane.region import Region


def test_an_answer_is_worked_out_once() -> None:
    worked: list[str] = []
    memo: Cache[str] = Cache(2)

    def ask(what: str) -> str:
        return memo.get(what, lambda: worked.append(what) or what.upper())  # type: ignore[func-returns-value]

    assert [ask("a"), ask("a"), ask("b")] == ["A", "A", "B"]
    assert worked == ["a", "b"]


def test_the_longest_unused_answer_is_forgotten_first() -> None:
    worked: list[str] = []
    memo: Cache[str] = Cache(2)
    for what in "abacab":
        memo.get(what, lambda asked=what: worked.append(asked) or asked)  # type: ignore[misc]
    assert worked == ["a", "b", "c", "b"]
    assert len(memo) == 2


def test_equal_regions_give_the_very_same_offset_and_others_do_not() -> None:
    one, same, other = (
        Region.rectangle(0, 0, 4, 3),
        Region.rectangle(0, 0, 4, 3),
        Region.rectangle(0, 0, 4, 3.5),
    )
    assert one.digest() == same.digest() != other.digest()
    assert one.offset(1.0) is same.offset(1.0)
    assert one.offset(1.0) is not other.offset(1.0)
    assert one.minus(other.moved(1.0, 0.0)) is same.minus(other.moved(1.0, 0.0))


def test_an_island_and_a_piece_of_the_same_loops_are_told_apart() -> None:
    outer, inner = Region.rectangle(0, 0, 9, 9), Region.rectangle(3, 3, 6, 6)
    with_island = outer.minus(inner)
    both = Region((*outer.pieces, *inner.pieces))
    assert with_island.digest() != both.digest()


def test_what_lies_beside_does_not_change_what_is_cut_off() -> None:
    plate = Region.rectangle(0, 0, 100, 50)
    for x in (10, 40, 70):
        plate = plate.minus(Region.circle((x, 25), 8))
    window = Region.rectangle(30, 10, 60, 40)
    assert window.minus(plate).area == approx(Region.circle((40, 25), 8).area)
    assert abs(plate.intersect(window).area + window.minus(plate).area - window.area) < 1e-9
    assert abs(plate.minus(window).area - (plate.area - plate.intersect(window).area)) < 1e-9
