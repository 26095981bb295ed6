"""The opened part that a script works on: an engine, the session as it is now, and what was done so far."""

from __future__ import annotations

from trunnion.findings import Finding
from trunnion.model.session import Session
from trunnion.pipeline import Engine
from trunnion.progress import Progress
from trunnion.script.recording import Recording


class ProgramState:
    """What all parts of `PartProgram` share.

    `session` is the immutable data of the work so far (`trunnion.model.session`), `engine` what computes it.
    """

    def __init__(
        self, engine: Engine, session: Session, recording: Recording, progress: Progress
    ) -> None:
        self.engine, self.session = engine, session
        self.recording, self.progress = recording, progress

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What a person should know of the part and of every step that is done."""
        return self.session.findings()

    def run(self, step: str) -> Session:
        """Compute what is stale up to and including a step (`trunnion.pipeline.STEPS`) and return the session after it."""
        self.session = self.engine.run(self.session, step, self.progress)
        return self.session
