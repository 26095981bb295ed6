"""Fanuc 30i/31i for milling: decimal points, dwells in milliseconds, five axes by vectors under G43.5 and by planes under G68.2.

All it writes is in its words, `dialects/fanuc.toml`; what only its control does is in `readers/fanuc/`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from trunnion.post.iso import IsoDialect

if TYPE_CHECKING:
    from trunnion.post.readers.word_address.interpreter import Control


class FanucDialect(IsoDialect):
    """Writes one setup as a Fanuc program and reads it back."""

    name = "fanuc"

    def control(self) -> type[Control]:
        """Return Fanuc's own control."""
        from trunnion.post.readers.fanuc.interpreter import FanucControl

        return FanucControl
