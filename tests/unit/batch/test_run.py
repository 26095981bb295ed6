"""A batch takes over what would come again, and nothing else; what it keeps is there after each part."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from trunnion.batch import run
from trunnion.batch.run import Batch, run_batch
from trunnion.findings import BadInput
from trunnion.model.part_result import PartResult
from trunnion.store.ledger import PAGE_FILE, read_ledger


class _Workers:
    """Workers that give every part the verdict that its text is."""

    def __init__(self):
        self.requests, self.stop_after = [], None

    def results(self, requests, report):
        for request in requests:
            if self.stop_after is not None and len(self.requests) >= self.stop_after:
                raise KeyboardInterrupt
            self.requests.append(request)
            verdict = Path(request.part).read_text()
            files = ("x.report.html",) if verdict == "passed" else ()
            for file in files:
                request.files_folder.mkdir(exist_ok=True)
                (request.files_folder / file).touch()
            yield PartResult(
                part=request.part,
                folder=request.folder,
                verdict=verdict,
                files=files,
                memory_limit=request.memory or 800.0,
                time_limit=request.seconds,
            )


@pytest.fixture
def workers(monkeypatch, tmp_path):
    made = _Workers()

    @contextmanager
    def local(jobs):
        yield made

    monkeypatch.setattr(run, "local", local)
    monkeypatch.chdir(tmp_path)
    return made


def parts(tmp_path, **verdicts):
    for name, verdict in verdicts.items():
        (tmp_path / f"{name}.step").write_text(verdict)
    files = tuple(f"{name}.step" for name in verdicts)
    return Batch(files=files, output=tmp_path / "out", settings={})


def done(batch):
    """Run a batch and return, by part, its verdict and whether that was taken over, in the order they came."""
    came = []
    run_batch(batch, lambda r, taken: came.append((r.part[0], r.verdict, taken)), lambda _: None)
    return came


ENDS = {
    "a": "passed",
    "b": "failed",
    "c": "refused",
    "d": "crashed",
    "e": "out of memory",
    "f": "over time",
}


def test_results_come_in_the_parts_order_and_are_kept(workers, tmp_path):
    batch = parts(tmp_path, b="failed", a="passed")
    assert done(batch) == [("b", "failed", False), ("a", "passed", False)]
    assert [e.file for e in read_ledger(batch.output)] == ["../a.step", "../b.step"]
    assert "1 of 2 parts released" in (batch.output / PAGE_FILE).read_text()


@pytest.mark.parametrize(
    ("limits", "anew"),
    [
        ({"memory": 500.0, "seconds": 60.0}, "d"),
        ({"memory": 501.0, "seconds": 60.0}, "de"),
        ({"memory": 500.0, "seconds": 61.0}, "df"),
        ({}, "def"),
        ({"memory": 500.0, "seconds": 60.0, "again": True}, "abcdef"),
        ({"memory": 500.0, "seconds": 60.0, "settings": {"blank.top": 3.0}}, "abcdef"),
    ],
)
def test_what_would_not_come_again_is_programmed_anew(workers, tmp_path, limits, anew):
    batch = parts(tmp_path, **ENDS)
    done(replace(batch, memory=500.0, seconds=60.0))
    came = done(replace(batch, **limits))
    assert {part for part, _, taken in came if not taken} == set(anew)
    assert {part for part, _, _ in came} == set(ENDS)


def test_a_part_whose_files_are_gone_or_whose_text_changed_is_programmed_anew(workers, tmp_path):
    batch = parts(tmp_path, a="passed", b="passed", c="passed")
    done(batch)
    (batch.output / "a" / "x.report.html").unlink()
    (tmp_path / "b.step").write_text("failed")
    assert done(batch) == [
        ("c", "passed", True),
        ("a", "passed", False),
        ("b", "failed", False),
    ]


def test_a_part_is_known_by_its_file_however_it_is_named(workers, tmp_path):
    batch = parts(tmp_path, a="passed")
    done(batch)
    again = replace(batch, files=(str(tmp_path / "a.step"),), output=tmp_path / "x" / ".." / "out")
    (tmp_path / "x").mkdir()
    came = []
    run_batch(again, lambda r, taken: came.append((r.part, taken)), lambda _: None)
    assert came == [(str(tmp_path / "a.step"), True)]


def test_what_was_done_before_an_interrupt_is_kept(workers, tmp_path):
    batch = parts(tmp_path, a="passed", b="failed", c="refused")
    workers.stop_after = 2
    with pytest.raises(KeyboardInterrupt):
        done(batch)
    assert len(read_ledger(batch.output)) == 2
    assert "2 of 3 done" in (batch.output / PAGE_FILE).read_text()
    workers.stop_after = None
    assert [taken for _, _, taken in done(batch)] == [True, True, False]


def test_programs_of_an_earlier_run_go_where_there_is_no_verdict_now(workers, tmp_path):
    batch = parts(tmp_path, a="crashed")
    folder = batch.output / "a"
    folder.mkdir(parents=True)
    for name in ("a.S1.nc", "a.cl", "b.S1.nc", "a.report.html"):
        (folder / name).touch()
    done(batch)
    assert {f.name for f in folder.iterdir()} == {"b.S1.nc", "a.report.html"}


def test_settings_go_to_the_parts_by_full_key_and_checked(workers, tmp_path):
    batch = parts(tmp_path, a="passed")
    done(replace(batch, settings={"plane.rough.slot_feed": "0.4"}))
    assert workers.requests[0].settings == {"plane.rough.slot_feed": 0.4}


def test_a_fixture_that_is_not_there_is_refused_before_anything_is_programmed(workers, tmp_path):
    batch = parts(tmp_path, a="passed")
    with pytest.raises(BadInput, match="no such file of a fixture"):
        done(replace(batch, fixtures=("S1=none.stl",)))
    assert not batch.output.exists()
