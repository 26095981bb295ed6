"""LinuxCNC: modal words, arcs by centre, one restart point an operation; with rotary axes in joint form, fed in inverse time.

All it writes is in its words, `dialects/linuxcnc.toml`; what only its control does is in `readers/linuxcnc.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from trunnion.post.iso import IsoDialect

if TYPE_CHECKING:
    from trunnion.post.readers.word_address.interpreter import Control


class LinuxCncDialect(IsoDialect):
    """Writes one setup as a LinuxCNC program and reads it back."""

    name = "linuxcnc"

    def control(self) -> type[Control]:
        """Return LinuxCNC's own control."""
        from trunnion.post.readers.linuxcnc import LinuxCncControl

        return LinuxCncControl
