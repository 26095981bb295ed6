"""The setup sheet's row of a turning insert in a locked spindle."""

from __future__ import annotations

from dataclasses import replace

from flat_parts import operation
from gap_turning import BUTTON_12, gap_data
from trunnion.report.html import spindle


def test_the_sheet_says_that_the_spindle_is_locked_and_how_fast_the_table_turns():
    gaps = replace(operation("interrupted", "pocket-01", BUTTON_12), data=gap_data())
    assert spindle(gaps) == "locked, table 30.0"
