"""Words of dialects as data, texts as comments, numbers as written."""

from __future__ import annotations

import tomllib
from importlib.resources import files

import pytest

from trunnion.findings import BadInput
from trunnion.post.iso_words import IsoWords
from trunnion.post.settings import PostSettings
from trunnion.post.ticks import Scale
from trunnion.post.words import checked_words, dialect_words, plain

TABLE = tomllib.loads((files("trunnion_resources") / "dialects" / "linuxcnc.toml").read_text())


@pytest.mark.parametrize(("change", "message"), [
    ({"colour": "red"}, "dialect x: unknown word colour; known: title, suffix, comment"),
    ({"suffix": None}, "dialect x: the word suffix is missing"),
    ({"suffix": 3}, "dialect x: suffix must be a text; got 3"),
    ({"feed_decimals": True}, "dialect x: feed_decimals must be a whole number; got True"),
    ({"motions": ["G0", "G1"]}, r"dialect x: motions must be a list of texts; got \['G0', 'G1'\]"),
    ({"units": {"mm": 21}}, "dialect x: units must be a table of texts"),
    ({"title": ""}, "dialect x: title must be a text; got ''"),
])
def test_wrong_words_are_refused(change, message):
    table = {k: v for k, v in {**TABLE, **change}.items() if v is not None}
    with pytest.raises(BadInput, match=message):
        checked_words(IsoWords, "x", table)


def test_a_dialect_without_words_is_refused():
    with pytest.raises(BadInput, match="dialect nobody: its words can't be read"):
        dialect_words(IsoWords, "nobody")


@pytest.mark.parametrize(("text", "said"), [("Träger (links)", "Trager [links]"), ("a;b$c\nd", "abc d"), ("x" * 20, "xxxxxx ..."),
                                            ("日本", "")])
def test_a_comment_is_one_plain_line(text, said):
    assert plain(text, 10 if text[0] == "x" else 40) == said


@pytest.mark.parametrize(("ticks", "said"), [(0, "0"), (1, "0.0001"), (-1, "-0.0001"), (125000, "12.5"), (-400000, "-40")])
def test_ticks_are_written_without_trailing_zeros(ticks, said):
    assert Scale.of(PostSettings(), 1, 1).text(ticks) == said


@pytest.mark.parametrize(("feed", "said"), [(400.0, "400"), (0.001, "0.1"), (1234.56, "1234.6")])
def test_a_feed_is_never_written_as_zero(feed, said):
    assert Scale.of(PostSettings(), 1, 1).feed(feed) == said


def test_an_inch_has_one_decimal_more():
    scale = Scale.of(PostSettings(units="inch"), 1, 1)
    assert (scale.decimals, scale.text(int(scale.ticks(25.4 * 1.00001)))) == (5, "1.00001")
