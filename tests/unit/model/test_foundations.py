"""Floor 0: findings, progress, registry, units."""

from __future__ import annotations

import pytest

from trunnion import findings, registry
from trunnion.findings import BadCall, Cancelled, face_tags, has_errors
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.units import trimmed


def test_a_finding_says_what_where_and_what_to_do() -> None:
    found = findings.warning(
        "panel.leaning-wall", "the wall leans", "face 12", remedy="use a swarf strategy"
    )
    assert (
        str(found) == "warning panel.leaning-wall: the wall leans (face 12): use a swarf strategy"
    )
    assert found.as_dict()["where"] == ["face 12"]


def test_only_errors_count_as_errors() -> None:
    assert not has_errors([findings.info("a", "b"), findings.warning("a", "b")])
    assert has_errors([findings.remark("a", "b"), findings.error("a", "b")])


def test_a_line_names_eight_places_and_json_all_of_them() -> None:
    found = findings.warning(
        "a.b", "they lean", "pocket-01", *face_tags(range(200, 0, -1)), remedy="tilt"
    )
    assert str(found).endswith(
        "(pocket-01, face 1, face 2, face 3, face 4, face 5, face 6, face 7 and 193 more): tilt"
    )
    assert found.as_dict()["where"] == ["pocket-01", *(f"face {n}" for n in range(1, 201))]


def test_eight_places_are_all_named() -> None:
    assert findings.info("a.b", "so", *face_tags(range(1, 9))).location.endswith("face 7, face 8")


def test_a_part_of_progress_reports_its_own_share() -> None:
    seen: list[tuple[float, str]] = []
    Progress(lambda f, t: seen.append((f, t))).part(0.5, 1.0).part(0.0, 0.5).at(1.0, "half way")
    assert seen == [(0.75, "half way")]


def test_a_cancelled_job_stops_at_the_next_look() -> None:
    with pytest.raises(Cancelled):
        Progress(cancelled=lambda: True).at(0.1)


def test_quiet_progress_counts_over_things() -> None:
    assert list(NO_PROGRESS.over([1, 2, 3])) == [1, 2, 3]


def test_an_unknown_name_is_refused_with_the_known_ones() -> None:
    with pytest.raises(BadCall, match="known: .*linuxcnc"):
        registry.get("dialects", "klingon")


@pytest.mark.parametrize(
    ("value", "text"), [(12.5, "12.5"), (-0.00001, "0"), (40.0, "40"), (-3.25, "-3.25")]
)
def test_numbers_are_written_without_trailing_zeros(value: float, text: str) -> None:
    assert trimmed(value, 3) == text
