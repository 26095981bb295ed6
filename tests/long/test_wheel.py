"""The wheel has all that the program needs: installed outside of the repository, it programs the sample part."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
import venv
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest

from parts import ROOT

PACKAGES = ("core/trunnion", "gui/trunnion_gui", "resources/trunnion_resources")
DEPENDENCIES = Path(np.__file__).parents[1]
"""Where the libraries lie that the tests themselves run on: the new environment reads them there."""
POINTS = """
import importlib.metadata, json
own = importlib.metadata.distribution("trunnion")
found = {}
for point in own.entry_points:
    point.load()
    found.setdefault(point.group, []).append(point.name)
print(json.dumps(found))
"""
ORIGINS = """
import trunnion, trunnion_gui, trunnion_resources
for package in (trunnion, trunnion_gui, trunnion_resources):
    print(package.__file__)
"""

pytestmark = [pytest.mark.long, pytest.mark.timeout(1200)]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> Path:
    """The wheel, made as `make wheel` does."""
    folder = tmp_path_factory.mktemp("dist")
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)],
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    (made,) = folder.glob("*.whl")
    return made


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory) -> Path:
    """The folder of commands of a new environment that has the wheel, and reads libraries from the tests' own."""
    environment = tmp_path_factory.mktemp("installed") / "environment"
    venv.create(environment, with_pip=True)
    commands = environment / "bin"
    run(commands / "python", "-m", "pip", "install", "-q", "--no-deps", "--no-index", str(wheel))
    (packages,) = environment.glob("lib/python3.*/site-packages")
    (packages / "libraries.pth").write_text(f"{DEPENDENCIES}\n", encoding="utf-8")
    return commands


def run(*command: str | Path, cwd: Path | None = None) -> str:
    """Return what a command prints, run without the repository on the path."""
    foreign = {"PYTHONPATH", "NUMBA_CACHE_DIR", "PYTHONDONTWRITEBYTECODE"}
    environment = {k: v for k, v in os.environ.items() if k not in foreign}
    done = subprocess.run(
        [*map(str, command)], env=environment, cwd=cwd, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_the_wheel_has_every_file_of_its_three_packages_and_no_other(wheel):
    tracked = subprocess.run(
        ["git", "ls-files", *PACKAGES], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if tracked.returncode:
        pytest.skip("not a checkout of git")
    expected = {path.partition("/")[2] for path in tracked.stdout.splitlines()}
    packed = {name for name in ZipFile(wheel).namelist() if ".dist-info/" not in name}
    assert packed == expected


def test_what_is_installed_is_imported_from_where_it_was_installed(installed, tmp_path):
    origins = run(installed / "python", "-c", ORIGINS, cwd=tmp_path).split()
    assert all(Path(origin).is_relative_to(installed.parent) for origin in origins)
    assert len(origins) == len(PACKAGES)


def test_every_entry_point_of_the_project_is_installed_and_loads(installed, tmp_path):
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    groups = project["entry-points"] | {
        "console_scripts": project["scripts"],
        "gui_scripts": project["gui-scripts"],
    }
    expected = {group: sorted(points) for group, points in groups.items() if points}
    found = json.loads(run(installed / "python", "-P", "-c", POINTS, cwd=tmp_path))
    assert {group: sorted(points) for group, points in found.items()} == expected


def test_the_sample_part_is_programmed_from_the_installed_resources(installed, tmp_path):
    part = run(installed / "python", "-P", "-m", "trunnion_resources", "B1", cwd=tmp_path).strip()
    assert Path(part).is_relative_to(installed.parent)
    run(installed / "trunnion", "program", part, "-o", "out", "--name", "B1", cwd=tmp_path)
    written = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"B1.S1.nc", "B1.trunnion", "B1.report.html", "B1.process.xml"} <= written
    assert not any("REJECTED" in name for name in written)
