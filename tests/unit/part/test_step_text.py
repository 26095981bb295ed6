"""Entities in the text of a STEP file: found whatever stands in texts and remarks, parsed, and damage said in one line."""

from __future__ import annotations

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from trunnion.part.read.step_text import (
    BadEntity,
    EntityNumber,
    EntityRecord,
    StepText,
    StepWord,
    decoded,
    numbers_in,
)


def parameters(body: str) -> tuple[object, ...]:
    """Return the parameters of an entity `A(...)`."""
    return StepText(f"#1=A({body});".encode(), ["A"]).entity(1).parameters("A")


def written(value: object) -> str:
    """Return a parameter as ISO 10303-21 writes it."""
    if value is None:
        return "$"
    if isinstance(value, EntityNumber):
        return f"#{value.number}"
    if isinstance(value, StepWord):
        return f".{value.word}."
    if isinstance(value, EntityRecord):
        return f"{value.type}({','.join(map(written, value.parameters))})"
    if isinstance(value, tuple):
        return f"({','.join(map(written, value))})"
    if isinstance(value, str):
        return "'" + value.replace("\\", "\\\\").replace("'", "''") + "'"
    return repr(value).upper()


WORDS = st.from_regex(r"[A-Z][A-Z0-9_]{0,8}", fullmatch=True)
TEXTS = st.text(st.characters(exclude_categories=["Cs", "Cc"]), max_size=12)
PARAMETERS = st.recursive(
    st.none()
    | st.integers(1, 10**9).map(EntityNumber)
    | WORDS.map(StepWord)
    | TEXTS
    | st.floats(-1e12, 1e12),
    lambda inside: (
        st.lists(inside, max_size=4).map(tuple)
        | st.builds(EntityRecord, WORDS, st.lists(inside, max_size=3).map(tuple))
    ),
    max_leaves=12,
)


@given(st.lists(PARAMETERS, max_size=5).map(tuple))
@example(("it's; #2=B(", StepWord("T"), (EntityNumber(3), None), 1e-7))
def test_what_is_written_is_read_back(values: tuple[object, ...]) -> None:
    assert parameters(",".join(map(written, values))) == values


@given(st.binary(max_size=60))
@example(b"((((")
@example(b"'")
@example(b"#" + b"9" * 5000 + b"=A();")
def test_any_bytes_are_read_or_said_to_be_damaged(data: bytes) -> None:
    text = StepText(b"#1=A(" + data + b");#2=A(1.);", ["A"])
    for entity in text.of_types("A"):
        assert entity.parameters("A") is not None
    if 1 in text:
        try:
            text.entity(1)
        except BadEntity as reason:
            assert str(reason).startswith("#1 ")


def test_an_entity_in_a_text_or_a_remark_is_none() -> None:
    text = StepText(b"#1=A('; #2=A(0.);');/* #3=A('don''t);*/ #4=A(4.);", ["A"])
    assert [e.number for e in text.of_types("A")] == [1, 4]
    assert text.count == 2


def test_positions_count_all_entities_in_the_order_of_the_text() -> None:
    text = StepText(b"#50=X();#7=FACE(1.);#9=(A() B(2.));#8=FACE(3.);", ["B"], ["FACE"])
    assert text.positions == {7: 2, 8: 4}
    assert text.count == 4
    assert text.entity(9).types == ("A", "B")


def test_only_entities_of_the_types_are_there() -> None:
    text = StepText(b"#1=A();#2=AB();#3=(AB() C());", ["A"])
    assert (1 in text, 2 in text, 3 in text) == (True, False, False)
    with pytest.raises(BadEntity, match=r"#2 is not in the file, or of another type"):
        text.entity(2)


@pytest.mark.parametrize(
    ("body", "what"),
    [
        ("A(1.,(2.)", "#12 has a bracket too few"),
        ("A(1.)),A(2.", "#12 has a bracket too many"),
        ("A(1.,&)", "#12 can't be understood"),
        ("A(1.),2.", "#12 can't be understood"),
    ],
)
def test_damage_is_said_with_the_number_of_the_entity(body: str, what: str) -> None:
    with pytest.raises(BadEntity, match=f"^{what}$"):
        StepText(f"#12={body};".encode(), ["A"]).entity(12)


@pytest.mark.parametrize(
    ("text", "read"),
    [
        (rb"it''s", "it's"),
        (rb"\X2\00D8\X0\12", "Ø12"),
        (rb"\X\D812", "Ø12"),
        (rb"\S\X12", "Ø12"),
        (rb"\X4\0001F529\X0\ M6", "🔩 M6"),
        (rb"TXT\\w2X", "TXT\\w2X"),
        ("Ø12".encode(), "Ø12"),
        ("Ø12".encode("latin-1"), "Ø12"),
        (b"in two\n lines", "in two lines"),
    ],
)
def test_letters_are_as_iso_10303_21_encodes_them(text: bytes, read: str) -> None:
    assert decoded(text) == read


def test_links_go_from_one_parameter_to_another_or_to_the_entity() -> None:
    text = StepText(b"#1=A(#8,(#5,#6));#2=A(#8,B(#7));#3=A(#8);#4=A('',#9);", ["A"])
    assert text.links(0, 1, "A") == {8: [5, 6, 7]}
    assert text.links(0, None, "A") == {8: [1, 2, 3]}
    assert numbers_in((EntityNumber(1), "x", (EntityNumber(2),), None)) == [1, 2]


def test_damage_among_entities_of_a_type_is_noted() -> None:
    text = StepText(b"#1=A(&);#2=A(1.);#3=B(&);", ["A", "B"])
    assert [e.number for e in text.of_types("A")] == [2]
    assert text.damage == {1: "#1 can't be understood"}


def test_lists_may_be_nested_deeper_than_functions_call_each_other() -> None:
    depth = 5000
    text = StepText(b"#1=A(" + b"(" * depth + b"#7" + b")" * depth + b");", ["A"])
    assert numbers_in(text.entity(1).parameters("A")) == [7]
