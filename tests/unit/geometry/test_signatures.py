"""The lists of what kernels are called with are true and whole: what is compiled ahead is what a program needs."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from trunnion.cli.main import main
from trunnion.geometry.kernels import signatures

LISTED = [(p, s) for p in signatures.PACKAGES for s in signatures.signatures_of(p)]

UNLISTED = """
import sys
from importlib import import_module
from pathlib import Path
from trunnion.geometry.kernels.signatures import PACKAGES, listed_modules, signatures_of
from trunnion.pipeline import Engine
engine = Engine()
session = engine.run(engine.open(Path(sys.argv[1])))
assert session.verdict is not None and session.verdict.releases
listed = {(s.module, s.name): set() for p in PACKAGES for s in signatures_of(p)}
for s in (s for p in PACKAGES for s in signatures_of(p)):
    listed[s.module, s.name].add(s.types)
for (module, name), types in listed.items():
    for found in sorted(set(import_module(module).__dict__[name].signatures) - types, key=str):
        print(module, name, found)
"""


@pytest.mark.parametrize(
    ("package", "signature"), LISTED, ids=[f"{s.module}.{s.name}" for _, s in LISTED]
)
def test_a_line_names_a_kernel_and_types(package: str, signature: signatures.Signature) -> None:
    assert signature.module.startswith(package)
    assert signature.types and signature.kernel.py_func.__module__ == signature.module


def test_a_program_calls_no_listed_kernel_with_other_types(sample_part: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", UNLISTED, str(sample_part)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == ""


def test_the_command_compiles_what_is_listed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(
        signatures, "listed_modules", lambda: ["trunnion.geometry.kernels.heightfield"]
    )
    assert main(["compile"]) == 0
    count = sum(s.module.endswith(".heightfield") for _, s in LISTED)
    assert f"{count} compiled loops are ready" in capsys.readouterr().out


@pytest.mark.parametrize("line", ["zmap_cut", "heightfield.zmap_cut('a')"])
def test_a_line_that_is_no_call_with_types_is_refused(line: str) -> None:
    with pytest.raises(ValueError, match="is no"):
        assert signatures.Signature(signatures.PACKAGES[0], line).types
