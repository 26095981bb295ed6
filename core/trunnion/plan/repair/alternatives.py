"""What is tried against a finding, the likeliest first: the fix that it asks for, then what else serves against its cause."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from trunnion.findings import Finding, Fix

ALTERNATIVES: Mapping[str, tuple[str, ...]] = {
    "verify.collision-stock": ("clear_first", "tool", "approach", "exclude", "drop"),
    "verify.collision": ("tool", "approach", "exclude", "drop"),
    "verify.fixture": ("exclude", "drop"),
    "verify.gouge": ("tolerance", "allowance", "smaller_tool", "drop"),
    "verify.rapid-in-stock": ("lift", "clear_first", "drop"),
    "verify.power": ("feed",),
    "verify.load": ("feed",),
    "verify.air": ("trim", "drop"),
    "verify.coverage": ("add_operation", "add_slim"),
    "toolpath.refused": ("smaller_tool", "drop"),
}
"""Kinds of fixes by the code of the finding. `drop` stands last: what the operation was for must be finished by others, or coverage falls
and the round is not kept."""


def fixes_for(finding: Finding) -> tuple[Fix, ...]:
    """Return the fixes that are tried against a finding, in this order; none where it asks for none."""
    fix = finding.fix
    if fix is None:
        return ()
    return tuple(replace(fix, kind=kind) for kind in ALTERNATIVES.get(finding.code, (fix.kind,)))
