"""What the installers know of the project, read from its own files: names, versions, commands, Debian packages."""

from __future__ import annotations

import hashlib
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any, NoReturn

ROOT = Path(__file__).resolve().parent.parent
LOCK = ROOT / "requirements.lock"
NAME = "trunnion"
GROUPS = ("core", "drawing", "window")
"""Groups of Debian packages in `debian.sh`."""
ONLY_FOR_SETUP = "python3-venv"
"""The package of `debian.sh` that sets up a checkout and that nothing installed needs."""


def stop(text: str) -> NoReturn:
    """End the build with one line and the exit code of bad input."""
    print(f"installer: {text}", file=sys.stderr)
    raise SystemExit(2)


def project() -> dict[str, Any]:
    """Return the table [project] of pyproject.toml."""
    with (ROOT / "pyproject.toml").open("rb") as file:
        table: dict[str, Any] = tomllib.load(file)["project"]
    return table


def commands() -> dict[str, str]:
    """Return the project's commands, each with its function as "module:function"."""
    table = project()
    return {**table["scripts"], **table["gui-scripts"]}


def locked() -> dict[str, str]:
    """Return the versions of requirements.lock by normalised name."""
    lines = LOCK.read_text(encoding="utf-8").splitlines()
    pairs = (line.split("==") for line in lines if line and not line.startswith("#"))
    return {normalised(name): version for name, version in pairs}


def normalised(name: str) -> str:
    """Return a distribution's name as the index compares it (PEP 503)."""
    return re.sub(r"[-_.]+", "-", name).lower()


def debian_packages(group: str) -> list[str]:
    """Return the Debian packages of a group of `debian.sh`."""
    words = ["sh", str(ROOT / "installer" / "debian.sh"), "--names", group]
    said = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    return [name for name in said.split() if name != ONLY_FOR_SETUP]


def build_name(wheel: Path) -> str:
    """Return a name of what the wheel holds, its version and the beginning of its digest.

    Compiled loops are kept under it: numba looks at the source of a loop alone, not at that of the loops which it calls.
    """
    digest = hashlib.sha256(wheel.read_bytes()).hexdigest()
    return f"{project()['version']}-{digest[:12]}"


def given_wheel(word: str) -> Path:
    """Return the wheel that a build was called with; stops where it is not one of this project and version."""
    wheel = Path(word)
    if not wheel.is_file():
        stop(f"{wheel} is not there: make it by `make wheel`")
    if not wheel.name.startswith(f"{NAME}-{project()['version']}-"):
        stop(f"{wheel} is no wheel of {NAME} {project()['version']}: make it by `make wheel`")
    return wheel.resolve()


def source_date() -> int:
    """Return the time that made files carry, in s since 1970: SOURCE_DATE_EPOCH, else that of the last commit."""
    given = os.environ.get("SOURCE_DATE_EPOCH", "")
    if given.isdigit():
        return int(given)
    if given:
        stop(f"SOURCE_DATE_EPOCH is {given!r}: it must be a number of seconds since 1970")
    words = ["git", "log", "-1", "--format=%ct"]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        stop("no time for the files: set SOURCE_DATE_EPOCH, or build in a checkout of git")
    return int(done.stdout)
