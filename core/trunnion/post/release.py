"""The one door through which programs leave: what its proof failed leaves as REJECTED, and nothing else can look released.

The motions that leave are, byte for byte, those that were proven: only the stamp, the first lines of each text, is written anew.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from trunnion import registry
from trunnion.findings import BadCall, Refused, Severity
from trunnion.model.session import PostedFile, Session
from trunnion.post.header import REJECTED, STAMP_LINES, Header, plan_digest, units_of

_RELEASED_LINE = re.compile(r"(\d+ )?\W*(PPRINT/)?RELEASED\W*")


def release(session: Session, *, name: str = "", date: str = "") -> tuple[PostedFile, ...]:
    """Return a proven session's texts as they may leave: stamped with the verdict, `S1.nc` or `S1.REJECTED.nc`; CL stays `cl`, stamped.

    `name` is the NAME of the files (default: the part's), `date` the caller's. Raises `BadCall` before a proof, `Refused` when the texts
    are not those of the session's plan, or when nothing is cut: with the first error that says why.
    """
    if session.verdict is None:
        raise BadCall("nothing is proven yet: verify first")
    if not session.posted:
        errors = [f for f in session.findings() if f.severity is Severity.ERROR]
        why = (
            f"{errors[0].text}; {errors[0].remedy}"
            if errors
            else "every operation is suppressed; use one of them, or add one"
        )
        part = Path(session.part.path).name if session.part else "this session"
        raise Refused(f"{part}: nothing is cut: {why}")
    header = replace(Header.of(session, name=name, date=date), verdict=session.verdict)
    plan = plan_digest(session)
    return tuple(_stamped(posted, header, plan) for posted in session.posted)


def _stamped(posted: PostedFile, header: Header, plan: str) -> PostedFile:
    dialect = registry.get("dialects", posted.dialect)()
    lines = posted.text.split("\n")
    if not any(f"PLAN {plan}" in line for line in lines[STAMP_LINES : STAMP_LINES + 2]):
        raise Refused(
            f"{posted.suffix}: not the text of this session's plan; it leaves only after post and proof of the plan as it is now"
        )
    header = replace(header, units=units_of(lines))
    stamp = dialect.stamp(f"{header.name}.{posted.setup}" if posted.setup else header.name, header)
    before = f"{posted.setup}.{REJECTED}." if header.rejected else f"{posted.setup}."
    suffix = before + dialect.suffix if posted.setup else dialect.suffix
    return replace(posted, suffix=suffix, text="\n".join([*stamp, *lines[STAMP_LINES:]]))


def is_released(text: str) -> bool:
    """Return whether a text's stamp releases it."""
    lines = text.split("\n")
    return len(lines) > STAMP_LINES and _RELEASED_LINE.fullmatch(lines[1]) is not None


def checked_files(posted: Iterable[PostedFile]) -> tuple[PostedFile, ...]:
    """Return the files when name and stamp of each agree, and all are released or none; raise `Refused` otherwise."""
    files = tuple(posted)
    for file in files:
        if file.setup and is_released(file.text) == (REJECTED in file.suffix):
            raise Refused(f"{file.suffix}: its name and its stamp differ on whether it may run")
    if len({is_released(file.text) for file in files}) > 1:
        raise Refused(
            "some programs are released and some rejected: a plan leaves whole or not at all"
        )
    return files


def is_program_of(name: str, file_name: str) -> bool:
    """Return whether a file in an output folder is a program of NAME, released or rejected, from whatever run.

    >>> is_program_of("B1", "B1.S2.REJECTED.nc"), is_program_of("B1", "B1.cl"), is_program_of("B1", "B12.S1.nc")
    (True, True, False)
    """
    suffixes = "|".join(
        sorted(
            {re.escape(registry.get("dialects", d)().suffix) for d in registry.names("dialects")}
        )
    )
    return (
        re.fullmatch(
            rf"{re.escape(name)}\.((S[0-9A-Za-z_-]+)(\.{REJECTED})?\.)?({suffixes})", file_name
        )
        is not None
    )
