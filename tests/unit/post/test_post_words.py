"""Words of dialects as data, texts as comments, numbers as written."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from importlib.resources import files

import pytest

from trunnion.findings import BadInput
from trunnion.post.iso_words import IsoWords, checked_iso_words, iso_words
from trunnion.post.readers.word_address.language import ControlLanguage
from trunnion.post.readers.word_address.modes import MEANINGS
from trunnion.post.settings import PostSettings
from trunnion.post.ticks import TickScale
from trunnion.post.words import checked_words, dialect_words, plain

TABLE = tomllib.loads((files("trunnion_resources") / "dialects" / "linuxcnc.toml").read_text())


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"colour": "red"}, "dialect x: unknown word colour; known: title, suffix, comment"),
        ({"suffix": None}, "dialect x: the word suffix is missing"),
        ({"suffix": 3}, "dialect x: suffix must be a text; got 3"),
        ({"feed_decimals": True}, "dialect x: feed_decimals must be a whole number; got True"),
        (
            {"motions": ["G0", "G1"]},
            r"dialect x: motions must be a list of texts; got \['G0', 'G1'\]",
        ),
        ({"units": {"mm": 21}}, "dialect x: units must be a table of texts"),
        ({"title": ""}, "dialect x: title must be a text; got ''"),
    ],
)
def test_wrong_words_are_refused(change, message):
    table = {k: v for k, v in {**TABLE, **change}.items() if v is not None}
    with pytest.raises(BadInput, match=message):
        checked_words(IsoWords, "x", table)


def test_a_word_that_has_a_default_may_be_missing():
    table = {
        k: v for k, v in TABLE.items() if k not in ("inverse_time", "per_minute", "angle_decimals")
    }
    assert checked_words(IsoWords, "x", table).inverse_time == ""


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"centres": "end"}, "dialect x: centres must be one of start, absolute; got 'end'"),
        ({"units": {"mm": "G21"}}, "dialect x: units needs an entry inch"),
        ({"coolant": {"flood": "M8"}}, "dialect x: coolant needs an entry off"),
        ({"letters": {"length": "H"}}, "dialect x: letters needs an entry radius"),
        (
            {"letters": {"radius": "CR"}},
            "dialect x: letters must be one letter each, or a word with =, for some of radius, .*; got radius = 'CR'",
        ),
        (
            {"letters": {"radius": "R", "colour": "Q"}},
            "dialect x: letters must be .*; got colour = 'Q'",
        ),
        (
            {"start": ("{unit}",)},
            r"dialect x: start: \{unit\} is not known; known: units, tolerance, offset",
        ),
        ({"end": ("M30 {}",)}, r"dialect x: end: \{\} is not known; known: none"),
        (
            {"restart": "G90 {offset"},
            "dialect x: restart: expected '}' before end of string; write braces as {{ and }}",
        ),
    ],
)
def test_words_that_no_control_can_use_are_refused(change, message):
    with pytest.raises(BadInput, match=message):
        checked_iso_words("x", replace(iso_words("linuxcnc"), **change))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"codes": {"M30": "stop"}},
            "dialect LinuxCNC: M30: 'stop' is no meaning of a code; known: units, ",
        ),
        ({"letters": {"radius": "R"}}, "dialect LinuxCNC: letters needs an entry dwell for G4"),
    ],
)
def test_codes_that_the_reader_cannot_follow_are_refused(change, message):
    with pytest.raises(BadInput, match=message):
        ControlLanguage(replace(iso_words("linuxcnc"), **change), None, MEANINGS)


def test_a_dialect_without_words_is_refused():
    with pytest.raises(BadInput, match="dialect nobody: its words can't be read"):
        dialect_words(IsoWords, "nobody")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("Träger (links)", "Trager [links]"),
        ("a;b$c\nd", "abc d"),
        ("x" * 20, "xxxxxx ..."),
        ("日本", ""),
    ],
)
def test_a_comment_is_one_plain_line(text, said):
    assert plain(text, 10 if text[0] == "x" else 40) == said


@pytest.mark.parametrize(
    ("ticks", "said"),
    [(0, "0"), (1, "0.0001"), (-1, "-0.0001"), (125000, "12.5"), (-400000, "-40")],
)
def test_ticks_are_written_without_trailing_zeros(ticks, said):
    assert TickScale.of(PostSettings(), 1, 1).text(ticks) == said


@pytest.mark.parametrize(("feed", "said"), [(400.0, "400"), (0.001, "0.1"), (1234.56, "1234.6")])
def test_a_feed_is_never_written_as_zero(feed, said):
    assert TickScale.of(PostSettings(), 1, 1).feed(feed) == said


def test_an_inch_has_one_decimal_more():
    scale = TickScale.of(PostSettings(units="inch"), 1, 1)
    assert (scale.decimals, scale.text(int(scale.ticks(25.4 * 1.00001)))) == (5, "1.00001")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"cycles": {"thread": "G76"}}, "dialect x: cycles knows drill, dwell, .*; got thread"),
        (
            {"letters": {"radius": "R", "dwell": "P", "retract": "R"}},
            "dialect x: letters needs an entry peck for the cycle peck",
        ),
        ({"return_levels": ("", "")}, "dialect x: return_levels is missing for the cycle drill"),
    ],
)
def test_words_of_cycles_that_say_too_little_are_refused(change, message):
    with pytest.raises(BadInput, match=message):
        checked_iso_words("x", replace(iso_words("linuxcnc"), **change))
