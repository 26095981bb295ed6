"""Where the parts with known truth are, and the marker for tests that need them."""

from __future__ import annotations

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
_beside = ROOT.parent / "shared" / "parts"
PARTS: Path | None = _beside if _beside.is_dir() else None
"""The folder of parts with known truth beside the project, or None."""

needs_parts = pytest.mark.skipif(
    PARTS is None, reason="the folder ../shared/parts with known truths is not beside the project"
)
