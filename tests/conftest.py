"""What every test may use: where the shared parts are, and the marker for tests that need them."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
_beside = ROOT.parent / "shared" / "parts"
PARTS: Path | None = _beside if _beside.is_dir() else None
"""The folder of parts with known truth beside the project, or None."""

needs_parts = pytest.mark.skipif(PARTS is None, reason="the folder ../shared/parts with known truths is not beside the project")

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")


@pytest.fixture(scope="session")
def sample_part(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small panel as STEP: a block with a pocket."""
    from samples import block_with_pocket
    return Path(block_with_pocket())


@pytest.fixture(scope="session")
def sample_panel() -> Path:
    """A small panel as STEP: pockets with a low rib between, an island, an open pocket, an outer profile with rounded corners."""
    from samples import two_pockets_and_a_rib
    return Path(two_pockets_and_a_rib())
