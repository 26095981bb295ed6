"""Starts the frozen program: the command that its file is named after, or a module in a process of its own.

The program starts such processes as `sys.executable -P -m MODULE`; frozen, `sys.executable` is the program itself, so it must do what an
interpreter would do with these words.
"""

from __future__ import annotations

import multiprocessing
import runpy
import sys
from importlib.metadata import distribution
from pathlib import Path

OWN = ("trunnion", "trunnion_gui", "trunnion_resources")


def module_words(words: list[str]) -> list[str]:
    """Return the module and its arguments of a call as `-P -m MODULE ...`; nothing of any other call."""
    rest = words[1:] if words[:1] == ["-P"] else words
    if len(rest) > 1 and rest[0] == "-m" and rest[1].partition(".")[0] in OWN:
        return rest[1:]
    return []


def main() -> None:
    """Run what the words of this process ask for."""
    multiprocessing.freeze_support()
    words = module_words(sys.argv[1:])
    if words:
        sys.argv = words
        runpy.run_module(words[0], run_name="__main__", alter_sys=True)
        return
    name = Path(sys.executable).stem
    (point,) = (p for p in distribution("trunnion").entry_points if p.name == name)
    point.load()()


if __name__ == "__main__":
    main()
