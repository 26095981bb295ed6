"""Pictures drawn by a process of their own: it loads what it draws with while the part is planned, draws the plan while it is proven, and
the proof while files are written.

Started afresh (never forked) as `python -m trunnion.report.picture_process`, it lets others begin before it loads anything. Requests and
answers are pickles on its standard input and output, one after another; a crash of a graphics driver ends this process only, and the
pictures are drawn by the caller.
"""

from __future__ import annotations

import io
import os
import pickle
import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import suppress
from operator import is_
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

from trunnion.findings import TrunnionError
from trunnion.geometry.mesh import Mesh
from trunnion.memory import trim_memory
from trunnion.model.session import Session
from trunnion.progress import LOOK_S, NO_PROGRESS, Progress
from trunnion.report.palette import Palette, load_palette

if TYPE_CHECKING:
    from trunnion.report.pictures import DrawnPicture, Picture

Drawn = Callable[[Progress], tuple["Picture", ...]]
"""Waits for pictures and returns them."""
Drawing = Callable[[Session, Mesh, Path, str], Drawn]
"""Begins the pictures `NAME.*.png` of a session, its mesh given, in a folder."""
Ahead = Callable[[Session, Mesh], None]
"""Asks for the pictures of a session's plan, its mesh given, while the plan is proven."""
HEAD_START_S = 4.0
"""How long the process waits before it loads what it draws with: about as long as both cores read a part and load the CAD kernel."""


def here(session: Session, mesh: Mesh, folder: Path, name: str) -> Drawn:
    """Return what draws the pictures in this process once they are waited for."""

    def drawn(progress: Progress = NO_PROGRESS) -> tuple[Picture, ...]:
        from trunnion.report.pictures import write_pictures

        return write_pictures(session, mesh, folder, name, load_palette(), progress)

    return drawn


class PictureProcess:
    """A process that draws, from its start to the end of a `with` block."""

    def __enter__(self) -> PictureProcess:
        # -P: nothing is imported from the folder that the program happens to be started in.
        self._child = subprocess.Popen(
            [sys.executable, "-P", "-m", "trunnion.report.picture_process"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        self._pool = ThreadPoolExecutor(1, "trunnion-pictures")
        self._planned: tuple[object, ...] | None = None
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        reason: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.end()

    def end(self) -> None:
        """End the process, at whatever it is."""
        self._child.kill()
        self._pool.shutdown()
        # What was written to it and not read is lost with it.
        with suppress(BrokenPipeError):
            self._child.communicate()

    def ahead(self, session: Session, mesh: Mesh) -> None:
        """Ask for the pictures of a session's plan, to be kept for the session that is proven with this plan."""
        self._planned = _plan_of(session)
        self._pool.submit(self._response_to, (session, mesh))

    def begin(self, session: Session, mesh: Mesh, folder: Path, name: str) -> Drawn:
        """Ask for the pictures `NAME.*.png` of a session in a folder; what is returned waits for them."""
        same = self._planned is not None and all(map(is_, self._planned, _plan_of(session)))
        future = self._pool.submit(self._response_to, (session, mesh, folder, name, same))

        def drawn(progress: Progress = NO_PROGRESS) -> tuple[Picture, ...]:
            progress.at(0.0, "drawing pictures")
            while not wait([future], timeout=LOOK_S).done:
                progress.check()
            return future.result() or here(session, mesh, folder, name)(progress)

        return drawn

    def _response_to(self, request: tuple[object, ...]) -> tuple[Picture, ...]:
        """Return what the process answers, nothing where it ended before."""
        assert self._child.stdin is not None and self._child.stdout is not None
        try:
            pickle.dump(request, self._child.stdin, protocol=pickle.HIGHEST_PROTOCOL)
            self._child.stdin.flush()
            made: tuple[Picture, ...] = pickle.load(self._child.stdout)
        except (BrokenPipeError, EOFError):
            return ()
        return made


def _plan_of(session: Session) -> tuple[object, ...]:
    """Return what the pictures of a plan are drawn from, beside the part's mesh."""
    return session.part, session.recognition, session.setups, session.process, session.paths


def _wait_for_request() -> None:
    """Return when there is a request, at the latest when others have had their head start.

    Not by a lower priority: where all cores stay busy, pictures that somebody waits for would take minutes.
    """
    requests = sys.stdin.buffer
    assert isinstance(requests, io.BufferedReader)
    request = threading.Thread(target=requests.peek, daemon=True)
    request.start()
    request.join(HEAD_START_S)


def main() -> None:
    """Draw what is asked for until nobody asks any more; what can't be drawn is answered with nothing."""
    _wait_for_request()
    # Answers alone go to the pipe: what libraries print would spoil them.
    replies = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    from trunnion.report.pictures import warm_graphics

    warm_graphics()
    artist = _Artist(load_palette())
    # Nothing of a request is kept while the next one is waited for: sessions are large.
    with suppress(EOFError):
        while True:
            made = artist.drawn(*pickle.load(sys.stdin.buffer))
            trim_memory()
            pickle.dump(made, replies, protocol=pickle.HIGHEST_PROTOCOL)
            replies.flush()


class _Artist:
    """Draws what requests ask for; the pictures of a plan are kept until they are asked for with their proof."""

    def __init__(self, palette: Palette) -> None:
        self._palette = palette
        self._plan: tuple[DrawnPicture, ...] | None = None

    def drawn(self, session: Session, mesh: Mesh, *file: Any) -> tuple[Picture, ...]:
        """Return the pictures of a proven session in a file (folder, name, whether the plan is the kept one), or keep those of its plan."""
        from trunnion.report.pictures import draw_plan, write_pictures

        # The caller draws again what fails here, and says why it can't.
        with suppress(TrunnionError, OSError):
            if file:
                folder, name, same = file
                kept = self._plan if same else None
                return write_pictures(session, mesh, folder, name, self._palette, plan=kept)
            self._plan = None
            self._plan = draw_plan(session, mesh, self._palette)
        return ()


if __name__ == "__main__":
    main()
