"""Marking what repeats a subject that the quick run has cases of: these cases are left to the long tests."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest


def mostly_long(cases: Iterable[Any], *quick: Any) -> list[Any]:
    """Return cases for `parametrize`, all but the quick ones marked long."""
    return [c if c in quick else pytest.param(c, marks=pytest.mark.long) for c in cases]
