"""What every registered dialect must do, whoever wrote it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from programs import BULL_10, FLAT_16, S1, WALL, program_1, section, verdict
from trunnion import registry
from trunnion.findings import BadInput, Refused
from trunnion.model.listing import listing
from trunnion.model.program import Program
from trunnion.model.toolpath import EMPTY
from trunnion.model.verdict import Outcome
from trunnion.post.contract import Dialect
from trunnion.post.header import REJECTED, STAMP_LINES, Header
from trunnion.post.readers import read_program
from trunnion.post.release import is_released
from trunnion.post.settings import PostSettings

HEADER = Header(name="B1", part="B1", part_digest="ab12", plan_digest="cd34")
PASSED = replace(HEADER, verdict=verdict())
TOOLS = (FLAT_16, BULL_10)


@pytest.fixture(params=registry.names("dialects"))
def dialect(request) -> Dialect:
    return registry.get("dialects", request.param)()


def test_it_has_the_name_that_it_is_registered_under(dialect):
    assert dialect.name in registry.names("dialects")
    assert dialect.suffix.isalnum()


def test_what_it_writes_it_reads_as_the_same_motions(dialect):
    text = dialect.write([program_1()], HEADER, PostSettings())
    assert listing(read_program(dialect.name, text, TOOLS, S1), marks=False) == listing(program_1(), marks=False)


def test_it_writes_the_same_bytes_twice_and_ends_with_a_line_end(dialect):
    first, second = (dialect.write([program_1()], PASSED, PostSettings()) for _ in range(2))
    assert first == second
    assert first.endswith("\n")


def test_its_text_begins_with_its_stamp(dialect):
    text = dialect.write([program_1()], PASSED, PostSettings())
    assert len(dialect.stamp("B1", PASSED)) == STAMP_LINES
    assert text.split("\n")[1:STAMP_LINES] == list(dialect.stamp("B1", PASSED)[1:])


def test_only_a_verdict_that_releases_makes_its_text_look_released(dialect):
    for header in (HEADER, replace(HEADER, verdict=verdict(Outcome.FAILED))):
        text = dialect.write([program_1()], header, PostSettings())
        assert not is_released(text)
        assert REJECTED in text.split("\n")[1]
    assert is_released(dialect.write([program_1()], PASSED, PostSettings()))


def test_every_block_knows_a_line_of_the_text(dialect):
    text = dialect.write([program_1()], HEADER, PostSettings())
    for part in read_program(dialect.name, text, TOOLS, S1).sections:
        assert len(part.block_lines) == len(part.path)
        assert list(part.block_lines) == sorted(part.block_lines)
        assert 0 < part.block_lines[0] <= part.block_lines[-1] <= text.count("\n")


def test_it_refuses_what_it_cannot_write(dialect):
    for bad in (section("op", FLAT_16, EMPTY), section("op", FLAT_16, WALL, coolant="steam"), section("", FLAT_16, WALL)):
        with pytest.raises(Refused):
            dialect.write([Program(name="B1.S1", setup=S1, sections=(bad,))], HEADER, PostSettings())


def test_a_text_cut_short_is_refused(dialect):
    lines = dialect.write([program_1()], HEADER, PostSettings()).split("\n")
    for keep in (0, 5, len(lines) // 2, len(lines) - 2):
        with pytest.raises(BadInput):
            read_program(dialect.name, "\n".join(lines[:keep]), TOOLS, S1)
