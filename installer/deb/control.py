"""The Debian package's own texts: control file, commands, manual page."""

from __future__ import annotations

import re
from collections.abc import Iterable
from datetime import UTC, datetime
from pathlib import Path

from installer.files import filled
from installer.project import GROUPS, commands, debian_packages, project

HERE = Path(__file__).resolve().parent
HOME = "/opt/trunnion"
"""Where the program lies once it is installed."""
REVISION = 1
INTERPRETER = "trunnion-python"
"""The command that starts the program's own interpreter."""
SCRIPTS = ("postinst", "prerm", "postrm")


def debian_version(version: str) -> str:
    """Return a version of PEP 440 as Debian orders it: what comes before a release (a, b, rc, .dev) begins with a tilde."""
    return re.sub(r"\.?((?:a|b|rc|dev)\d+)", r"~\1", version) + f"-{REVISION}"


def depends(python: str) -> str:
    """Return the packages that must be there: the interpreter ("3.11") that the libraries were built for, and those of `debian.sh`."""
    groups = (name for group in GROUPS for name in debian_packages(group))
    return ", ".join([f"python{python}", "libc6", "libstdc++6", *groups])


def control(python: str, architecture: str, maintainer: str, size: int) -> str:
    """Return the control file of the package; `size` in KiB once installed."""
    table = project()
    values = {
        "VERSION": debian_version(table["version"]),
        "ARCHITECTURE": architecture,
        "MAINTAINER": maintainer,
        "SIZE": str(size),
        "DEPENDS": depends(python),
        "SUMMARY": table["description"].rstrip("."),
    }
    return filled(HERE / "control.in", values)


def command_scripts() -> dict[str, str]:
    """Return the commands in /usr/bin by their names: the project's, and the interpreter's."""
    arguments = {name: f"-P {HOME}/bin/{name}" for name in commands()} | {INTERPRETER: ""}
    return {
        name: filled(HERE / "command.in", {"ARGUMENTS": words}).replace("python  ", "python ")
        for name, words in arguments.items()
    }


def manual_page(listed: Iterable[tuple[str, str]], seconds: int) -> str:
    """Return the manual page; `listed` are the command line's words with their help, `seconds` its date since 1970."""
    rows = (f".TP\n.B {_roff(name)}\n{_roff(text)}" for name, text in listed)
    values = {
        "DATE": datetime.fromtimestamp(seconds, UTC).strftime("%Y-%m-%d"),
        "VERSION": project()["version"],
        "COMMANDS": "\n".join(rows),
    }
    return filled(HERE / "trunnion.1.in", values)


def changelog(maintainer: str, seconds: int) -> str:
    """Return the package's changelog, which Debian wants beside the project's own."""
    version = debian_version(project()["version"])
    date = datetime.fromtimestamp(seconds, UTC).strftime("%a, %d %b %Y %H:%M:%S +0000")
    entry = "  * Made from the wheel of this version.\n"
    return f"trunnion ({version}) unstable; urgency=medium\n\n{entry}\n -- {maintainer}  {date}\n"


def _roff(text: str) -> str:
    """Return a text for a manual page: no backslash, hyphen or leading dot with a meaning of its own."""
    safe = text.replace("\\", "\\e").replace("-", "\\-")
    return f"\\&{safe}" if safe.startswith((".", "'")) else safe
