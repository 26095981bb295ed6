"""Files with tables of reamers and taps: a user's over the program's, and what of them is refused."""

from __future__ import annotations

import pytest

from own_shop import own_shop
from trunnion.findings import BadInput
from trunnion.shop import load_shop

SHOP = own_shop()
STEEL = SHOP.material("C45")
REAMING = """
[P]
title = "Our steel"

[P.speed]
value = 30
source = "tests of ours"

[P.feeds]
rows = [[2, 0.1, 0.2], [20, 0.3, 0.4]]
share = 0.5
source = "tests of ours"

[P.allowance]
rows = [[10, 0.1, 0.2], [20, 0.2, 0.3]]
source = "tests of ours"
"""
TAPPING = '[P]\ntitle = "Our steel"\n\n[P.speed]\nvalue = 15\nsource = "tests of ours"\n'


def folder(tmp_path, **texts):
    for kind, text in texts.items():
        (tmp_path / kind).mkdir()
        (tmp_path / kind / "own.toml").write_text(text, "utf-8")
    return tmp_path


def test_a_users_tables_take_the_place_of_the_programs(tmp_path):
    shop = load_shop(folder(tmp_path, reaming=REAMING, tapping=TAPPING))
    assert (shop.reaming_for(STEEL).speed, shop.tapping_for(STEEL).speed) == (30.0, 15.0)
    assert [shop.reaming_for(STEEL).allowance(d) for d in (10.0, 10.1, 30.0)] == [
        (0.1, 0.2),
        (0.2, 0.3),
        (0.2, 0.3),
    ]
    aluminium = SHOP.material("EN AW-7075")
    assert shop.reaming_for(aluminium) == SHOP.reaming_for(aluminium)
    assert shop.digest != SHOP.digest


@pytest.mark.parametrize(
    ("kind", "old", "new", "words"),
    [
        ("reaming", "[P.allowance]", "[P.allowances]", "P: allowance is missing"),
        (
            "reaming",
            "[[10, 0.1, 0.2], [20,",
            "[[10, 0.1, 0.2], [9,",
            "rows must be .diameter up to",
        ),
        ("reaming", "[10, 0.1, 0.2]", "[10, 0.3, 0.2]", "rows must be .diameter up to"),
        ("reaming", "[2, 0.1, 0.2]", "[2, 0.3, 0.2]", "rows must be .diameter, smallest f"),
        ("tapping", "value = 15", "value = 0", "value must be a number from 0.1 to 2000"),
        ("tapping", 'source = "tests of ours"\n', "", "source is missing"),
        ("tapping", "[P.speed]", "[P.feeds]\nshare = 1\n[P.speed]", "feeds is not a field here"),
    ],
)
def test_a_fault_in_a_table_is_told_with_its_name(tmp_path, kind, old, new, words):
    text = {"reaming": REAMING, "tapping": TAPPING}[kind].replace(old, new, 1)
    with pytest.raises(BadInput, match=words):
        load_shop(folder(tmp_path, **{kind: text}))
