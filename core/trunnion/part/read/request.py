"""The request to a reading process: the file it reads."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadRequest:
    """The request to a reading process: the file's name and path, digest, kind ("step" or "iges"), the faces its text lists."""

    file: str
    path: str
    name: str
    digest: str
    kind: str
    listed: int
    solid: int | None
    size: int
