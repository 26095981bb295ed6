"""A step of the work: what it is called, what it reads, and the plain function behind it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from trunnion.findings import Finding
from trunnion.model.session import Session
from trunnion.pipeline.context import Context
from trunnion.pipeline.planning.open_faces import used_settings
from trunnion.progress import Progress
from trunnion.settings import checked, choose, digest


@dataclass(frozen=True, slots=True, kw_only=True)
class Result:
    """What a step gives: the changed session and the findings that live and go stale with the step."""

    session: Session
    findings: tuple[Finding, ...] = ()


Work = Callable[[Session, Context, Progress], Result]
"""What a step does."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """One step: name, title, the steps whose results it reads (`after`), the settings it declares and those among them that a session
    uses (all where `uses` is None), what it reads, the work, whether its result is there, and what it then begins that later steps
    will want of the part (`foresees`)."""

    name: str
    title: str
    after: tuple[str, ...]
    settings: Callable[[], tuple[type, ...]]
    reads: Callable[[Session, Context], tuple[Any, ...]]
    work: Work
    done: Callable[[Session], bool]
    version: int = 1
    uses: Callable[[Session], tuple[type, ...]] | None = None
    foresees: tuple[Callable[[Session, Context], None], ...] = ()

    def key(self, session: Session, context: Context) -> str:
        """Return the digest of everything the step would be given now."""
        used = self.settings() if self.uses is None else self.uses(session)
        settings: tuple[Any, ...] = tuple(checked(choose(group, session.choices)) for group in used)
        opened: tuple[Any, ...] = tuple(
            checked(choose(group, session.choices)) for group in used_settings(context.part)
        )
        return digest(
            self.name, self.version, settings, self.reads(session, context), *session.cuts, *opened
        )
