"""What every test may use: small parts as files."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")


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
