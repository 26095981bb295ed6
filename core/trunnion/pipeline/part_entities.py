"""The entities of an IGES file: how many of each type, and which one each face of the part comes from."""

from __future__ import annotations

import gzip
import tomllib
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

from trunnion.model.session import Session
from trunnion.part.read.iges_text import IgesEntity, iges_entities
from trunnion.part.read.text import kind_of
from trunnion_resources import folder

if TYPE_CHECKING:
    from trunnion.pipeline.engine import Engine

GZIP = b"\x1f\x8b"
"""How gzipped bytes begin."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FileEntities:
    """The entities of a file by their lines in its directory, and the line of each face's by its tag."""

    entities: Mapping[int, IgesEntity]
    faces: Mapping[int, int]

    def counts(self) -> dict[int, int]:
        """Return how many entities there are of each type, by type number."""
        return dict(sorted(Counter(e.type for e in self.entities.values()).items()))

    def as_dict(self) -> dict[str, Any]:
        """Return the entities as the JSON that other programs rely on: number and name of each type, and each face's with its parts."""
        return {
            "types": [
                {"number": n, "name": type_name(n), "count": count}
                for n, count in self.counts().items()
            ],
            "faces": [
                {"face": tag, "entity": self._tree(line, set())} for tag, line in self.faces.items()
            ],
        }

    def words(self, line: int) -> str:
        """Return an entity and what it is made of as words: `144 D1 (128 D3, 142 D5 (102 D7 (110 D9)))`."""
        return _words(self._tree(line, set()))

    def _tree(self, line: int, met: set[int]) -> dict[str, Any]:
        """Return an entity with its parts; what was met before is named without them, so that no file goes on for ever."""
        own = self.entities[line]
        parts = () if line in met else own.parts
        met.add(line)
        return {
            "number": own.type,
            "name": type_name(own.type),
            "line": line,
            "parts": [self._tree(part, met) for part in parts if part in self.entities],
        }


def _words(tree: dict[str, Any]) -> str:
    inside = ", ".join(map(_words, tree["parts"]))
    return f"{tree['number']} D{tree['line']}" + (f" ({inside})" if inside else "")


def file_entities(engine: Engine, session: Session) -> FileEntities | None:
    """Return the entities of the part's file, None where it is no IGES file."""
    data, suffix = engine.keep()
    plain = gzip.decompress(data) if data.startswith(GZIP) else data
    if kind_of(plain, suffix) != "iges":
        return None
    found = iges_entities(plain)
    part = engine.context_of(session).part
    faces = {tag: line for tag in part.tags if (line := part.entities.get(tag, 0)) in found}
    return FileEntities(entities=found, faces=faces)


def type_name(number: int) -> str:
    """Return the name of a type of entities; one that the specification doesn't have is called unknown."""
    return _names().get(str(number), "unknown")


@cache
def _names() -> dict[str, str]:
    return tomllib.loads((folder("formats") / "iges-entities.toml").read_text(encoding="utf-8"))
