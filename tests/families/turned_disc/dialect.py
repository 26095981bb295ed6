"""The control of the shop that mills discs: all it needs is words."""

from __future__ import annotations

from trunnion.post.iso import IsoDialect


class TurnerDialect(IsoDialect):
    """Writes one setup for the Turner 3 and reads it back."""

    name, package = "turner", "turned_disc"
