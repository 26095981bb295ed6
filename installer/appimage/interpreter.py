"""A Python that runs wherever its folder lies: the interpreter of this machine with its standard library and what both need."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Iterable, Iterator
from pathlib import Path

from installer.environment import output, remove
from installer.project import stop

FROM_HOST = re.compile(
    r"(ld-linux.*|linux-vdso|lib(c|m|dl|rt|pthread|resolv|util|crypt|stdc\+\+|gcc_s|z|expat|uuid"
    r"|GL|EGL|GLX|GLdispatch|OpenGL|X11|X11-xcb|xcb|Xau|Xdmcp|bsd|md|fontconfig|freetype|dbus-1|glib-2\.0))\.so.*"
)
"""Libraries that are the host's: the C library's, and those that belong to its screen and its fonts or that these need themselves,
where two versions in one process would not go together. Every Linux desktop has them (the AppImage project's list of excluded libraries
says the same of these)."""
FOLDERS_LEFT_OUT = (
    "__pycache__",
    "test",
    "tests",
    "idlelib",
    "tkinter",
    "turtledemo",
    "lib2to3",
    "ensurepip",
    "site-packages",
    "dist-packages",
)
FILES_LEFT_OUT = re.compile(
    r"(config-.*|EXTERNALLY-MANAGED|sitecustomize\.py"
    r"|(nis|readline|_curses.*|_dbm|_gdbm|_tkinter|_test.*|_xxtest.*|xxlimited.*|_ctypes_test)\..*\.so)"
)
"""Parts of the standard library that the program has no use for: tests, tools, and modules that need many libraries of their own."""
WHERE = """
import sys, sysconfig
print(sys.executable, sysconfig.get_path("stdlib"), "python%d.%d" % sys.version_info[:2])
"""
PATHS = "import sys; print('\\n'.join(sys.path))"


def copy_interpreter(source: str, home: Path) -> Path:
    """Copy an interpreter and its standard library below `home`, as bin and lib, and return the copy.

    Stops where the copy looks for modules outside of `home`.
    """
    executable, library, name = output([source, "-I", "-c", WHERE]).split()
    python = home / "bin" / name
    python.parent.mkdir(parents=True)
    shutil.copy(Path(executable).resolve(), python)
    (python.parent / "python3").symlink_to(name)
    modules = home / "lib" / name
    shutil.copytree(library, modules, ignore=shutil.ignore_patterns(*FOLDERS_LEFT_OUT))
    remove(modules, lambda p: FILES_LEFT_OUT.fullmatch(p.name) is not None)
    binaries = [python, *modules.rglob("*.so")]
    copy_libraries((lib for binary in binaries for lib in libraries(binary)), home / "lib")
    # RPATH, not RUNPATH: it counts for what the interpreter loads by name too, and no variable that other programs would inherit is needed.
    output(["patchelf", "--force-rpath", "--set-rpath", "$ORIGIN/../lib", python])
    for binary in modules.rglob("*.so"):
        output(["patchelf", "--set-rpath", "$ORIGIN/../..", binary])
    searched = output([python, "-P", "-c", PATHS]).split()
    strange = [path for path in searched if not Path(path).is_relative_to(home)]
    if strange:
        stop(f"the copy of {source} looks for modules in {strange[0]}, outside of its folder")
    return python


def libraries(binary: Path) -> Iterator[Path]:
    """Yield the shared libraries that a binary loads, and those that they load, but those of the host."""
    for name, path in re.findall(
        r"(?m)^\s*(\S+) => (\S.*?)(?: \(0x\w+\))?$", output(["ldd", binary])
    ):
        if FROM_HOST.fullmatch(name):
            continue
        if path == "not found":
            stop(f"{binary} needs {name}, which this machine does not have")
        yield Path(path)


def copy_libraries(found: Iterable[Path], folder: Path) -> list[Path]:
    """Copy shared libraries into a folder in which they find each other, and return the copies."""
    copies = []
    for path in sorted(set(found)):
        copy = folder / path.name
        if not copy.exists():
            shutil.copy(path.resolve(), copy)
            output(["patchelf", "--set-rpath", "$ORIGIN", copy])
        copies.append(copy)
    return copies


def library_path(name: str) -> Path:
    """Return where the loader of this machine finds a shared library."""
    listed = subprocess.run(["/sbin/ldconfig", "-p"], capture_output=True, text=True, check=True)
    found = re.search(rf"(?m)^\s*{re.escape(name)} .*x86-64.* => (\S+)$", listed.stdout)
    if found is None:
        stop(f"{name} is not on this machine: install the packages that installer/debian.sh names")
    return Path(found[1])
