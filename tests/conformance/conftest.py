"""Packages of one's own are registered while these suites run."""

from __future__ import annotations

import pytest

from own_packages import with_own_packages


@pytest.fixture(scope="module", autouse=True)
def packages():
    """The packages of `tests/dialects` and `tests/families` on the path."""
    with with_own_packages():
        yield
