"""The database of taught plans (SQLite, one file of the user's folder): added, listed, removed, and the nearest ones found.

Every call opens the file anew and closes it, so that several windows and commands share it: SQLite's own locks order the writers
(https://www.sqlite.org/lockingv3.html), each change is one transaction, and a reader never makes the file.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from trunnion.findings import BadInput
from trunnion.shop.library.plan_text import plan_of_text, plan_text
from trunnion.shop.library.signature import PartSignature
from trunnion.shop.library.similarity import Similarity, similarity
from trunnion.shop.library.taught_plan import TaughtPlan
from trunnion.shop.user_folder import FOLDER, shop_folder

FILE = "plan-library.sqlite"
"""The library's file in the user's folder."""
SCHEMA = 1
"""Version of the tables (`PRAGMA user_version`): a library of a later one is refused."""
APPLICATION = 0x54524E50
"""What marks the file as a plan library (`PRAGMA application_id`): "TRNP"."""
PATIENCE = 5.0
"""Seconds that a call waits for another window to finish writing."""
CREATE = """
CREATE TABLE IF NOT EXISTS plan (
    name TEXT PRIMARY KEY NOT NULL,
    family TEXT NOT NULL,
    date TEXT NOT NULL,
    content TEXT NOT NULL
)
"""
"""The one table: `content` is the plan as JSON (`plan_text`), the other columns repeat what is asked for."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanMatch:
    """A taught plan and how similar its part is."""

    plan: TaughtPlan
    similarity: Similarity

    def as_dict(self) -> dict[str, object]:
        """Return the match as JSON has it."""
        return {
            "name": self.plan.name,
            "similarity": self.similarity.value,
            "reasons": list(self.similarity.reasons),
        }


def library_file(folder: Path | None) -> Path:
    """Return the library's file in a shop's folder, in the user's own where none is given."""
    return shop_folder(folder) / FILE


