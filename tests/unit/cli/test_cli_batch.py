"""`trunnion batch`: parts that crash, bloat or are none take nobody with them; what is done is kept and taken over."""

from __future__ import annotations

import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from contextlib import suppress
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import psutil
import pytest

from faulty_parts import FOLDER, prism, python_path
from own_packages import forget
from trunnion.batch.request import PartRequest
from trunnion.batch.workers import _result_of, local
from trunnion.cli.main import BAD, CANCELLED, main
from trunnion.findings import BadInput
from trunnion.store.ledger import LEDGER_FILE, PAGE_FILE, read_ledger

COMMAND = "from trunnion.cli.main import run; run()"
MEMORY = ("--memory", "1500")
"""Enough for the small block, MB."""
PATIENCE_S = 60.0
"""Seconds that a process may take to do what a test waits for."""


@pytest.fixture(scope="module")
def batch(tmp_path_factory, sample_part):
    """The folder of a batch with one good part among bad ones, and what its call printed as JSON."""
    folder = tmp_path_factory.mktemp("batch")
    for name in ("one/block.step", "two/block.step"):
        (folder / name).parent.mkdir()
    shutil.copy(sample_part, folder / "one" / "block.step")
    (folder / "two" / "block.step").write_text("nonsense")
    prism("crash", folder / "one" / "crash.step")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        patch.setenv("PYTHONPATH", python_path())
        done = subprocess.run(
            [sys.executable, "-c", COMMAND, "batch", "one", "two/*.step", "-o", "out", "--json"]
            + [*MEMORY, "--jobs", "2"],
            capture_output=True,
            text=True,
            check=False,
        )
    assert done.stdout, done.stderr
    return SimpleNamespace(
        folder=folder,
        out=folder / "out",
        code=done.returncode,
        errors=done.stderr.splitlines(),
        rows={r["part"]: r for r in json.loads(done.stdout)["parts"]},
    )


def again(batch, monkeypatch, capsys, *options):
    """Return the exit code of the same call in this process for what would come again, and its lines on standard output."""
    monkeypatch.chdir(batch.folder)
    monkeypatch.setenv("PYTHONPATH", python_path())
    monkeypatch.syspath_prepend(str(FOLDER))
    forget()
    try:
        parts = ["one/block.step", "two/*.step"]
        code = main(["batch", *parts, "-o", "out", *MEMORY, *options])
    finally:
        monkeypatch.undo()
        forget()
    return code, capsys.readouterr().out


def test_each_part_has_its_own_end(batch):
    assert {part: row["verdict"] for part, row in batch.rows.items()} == {
        "one/block.step": "passed",
        "one/crash.step": "crashed",
        "two/block.step": "refused",
    }
    assert batch.code == BAD
    assert "SIGABRT" in batch.rows["one/crash.step"]["note"]
    assert len(batch.errors) == 2 and all(e.startswith("trunnion: ") for e in batch.errors)


def test_the_good_part_has_its_figures_and_all_its_files(batch):
    row = batch.rows["one/block.step"]
    assert (row["coverage"], row["gouge_mm"], row["family"]) == (1.0, 0.0, "panel")
    assert row["machining_time_s"] > 0.0 and 0 < row["memory_mb"] < 1500
    assert row["folder"] == "one-block" and not row["taken_over"]
    written = {f.name for f in (batch.out / "one-block").iterdir()}
    assert written == set(row["files"])
    assert {"block.S1.nc", "block.report.html", "block.trunnion"} <= written


def test_a_crash_keeps_the_stack_it_happened_at(batch):
    words = (batch.out / "crash" / "crash.txt").read_text()
    assert "faulty_kinds" in words and "suits" in words


def test_parts_of_one_name_have_folders_of_their_own(batch):
    folders = {row["folder"] for row in batch.rows.values()}
    assert folders == {"one-block", "two-block", "crash"}


def test_ledger_and_page_have_every_part(batch):
    assert len(read_ledger(batch.out)) == 3
    page = (batch.out / PAGE_FILE).read_text()
    assert "1 of 3 parts released" in page
    assert "one-block/block.report.html" in page and "one-block/block.features.png" in page


