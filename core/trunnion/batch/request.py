"""What the process of one part is given, and what of it decides whether an earlier result still holds."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.registry import KINDS, names
from trunnion.settings import Value, digest
from trunnion.version import __version__

if TYPE_CHECKING:
    from trunnion.pipeline import Engine


@dataclass(frozen=True, slots=True, kw_only=True)
class PartRequest:
    """One part to be programmed: its file `part` as it was named, from the folder `start` that the batch was started in, with fixtures
    (`[SETUP=]FILE`) and a shop's `user_folder` (empty: the user's own) named likewise.

    Its files go to `folder` below the batch's `output`, which is absolute. `settings` by full key. `memory` MB and `seconds` are its
    limits; 0: the memory is the share of who programs it, the time is not limited.
    """

    part: str
    start: str
    output: str
    folder: str
    settings: Mapping[str, Value]
    solid: int | None = None
    fixtures: tuple[str, ...] = ()
    user_folder: str = ""
    memory: float = 0.0
    seconds: float = 0.0

    @property
    def files_folder(self) -> Path:
        """Where the part's files go."""
        return Path(self.output) / self.folder

    def with_memory(self, megabytes: float) -> PartRequest:
        """Return the request with a limit of memory, MB."""
        return replace(self, memory=megabytes)

    def to_json(self) -> str:
        """Return the request as text; `of_json` reads it."""
        return json.dumps(asdict(self))

    @classmethod
    def of_json(cls, text: str) -> PartRequest:
        """Return the request that `to_json` wrote."""
        data = json.loads(text)
        return cls(**{**data, "fixtures": tuple(data["fixtures"])})


def common_digest(
    engine: Engine,
    settings: Mapping[str, Value],
    solid: int | None,
    fixtures: Sequence[str],
) -> str:
    """Return the digest of what all parts of a batch are programmed with: version, packages, catalogues, taught plans, settings and the
    contents of files that these name."""
    from trunnion.pipeline.engine import setup_file

    files = {d.key for d in engine.declared() if d.files}
    named = {key: file_digest(str(v)) for key, v in settings.items() if key in files and v}
    clamps = [(setup_file(word)[0], file_digest(setup_file(word)[1])) for word in fixtures]
    return digest(
        __version__,
        [[kind, *names(kind)] for kind in KINDS],
        engine.catalogue_digest,
        dict(settings),
        named,
        solid or 0,
        clamps,
    )


def file_digest(file: str | Path) -> str:
    """Return the digest of a file's bytes, empty where it can't be read: it is refused then by who needs it."""
    try:
        with Path(file).open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError:
        return ""
