"""Makes the Debian package from the wheel: `python -m installer.deb WHEEL`.

The program lies in /opt/trunnion, a virtual environment of the Debian release's own interpreter with the libraries of
requirements.lock; commands, menu entry, file type and manual page lie where Debian has them. Two builds of one wheel with the same
libraries differ in nothing but what the compiler of modules leaves open.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import subprocess
import sys
from pathlib import Path

from installer import environment, files
from installer.deb import control
from installer.project import NAME, ROOT, build_name, given_wheel, project, source_date, stop

MAINTAINER = "The Trunnion founders <trunnion@localhost>"


def main(arguments: list[str] | None = None) -> int:
    """Make the package and return the exit code."""
    options = _options(arguments)
    wheel, seconds = given_wheel(options.wheel), source_date()
    root = files.empty_folder(ROOT / "build" / "deb")
    python = add_program(root, wheel, options.python)
    add_system_files(root, python, seconds, options.maintainer)
    architecture = environment.output(["dpkg", "--print-architecture"]).strip()
    version = control.debian_version(project()["version"])
    package = Path(options.output).resolve() / f"{NAME}_{version}_{architecture}.deb"
    add_control(root, python, architecture, options.maintainer)
    files.with_one_time(root, seconds)
    pack(root, package, seconds)
    print(package)
    return 0


def _options(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m installer.deb", description=__doc__)
    parser.add_argument("wheel", metavar="WHEEL", help="the wheel, as `make wheel` makes it")
    parser.add_argument("-o", "--output", default="dist", metavar="DIR", help="where it goes")
    parser.add_argument(
        "--python", default="/usr/bin/python3", help="the interpreter of the Debian release"
    )
    parser.add_argument("--maintainer", default=MAINTAINER, help="name <address> of who packs it")
    return parser.parse_args(arguments)


def add_program(root: Path, wheel: Path, interpreter: str) -> Path:
    """Make the environment of the program below the package's root, and return its interpreter."""
    interpreter = environment.output(
        [interpreter, "-c", "import sys; print('/usr/bin/python%d.%d' % sys.version_info[:2])"]
    ).strip()
    home = root / control.HOME.lstrip("/")
    environment.output([interpreter, "-m", "venv", "--without-pip", home])
    python = home / "bin" / "python"
    packages = environment.install(python, wheel)
    environment.remove(home, lambda p: p.name == "__pycache__")
    environment.remove(home / "bin", lambda p: not p.name.startswith("python"))
    (home / "bin" / "python").unlink()
    (home / "bin" / "python").symlink_to(interpreter)
    version = Path(interpreter).name.removeprefix("python")
    # `venv` writes the path that it was made at, and the patch level, which Debian may change.
    files.write(
        home / "pyvenv.cfg",
        f"home = /usr/bin\ninclude-system-site-packages = false\nversion = {version}\n",
    )
    environment.write_commands(home / "bin", f"{control.HOME}/bin/python")
    environment.compile_modules(python, packages, root)
    values = {"BUILD": build_name(wheel)}
    files.write(home / "lib" / "loops.sh", files.filled(files.HERE / "loops.sh.in", values))
    return python


def add_system_files(root: Path, python: Path, seconds: int, maintainer: str) -> None:
    """Put commands, menu entry, file type, manual page and licence where Debian has them."""
    for name, text in control.command_scripts().items():
        files.write(root / "usr" / "bin" / name, text, files.PROGRAM)
    share = root / "usr" / "share"
    files.add_desktop_files(share)
    manual = share / "man" / "man1"
    page = control.manual_page(environment.listed_commands(python), seconds)
    files.write_gzip(manual / f"{NAME}.1.gz", page)
    for name in control.command_scripts():
        if name != NAME:
            (manual / f"{name}.1.gz").symlink_to(f"{NAME}.1.gz")
    documents = share / "doc" / NAME
    files.write(documents / "copyright", files.filled(control.HERE / "copyright.in", {}))
    for name in ("NOTICE", "README.md"):
        files.write(documents / name, (ROOT / name).read_text(encoding="utf-8"))
    files.write_gzip(documents / "changelog.gz", (ROOT / "CHANGELOG.md").read_text("utf-8"))
    files.write_gzip(documents / "changelog.Debian.gz", control.changelog(maintainer, seconds))


def add_control(root: Path, python: Path, architecture: str, maintainer: str) -> None:
    """Write the control file, the scripts and the digests of all other files."""
    folder = root / "DEBIAN"
    paths = sorted(p for p in root.rglob("*") if p.is_file() and not p.is_symlink())
    sums = (f"{hashlib.md5(p.read_bytes()).hexdigest()}  {p.relative_to(root)}\n" for p in paths)
    version = os.readlink(python).rpartition("python")[2]
    text = control.control(version, architecture, maintainer, files.size_kib(root))
    files.write(folder / "md5sums", "".join(sums))
    files.write(folder / "control", text)
    for name in control.SCRIPTS:
        files.write(folder / name, (control.HERE / name).read_text("utf-8"), files.PROGRAM)


def pack(root: Path, package: Path, seconds: int) -> None:
    """Pack a root into a package whose files belong to root."""
    package.parent.mkdir(parents=True, exist_ok=True)
    words = ["dpkg-deb", "--root-owner-group", "-Zzstd", "-z9", "--build", str(root), str(package)]
    dated = os.environ | {"SOURCE_DATE_EPOCH": str(seconds)}
    if subprocess.run(words, env=dated, stdout=sys.stderr, check=False).returncode:
        stop("dpkg-deb could not pack the files")


if __name__ == "__main__":
    raise SystemExit(main())