def test_the_same_call_takes_over_what_would_come_again(batch, monkeypatch, capsys):
    before = (batch.out / "one-block" / "block.S1.nc").stat().st_mtime_ns
    code, shown = again(batch, monkeypatch, capsys)
    head, *lines, end = shown.splitlines()
    assert code == BAD and (batch.out / "one-block" / "block.S1.nc").stat().st_mtime_ns == before
    assert [line.split()[0] for line in lines] == ["one/block.step", "two/block.step"]
    assert head.startswith("part") and all("as before" in line for line in lines)
    assert end == f"1 of 2 parts released; out/{PAGE_FILE}"
    assert len(read_ledger(batch.out)) == 3


def test_a_part_that_changed_is_programmed_again_and_leaves_no_old_program(
    batch, monkeypatch, capsys, tmp_path
):
    out = tmp_path / "out"
    shutil.copytree(batch.out, out)
    lines = (out / LEDGER_FILE).read_text().replace("../one", f"{batch.folder}/one")
    (out / LEDGER_FILE).write_text(lines.replace("../two", f"{batch.folder}/two"))
    monkeypatch.chdir(batch.folder)
    good = (batch.folder / "one" / "block.step").read_bytes()
    (batch.folder / "one" / "block.step").write_text("nonsense now")
    try:
        assert main(["batch", "one/block.step", "-o", str(out), "--quiet"]) == BAD
    finally:
        (batch.folder / "one" / "block.step").write_bytes(good)
    head, row, end = capsys.readouterr().out.splitlines()
    assert head.split()[:3] == ["part", "family", "verdict"] and "refused" in row
    assert end.startswith("0 of 1 parts released")
    assert not list((out / "one-block").glob("*.nc"))


def test_a_setting_that_is_wrong_is_refused_before_anything_is_programmed(
    batch, monkeypatch, capsys, tmp_path
):
    monkeypatch.chdir(batch.folder)
    assert main(["batch", "one", "-o", str(tmp_path / "new"), "--set", "blank.top=-1"]) == BAD
    said = capsys.readouterr()
    assert said.out == "" and len(said.err.splitlines()) == 1 and "blank.top" in said.err
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--jobs", "0"], "whole number from 1"),
        (["--memory", "much"], "whole number from 1"),
        (["--time-limit", "soon"], "must be a time such as"),
        (["--time-limit", "0"], "longer than 0 s"),
    ],
)
def test_limits_that_are_none_are_one_line_and_exit_2(options, words, capsys, tmp_path):
    with pytest.raises(SystemExit) as left:
        main(["batch", "x.step", "-o", str(tmp_path), *options])
    said = capsys.readouterr().err
    assert left.value.code == BAD and words in said and len(said.splitlines()) == 1


def test_a_scheduler_that_nobody_answers_at_is_one_line(capsys, tmp_path, monkeypatch):
    monkeypatch.setattr("trunnion.batch.workers.WAIT_S", 0.2)
    address = "tcp://127.0.0.1:1"
    assert main(["batch", "x.step", "-o", str(tmp_path), "--scheduler", address]) == BAD
    said = capsys.readouterr().err
    assert len(said.splitlines()) == 1 and "no scheduler of Dask answers there" in said
    assert main(["batch", "x", "-o", "o", "--scheduler", address, "--jobs", "2"]) == BAD


def test_no_other_computer_reaches_a_port_of_the_local_workers():
    before = set(_listening())
    with local(2):
        opened = set(_listening()) - before
        assert {address for address, _ in opened} <= {"127.0.0.1"}
    assert set(_listening()) <= before


def _listening():
    return [
        tuple(c.laddr) for c in psutil.Process().net_connections() if c.status == psutil.CONN_LISTEN
    ]


@pytest.mark.long
def test_a_part_that_bloats_is_ended_and_the_next_one_is_programmed(
    tmp_path, sample_part, monkeypatch, capsys
):
    prism("memory", tmp_path / "parts" / "a.step")
    shutil.copy(sample_part, tmp_path / "parts" / "b.step")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", python_path())
    assert main(["batch", "parts", "-o", "out", "--json", "--jobs", "1", *MEMORY]) == BAD
    rows = json.loads(capsys.readouterr().out)["parts"]
    assert [row["verdict"] for row in rows] == ["out of memory", "passed"]
    assert "1500 MB" in rows[0]["note"] and rows[0]["memory_mb"] > 1500


