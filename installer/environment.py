"""The wheel and the libraries that it needs, in the versions of requirements.lock, put into an interpreter's own folders."""

from __future__ import annotations

import csv
import io
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from importlib.metadata import PathDistribution
from pathlib import Path

from installer.files import PROGRAM, write
from installer.project import LOCK, NAME, commands, locked, normalised, project, stop

COMMAND = """#!{python} -P
from {module} import {function}

if __name__ == "__main__":
    {function}()
"""
LIST_COMMANDS = """
import json
from trunnion.cli.main import parser
actions = parser()._subparsers._group_actions[0]._choices_actions
print(json.dumps([(a.dest, a.help) for a in actions]))
"""


def install(python: Path, wheel: Path) -> Path:
    """Install the wheel with locked libraries for an interpreter, as built wheels alone; return the folder that they lie in.

    Nothing of them is started, and pip itself is not left there. Stops where something is not in the lock.
    """
    words = ["install", "--quiet", "--no-compile", "--only-binary=:all:", "--constraint", LOCK]
    pip = [sys.executable, "-m", "pip", "--python", str(python), "--disable-pip-version-check"]
    command = [
        *pip,
        *map(str, words),
        "--root-user-action=ignore",
        "--no-warn-script-location",
        str(wheel),
    ]
    done = subprocess.run(command, env=own_environment(), check=False)
    if done.returncode:
        stop(f"pip could not install {wheel.name} with the versions of {LOCK.name}")
    folder = packages_folder(python)
    _check(folder)
    _remove_traces(folder)
    return folder


def packages_folder(python: Path) -> Path:
    """Return where the packages of an interpreter lie: the folder that has the program's."""
    code = "from importlib.util import find_spec; print(find_spec('trunnion').origin)"
    folder = Path(output([python, "-P", "-c", code]).strip()).parents[1]
    if not folder.is_relative_to(python.parents[1]):
        stop(f"{python} finds the program in {folder}, not in its own folders")
    return folder


def own_environment() -> dict[str, str]:
    """Return the environment for an interpreter that must see no packages but its own, and writes no modules compiled by the way."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    # Sets of constants lie in compiled modules in the order of their hashes.
    return kept | {
        "PYTHONNOUSERSITE": "1",
        "PYTHONDONTWRITEBYTECODE": "1",
        "PYTHONHASHSEED": "0",
    }


def output(words: list[str | Path]) -> str:
    """Return what a command prints; stops where it fails."""
    done = subprocess.run(
        [str(w) for w in words],
        capture_output=True,
        text=True,
        env=own_environment(),
        check=False,
    )
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["it printed nothing"])[-1]
        stop(f"{words[0]} ended with code {done.returncode}: {last}")
    return done.stdout


def _check(folder: Path) -> None:
    """Stop where a package is not in the lock, or in another version."""
    versions = locked() | {NAME: project()["version"]}
    for info in sorted(folder.glob("*.dist-info")):
        found = PathDistribution(info)
        name = normalised(found.metadata["Name"])
        if name in versions and versions[name] != found.version:
            stop(f"{name} {found.version} was installed where the lock has {versions[name]}")
        if name not in versions:
            stop(f"{name} {found.version} was installed, but is not in {LOCK.name}")


def _remove_traces(folder: Path) -> None:
    """Remove what says where and how the packages were built: commands with the build's path, the path of the wheel."""
    for info in folder.glob("*.dist-info"):
        record = info / "RECORD"
        rows = list(csv.reader(io.StringIO(record.read_text(encoding="utf-8"))))
        kept = [row for row in rows if not _is_trace(row[0])]
        for row in rows:
            path = (folder / row[0]).resolve()
            if _is_trace(row[0]) and path.is_file():
                path.unlink()
        written = io.StringIO()
        csv.writer(written, lineterminator="\n").writerows(kept)
        record.write_text(written.getvalue(), encoding="utf-8")


def _is_trace(name: str) -> bool:
    """Whether a file of a package's RECORD is a command beside the interpreter, or names the wheel's path."""
    parts = Path(name).parts
    return (".." in parts and parts[-2] == "bin") or name.endswith(".dist-info/direct_url.json")


def write_commands(folder: Path, python: str) -> None:
    """Write the project's commands as Python files that are run by an interpreter, named by its path once installed."""
    for name, point in commands().items():
        module, _, function = point.partition(":")
        text = COMMAND.format(python=python, module=module, function=function)
        write(folder / name, text, PROGRAM)


def compile_modules(python: Path, folder: Path, root: Path) -> None:
    """Compile all modules below a folder, with the paths that they have below `root` once installed.

    The compiled files hold the digest of their source, not its time, and are not compared with it again (PEP 552). Modules that are
    templates, or for other versions of Python, don't compile; stops where one of the program's own doesn't.
    """
    words = ["-m", "compileall", "-q", "-j", "0", "--invalidation-mode", "unchecked-hash"]
    done = subprocess.run(
        [str(python), *words, "-s", str(root), "-p", "/", str(folder)],
        capture_output=True,
        text=True,
        env=own_environment(),
        check=False,
    )
    own = [p for p in folder.rglob("*.py") if p.relative_to(folder).parts[0].startswith(NAME)]
    missing = [p for p in own if not list((p.parent / "__pycache__").glob(f"{p.stem}.*.pyc"))]
    if missing:
        stop(f"{missing[0]} does not compile: {done.stdout.strip()[-300:]}")


def listed_commands(python: Path) -> list[tuple[str, str]]:
    """Return the words of the command line, each with its help, as the installed program has them."""
    found = json.loads(output([python, "-P", "-c", LIST_COMMANDS]))
    return [(name, text) for name, text in found]


def remove(folder: Path, is_unwanted: Callable[[Path], bool]) -> None:
    """Remove the files and folders below a folder that are not wanted."""
    for path in sorted(folder.rglob("*"), reverse=True):
        if not is_unwanted(path):
            continue
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)