@dataclass(frozen=True, slots=True)
class PlanLibrary:
    """The taught plans of one file, which need not be there yet.

    All methods raise `BadInput` in one line for a file that is damaged, no plan library, of a newer version, or that can't be read or
    written; the file is as it was then.
    """

    path: Path

    def plans(self, family: str = "") -> tuple[TaughtPlan, ...]:
        """Return the plans by name, those of a family where one is given."""
        if not self.path.exists():
            return ()
        with self._opened(writes=False) as database:
            if not _has_table(database):
                return ()
            rows = database.execute(
                "SELECT name, content FROM plan WHERE family = ? OR ? = '' ORDER BY name",
                (family, family),
            ).fetchall()
        return tuple(plan_of_text(content, self._where(name)) for name, content in rows)

    def names(self) -> tuple[str, ...]:
        """Return the names of all plans; those whose text is damaged too."""
        if not self.path.exists():
            return ()
        with self._opened(writes=False) as database:
            if not _has_table(database):
                return ()
            return tuple(
                str(row[0]) for row in database.execute("SELECT name FROM plan ORDER BY name")
            )

    def plan(self, name: str) -> TaughtPlan:
        """Return the plan with a name; raise `BadInput` with the known names."""
        return plan_of_text(self._content(name), self._where(name))

    def add(self, plan: TaughtPlan) -> None:
        """Add a plan; raise `BadInput` where the name is empty or in use."""
        if not plan.name.strip():
            raise BadInput("a plan of the library needs a name")
        with self._opened(writes=True) as database:
            there = database.execute("SELECT 1 FROM plan WHERE name = ?", (plan.name,)).fetchone()
            if there:
                raise BadInput(
                    f"{self.path}: there is a plan {plan.name} already; choose another name, or remove it first"
                )
            database.execute(
                "INSERT INTO plan (name, family, date, content) VALUES (?, ?, ?, ?)",
                (plan.name, plan.family, plan.date, plan_text(plan)),
            )

    def remove(self, name: str) -> None:
        """Remove the plan with a name, also one whose text is damaged; raise `BadInput` with the known names."""
        known = self.names()
        if name not in known:
            raise self._unknown(name, known)
        with self._opened(writes=True) as database:
            database.execute("DELETE FROM plan WHERE name = ?", (name,))

    def matches(self, signature: PartSignature) -> tuple[PlanMatch, ...]:
        """Return the plans of a signature's family with their similarity, the most similar first, then by name."""
        found = [
            PlanMatch(plan=plan, similarity=similarity(signature, plan.signature))
            for plan in self.plans(signature.family)
        ]
        return tuple(sorted(found, key=lambda m: (-m.similarity.value, m.plan.name)))

    def _content(self, name: str) -> str:
        known = self.names()
        if name not in known:
            raise self._unknown(name, known)
        with self._opened(writes=False) as database:
            row = database.execute("SELECT content FROM plan WHERE name = ?", (name,)).fetchone()
        if row is None:
            raise self._unknown(name, tuple(n for n in known if n != name))
        return str(row[0])

    def _unknown(self, name: str, known: tuple[str, ...]) -> BadInput:
        there = f"known: {', '.join(known)}" if known else "it is empty"
        return BadInput(f"{self.path}: there is no plan {name} in the library; {there}")

    def _where(self, name: str) -> str:
        return f"{self.path}: plan {name}"

    @contextmanager
    def _opened(self, *, writes: bool) -> Iterator[sqlite3.Connection]:
        """Give the database, checked, within one transaction; what is written stays only when no error comes."""
        try:
            if writes:
                self.path.parent.mkdir(parents=True, exist_ok=True)
            mode = "rwc" if writes else "ro"
            address = f"file:{quote(str(self.path.absolute()))}?mode={mode}"
            opened = sqlite3.connect(address, uri=True, timeout=PATIENCE, isolation_level=None)
            with closing(opened) as database:
                database.execute("BEGIN IMMEDIATE" if writes else "BEGIN")
                self._check(database)
                if writes:
                    database.execute(CREATE)
                    database.execute(f"PRAGMA application_id = {APPLICATION}")
                    database.execute(f"PRAGMA user_version = {SCHEMA}")
                yield database
                database.execute("COMMIT")
        except OSError as reason:
            raise BadInput(
                f"{self.path}: the plan library can't be written ({reason.strerror}): name a folder that can be written to "
                f"(--user-folder, or {FOLDER} in the environment)"
            ) from None
        except sqlite3.OperationalError as reason:
            raise self._not_opened(reason, writes) from None
        except sqlite3.DatabaseError as reason:
            raise self._damaged(str(reason)) from None

    def _check(self, database: sqlite3.Connection) -> None:
        """Refuse a file that is no plan library, or one of a newer version."""
        application = int(database.execute("PRAGMA application_id").fetchone()[0])
        version = int(database.execute("PRAGMA user_version").fetchone()[0])
        is_new = not database.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]
        if application != APPLICATION and not is_new:
            raise BadInput(
                f"{self.path}: the file is no plan library; move it away, and a new library begins"
            )
        if version > SCHEMA:
            raise BadInput(
                f"{self.path}: the plan library was written by a newer version of the program (schema {version}, this one "
                f"reads {SCHEMA}): update the program, or move the file away to begin a new one"
            )

    def _not_opened(self, reason: sqlite3.OperationalError, writes: bool) -> BadInput:
        if reason.sqlite_errorcode in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
            return BadInput(
                f"{self.path}: another window or command is writing the plan library: try again in a moment"
            )
        if reason.sqlite_errorcode & 0xFF in _NO_ACCESS:
            what = "written" if writes else "read"
            return BadInput(
                f"{self.path}: the plan library can't be {what} ({reason}): allow it, or name another folder (--user-folder, or "
                f"{FOLDER} in the environment)"
            )
        return self._damaged(str(reason))

    def _damaged(self, reason: str) -> BadInput:
        return BadInput(
            f"{self.path}: the plan library is damaged ({reason}): put a copy of it back, or move the file away to begin a new "
            "one; nothing was changed"
        )


_NO_ACCESS = (
    sqlite3.SQLITE_CANTOPEN,
    sqlite3.SQLITE_READONLY,
    sqlite3.SQLITE_PERM,
    sqlite3.SQLITE_FULL,
    sqlite3.SQLITE_IOERR,
)
"""SQLite's primary result codes for a file or folder that can't be used, whatever is in it."""


def _has_table(database: sqlite3.Connection) -> bool:
    found = database.execute("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = 'plan'")
    return found.fetchone() is not None