def test_an_interrupt_leaves_the_ledger_and_no_process(tmp_path):
    prism("sleep", tmp_path / "parts" / "sleep.step")
    (tmp_path / "parts" / "none.step").write_text("nonsense")
    command = [sys.executable, "-c", COMMAND, "batch", "parts", "-o", "out", "--jobs", "1"]
    with subprocess.Popen(
        command,
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": python_path()},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # Where the tests themselves run in the background, an interrupt is ignored, and what they start would inherit that.
        preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),
    ) as process:
        try:
            started = _started(process.pid)
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=PATIENCE_S)
        finally:
            process.kill()
    assert process.returncode == CANCELLED
    assert errors.splitlines() == [
        "trunnion: 1 of 2 parts are done; the same call goes on with the others",
        "trunnion: cancelled",
    ]
    assert [entry.file for entry in read_ledger(tmp_path / "out")] == ["../parts/none.step"]
    assert not [p for p in started if p.is_running() and p.status() != psutil.STATUS_ZOMBIE]


def _started(process):
    """Return all processes below a batch's once the part that sleeps is being read."""
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        with suppress(psutil.Error):
            found = psutil.Process(process).children(recursive=True)
            if any("trunnion.part.read.child" in word for p in found for word in p.cmdline()):
                return found
        time.sleep(0.05)
    raise AssertionError("no part was begun")


def test_another_batch_in_the_same_folder_is_refused(batch, capsys, monkeypatch):
    import fcntl

    monkeypatch.chdir(batch.folder)
    handle = os.open(batch.out, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX)
        assert main(["batch", "one", "-o", "out"]) == BAD
    finally:
        os.close(handle)
    assert "another batch is at work in this folder" in capsys.readouterr().err


def test_the_command_is_documented_by_its_help(capsys):
    with pytest.raises(SystemExit):
        main(["batch", "--help"])
    said = capsys.readouterr().out
    assert LEDGER_FILE in said and PAGE_FILE in said and Path(PAGE_FILE).suffix == ".html"


def test_the_workers_of_a_scheduler_program_parts_too(tmp_path, monkeypatch, capsys):
    from distributed import LocalCluster

    (tmp_path / "rib.step").write_text("nonsense")
    monkeypatch.chdir(tmp_path)
    with LocalCluster(
        n_workers=1,
        threads_per_worker=1,
        processes=False,
        protocol="tcp://",
        host="127.0.0.1",
        dashboard_address="127.0.0.1:0",
        scheduler_kwargs={"dashboard": False},
        local_directory=str(tmp_path / "scratch"),
    ) as cluster:
        address = cluster.scheduler_address
        assert address.startswith("tcp://127.0.0.1:")
        call = ["batch", "rib.step", "-o", "out", "--scheduler", address, "--json"]
        assert main(call) == BAD
    (row,) = json.loads(capsys.readouterr().out)["parts"]
    assert row["verdict"] == "refused" and "neither a STEP nor an IGES file" in row["note"]
    assert row["host"] == socket.gethostname() and row["memory_limit"] > 0.0


class _Future:
    """A task of Dask as it ends."""

    def __init__(self, status, reason=None):
        self.status, self._reason = status, reason

    def result(self):
        raise self._reason


def test_workers_that_go_with_a_part_are_its_crash_and_a_lost_scheduler_is_no_parts():
    from distributed.scheduler import KilledWorker

    request = PartRequest(part="a.step", start="/", output="/", folder="a", settings={})
    gone = KilledWorker("task", SimpleNamespace(address="tcp://10.0.0.7:1"), 3)
    result = _result_of(_Future("error", gone), request)
    assert result.verdict == "crashed" and result.note.startswith("KilledWorker: ")
    with pytest.raises(BadInput, match="the scheduler of Dask is gone"):
        _result_of(_Future("lost"), request)
