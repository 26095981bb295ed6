"""What every released program must be: no collision, no rapid in stock, nothing cut into the part beyond the tolerance."""

from __future__ import annotations

from trunnion import tolerance
from trunnion.findings import Severity
from trunnion.model.session import Session


def assert_released(session: Session, coverage: float = 0.0) -> None:
    """Assert that a proven session's programs are released, with at least a share of the part finished."""
    verdict = session.verdict
    assert verdict is not None
    errors = [str(f) for f in session.findings() if f.severity is Severity.ERROR]
    assert verdict.releases, errors
    assert (verdict.collisions, verdict.rapids_in_stock) == (0, 0)
    assert verdict.gouge <= tolerance.GOUGE
    assert verdict.coverage >= coverage
