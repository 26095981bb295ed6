"""What every test may use: small parts as files."""

from __future__ import annotations

import os
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ["TRUNNION_USER_FOLDER"] = str(Path(tempfile.gettempdir()) / "trunnion-tests-no-folder")
"""No test reads the person's own plan library: one that needs a library makes it in a folder of its own."""

LONGEST_FIRST = (
    "test_cli_verify",
    "test_cli_batch",
    "test_strategies",
    "test_dexels",
    "test_tool_exchange",
    "test_drop_cutter",
    "test_whole_line",
    "test_plan_surface_route",
    "test_recognize_panel_parts",
    "test_repair_kinds",
    "test_stock_reads",
    "test_foreseen_load",
    "test_shop",
    "test_impeller_holes",
    "test_recognize_impeller",
    "test_seeded_parts",
    "test_own_family",
    "test_casing_recesses",
    "test_worker",
    "test_plan_swarf",
    "test_plan_leaning",
    "test_planners",
    "test_plan_hollows",
    "test_planted_faults_motion",
    "test_suitability",
    "test_flank_stock",
    "test_guide_edits",
    "test_family",
    "test_post_five_axis",
    "test_revised_part",
    "test_hole_demand",
    "test_casing_turning",
    "test_looks",
    "test_tab_positions",
    "test_patches",
    "test_face_edits",
    "test_skin",
    "test_contact",
    "test_plan_lands",
    "test_revision",
    "test_plan_library_panel",
    "test_deviation",
    "test_local_features",
    "test_window",
    "test_blank_line",
    "test_surface_ridges",
    "test_simulation",
    "test_viewport",
    "test_unsaved",
    "test_repair",
    "test_verify_zmap",
    "test_playback",
)
"""Files that take longer than ten seconds, so that none is left to one of two processes at the end. The first compile kernels that the
other one needs later, and not at the same time."""


def pytest_configure(config: pytest.Config) -> None:
    """Let properties say how few examples the quick run has of them."""
    config.addinivalue_line(
        "markers",
        "examples(quick): so few examples in the quick run, all of them in the long tests",
    )


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Make two tests of a property with the mark `examples`: one of few examples, and one of all of them for the long tests."""
    if (mark := metafunc.definition.get_closest_marker("examples")) is not None:
        every = metafunc.function._hypothesis_internal_use_settings.max_examples
        metafunc.fixturenames.append("examples")
        metafunc.parametrize(
            "examples", [mark.args[0], pytest.param(every, marks=pytest.mark.long)], ids=str
        )


@pytest.hookimpl(wrapper=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> Iterator[None]:
    """Look at as many examples as the case of a property has."""
    spec = getattr(pyfuncitem, "callspec", None)
    if pyfuncitem.get_closest_marker("examples") is None or spec is None:
        return (yield)
    test = pyfuncitem.function
    usual = test._hypothesis_internal_use_settings
    test._hypothesis_internal_use_settings = settings(usual, max_examples=spec.params["examples"])
    try:
        return (yield)
    finally:
        test._hypothesis_internal_use_settings = usual


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the files of `LONGEST_FIRST`; all others follow as they came."""
    rank = {name: n for n, name in enumerate(LONGEST_FIRST)}
    items.sort(key=lambda item: rank.get(item.path.stem, len(rank)))


@pytest.fixture(scope="session")
def sample_part() -> Path:
    """A small part as STEP: a block with a pocket."""
    from samples import block_with_pocket

    return Path(block_with_pocket())


@pytest.fixture(scope="session")
def sample_panel() -> Path:
    """A small panel as STEP: pockets with a low rib between, an island, an open pocket, an outer profile with rounded corners."""
    from samples import two_pockets_and_a_rib

    return Path(two_pockets_and_a_rib())


@pytest.fixture(scope="module", autouse=True)
def _parts_are_read_by_a_warm_process() -> Iterator[None]:
    """Read part files in processes forked off one that has loaded the CAD kernel, which takes most of the time of reading."""
    from trunnion.part.read import child
    from warm import CAN_FORK, READERS

    with pytest.MonkeyPatch.context() as patch:
        if CAN_FORK:
            patch.setattr(child, "subprocess", READERS)
        yield


@pytest.fixture(scope="module", autouse=True)
def _engines_share_the_programs_own_catalogues() -> Iterator[None]:
    """Read the catalogues for the first engine only, where it has no folder of a user."""
    from own_shop import shop_of

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("trunnion.pipeline.engine.load_shop", shop_of)
        yield


@pytest.fixture(autouse=True)
def _cold(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the mark `cold`, read part files as the program does."""
    if request.node.get_closest_marker("cold"):
        from trunnion.part.read import child

        monkeypatch.setattr(child, "subprocess", subprocess)
