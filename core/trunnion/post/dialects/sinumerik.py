"""Sinumerik 840D: words with `=`, cycles as calls, five axes by vectors under TRAORI and by tilted planes under CYCLE800.

All it writes is in its words, `dialects/sinumerik.toml`; what only its control does is in `readers/sinumerik/`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from trunnion.post.iso import IsoDialect

if TYPE_CHECKING:
    from trunnion.post.readers.word_address.interpreter import Control


class SinumerikDialect(IsoDialect):
    """Writes one setup as a Sinumerik program and reads it back."""

    name = "sinumerik"

    def control(self) -> type[Control]:
        """Return Sinumerik's own control."""
        from trunnion.post.readers.sinumerik.interpreter import SinumerikControl

        return SinumerikControl
