"""What is written and read again moves the same, whatever the motions; `tests/conformance` does this for the programs of one setup."""

from __future__ import annotations

from hypothesis import given, settings

from programs import BULL_10, FLAT_16, S1, S2
from random_programs import program_of, programs, same
from trunnion.post.dialects.apt import AptDialect
from trunnion.post.dialects.linuxcnc import LinuxCncDialect
from trunnion.post.header import Header
from trunnion.post.settings import PostSettings

HEADER = Header(name="B1", part="B1", part_digest="ab12", plan_digest="cd34")


@settings(deadline=None, max_examples=40)
@given(programs, programs)
def test_apt_says_the_same_motions_when_read_again(first, second):
    made, dialect = (program_of(first), program_of(second, S2)), AptDialect()
    again = dialect.read(dialect.write(made, HEADER, PostSettings()), (FLAT_16, BULL_10), [S1, S2])
    for a, b in zip(made, again, strict=True):
        same(a, b, 5e-4)


@settings(deadline=None, max_examples=30)
@given(programs)
def test_what_was_read_is_written_with_the_same_words(parts):
    dialect = LinuxCncDialect()
    text = dialect.write([program_of(parts)], HEADER, PostSettings())
    (again,) = dialect.read(text, (FLAT_16, BULL_10), [S1])
    assert dialect.write([again], HEADER, PostSettings()) == text
