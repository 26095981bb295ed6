"""Tables of thread milling: what the program brings, and what of a user's file is refused."""

from __future__ import annotations

import pytest

from own_shop import own_shop
from trunnion.findings import BadInput
from trunnion.shop import load_shop

SHOP = own_shop()

OWN = """
[P]
title = "Steel of ours"
[P.speed]
value = 50
source = "tests of ours"
[P.feeds]
rows = [[2, 0.02], [10, 0.08]]
source = "tests of ours"
[P.passes]
rows = [[1, 1], [3, 2]]
source = "tests of ours"
"""


def own(folder, text):
    (folder / "thread_milling").mkdir()
    (folder / "thread_milling" / "own.toml").write_text(text, "utf-8")
    return load_shop(folder)


@pytest.mark.parametrize(
    ("material", "speed", "feed"),
    # ISCAR Threading Handbook, page 223: middle of the range, feed a tooth at D 6.
    [
        ("EN AW-7075", 115, 0.13),
        ("C45", 65, 0.07),
        ("Ti-6Al-4V", 30, 0.06),
        ("Inconel 718", 20, 0.06),
    ],
)
def test_every_material_has_the_data_of_its_group_or_its_own(material, speed, feed):
    table = SHOP.thread_milling_for(SHOP.material(material))
    assert table.speed == speed and dict(table.feeds)[6] == feed
    assert table.source.startswith("speed: ISCAR")


def test_coarse_pitches_are_cut_in_more_passes():
    # Allied Machine, Technical Guide, page 120: 1.00, 2.00 and 2.50 mm, easy, average and difficult.
    passes = {g: [SHOP.thread_milling[g].passes(p) for p in (1.0, 2.0, 2.5)] for g in "NPS"}
    assert passes == {"N": [1, 1, 2], "P": [1, 2, 3], "S": [2, 3, 4]}


def test_a_table_of_ones_own_replaces_the_programs(tmp_path):
    shop = own(tmp_path, OWN)
    assert shop.thread_milling["P"].passes(3.0) == 2
    assert shop.digest != SHOP.digest


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("value = 50", "value = 0", "value must be a number from 0.1 to 2000"),
        ("[10, 0.08]", "[2, 0.08]", "grow from row to row"),
        ("[2, 0.02]", "[2, 0]", "feed a tooth"),
        ("[3, 2]", "[3, 2.5]", "whole number of passes"),
        ('source = "tests of ours"\n[P.passes]', "[P.passes]", "source is missing"),
        ("[P.passes]", "[P.passes]\nshare = 1", "share is not a field here"),
    ],
)
def test_a_fault_is_told_with_its_field(tmp_path, old, new, words):
    with pytest.raises(BadInput, match=words):
        own(tmp_path, OWN.replace(old, new, 1))
