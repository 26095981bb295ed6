"""A Debian package is made whole: each file is the one whose digest it names, and its program starts from where it is unpacked."""

from __future__ import annotations

import hashlib
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from installer.deb import control
from installer.project import commands
from parts import ROOT

INTERPRETER = "/usr/bin/python3"
TOOLS = ("dpkg-deb", "dpkg")

pytestmark = [pytest.mark.long, pytest.mark.timeout(1800)]


def can_build() -> bool:
    """Whether this machine has Debian's tools, and an interpreter of its own that the project's libraries are built for."""
    if not all(shutil.which(tool) for tool in TOOLS) or not Path(INTERPRETER).is_file():
        return False
    code = "import sys, venv; print(*sys.version_info[:2])"
    said = subprocess.run([INTERPRETER, "-c", code], capture_output=True, text=True, check=False)
    return said.returncode == 0 and tuple(map(int, said.stdout.split())) == sys.version_info[:2]


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory) -> Path:
    """The files of the package, with its control files in DEBIAN."""
    if not can_build():
        pytest.skip(f"no dpkg, or no {INTERPRETER} of the tests' version with venv")
    folder = tmp_path_factory.mktemp("package")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    (wheel,) = folder.glob("*.whl")
    words = ["-m", "installer.deb", str(wheel), "-o", str(folder)]
    built = subprocess.run(
        [sys.executable, *words], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert built.returncode == 0, built.stderr
    (package,) = folder.glob("*.deb")
    subprocess.run(["dpkg-deb", "-R", str(package), str(folder / "root")], check=True)
    package.unlink()
    return folder / "root"


def test_every_file_has_the_digest_that_the_package_says_and_no_other_file_is_there(unpacked):
    lines = (unpacked / "DEBIAN" / "md5sums").read_text(encoding="utf-8").splitlines()
    sums = {path: digest for digest, path in (line.split("  ", 1) for line in lines)}
    found = {
        str(p.relative_to(unpacked)): hashlib.md5(p.read_bytes()).hexdigest()
        for p in unpacked.rglob("*")
        if p.is_file() and not p.is_symlink() and "DEBIAN" not in p.relative_to(unpacked).parts
    }
    assert found == sums


def test_its_commands_start_from_where_they_are_unpacked(unpacked):
    home = unpacked / control.HOME.lstrip("/")
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    said = subprocess.run(
        [str(home / "bin" / "python"), "-P", str(home / "bin" / "trunnion"), "--version"],
        env={"PATH": "/usr/bin:/bin"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert said.stdout == f"trunnion {version}\n"
    assert {p.name for p in (unpacked / "usr" / "bin").iterdir()} >= set(commands())


def test_no_file_names_the_folder_that_it_was_built_in(unpacked):
    built = str(ROOT / "build").encode()
    named = [
        p
        for p in unpacked.rglob("*")
        if p.is_file() and not p.is_symlink() and built in p.read_bytes()
    ]
    assert named == []


def test_every_module_of_the_program_is_compiled(unpacked):
    (packages,) = unpacked.glob("opt/trunnion/lib/python3.*/site-packages")
    modules = list(packages.glob("trunnion*/**/*.py"))
    compiled = [list((p.parent / "__pycache__").glob(f"{p.stem}.*.pyc")) for p in modules]
    assert len(modules) > 500 and all(compiled)
