"""Guide lines in the window: of the selected operation, in their kind's colour, until something else is selected."""

from __future__ import annotations

import pytest
from fake_engine import FLOOR, POCKETS
from test_viewport import hue, pixel

from trunnion_gui.look.colours import guide_colours, rgb


@pytest.fixture
def planned(window, part_file, idle):
    """A window with a plan of the made-up part, seen from the top."""
    window.document.files.open(part_file)
    idle(window)
    window.document.program()
    idle(window)
    window.registry.run("view.top")
    window.viewport.show_layer("paths", False)
    return window


def an_operation(window, feature="pocket-01"):
    return next(o.id for o in window.document.session.process.operations if o.feature == feature)


def colour_at(window, place):
    return hue(pixel(window, place)) @ hue(rgb(guide_colours()["wall"]))


def test_the_line_of_the_selected_operation_is_shown_and_goes_with_it(planned, qtbot) -> None:
    x0, y0, x1, _ = POCKETS[0]
    foot = (0.5 * (x0 + x1) + 3.0, y0, FLOOR)
    planned.document.selection.select_operation(an_operation(planned))
    assert not planned.guides.shown.lines
    planned.registry.action("view.guides").trigger()
    qtbot.waitUntil(lambda: bool(planned.guides.shown.lines), timeout=20000)
    assert colour_at(planned, foot) > 0.9
    rows = [row[1:] for row in planned.viewport.legend.rows]
    assert ("Guide line", "1") in rows and ("Comes to the next wall", "4") in rows
    planned.document.selection.select_feature("rib-01")
    qtbot.waitUntil(lambda: not planned.guides.shown.lines, timeout=20000)
    assert colour_at(planned, foot) < 0.9


def test_another_operation_has_others_and_none_is_told_why(planned, qtbot) -> None:
    planned.registry.action("view.guides").trigger()
    for number in (1, 2):
        planned.document.selection.select_operation(an_operation(planned, f"pocket-{number:02d}"))
        x0, y0 = POCKETS[number - 1][:2]
        qtbot.waitUntil(
            lambda x0=x0, y0=y0: (
                [tuple(line.points[0][:2]) for line in planned.guides.shown.lines] == [(x0, y0)]
            ),
            timeout=20000,
        )
    other = next(
        o.id
        for o in planned.document.session.process.operations
        if not o.feature.startswith("pocket")
    )
    planned.document.selection.select_operation(other)
    qtbot.waitUntil(lambda: "nothing leads it" in planned.viewport.notice.text, timeout=20000)


def test_switched_off_there_are_none(planned, qtbot) -> None:
    planned.document.selection.select_operation(an_operation(planned))
    planned.registry.action("view.guides").trigger()
    qtbot.waitUntil(lambda: bool(planned.guides.shown.lines), timeout=20000)
    planned.registry.action("view.guides").trigger()
    assert not planned.guides.shown.lines and not planned.viewport._guide_lines
