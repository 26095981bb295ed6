"""How much a file may take to be read before it is refused."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadLimits:
    """Limits of reading one part file.

    `seconds` of wall clock and `memory` (MB of address space, the CAD library's own 1.5 GB among it) of the reading process; `size`
    (MB) of the file, unpacked when it is gzipped.
    """

    seconds: float = 120.0
    memory: int = 6000
    size: int = 500
