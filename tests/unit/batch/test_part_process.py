"""A part's process ends at its limits, alone, with all that it started; how it ended is put in words."""

from __future__ import annotations

import fcntl
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from trunnion.batch.child import NO_MEMORY, REFUSAL, REFUSED, REPORT, RESULT
from trunnion.batch.part_process import CRASH_FILE, part_processed
from trunnion.batch.request import PartRequest
from trunnion.findings import Cancelled
from trunnion.model.part_result import PartResult

PATIENCE_S = 10.0
"""Seconds that a process may take to be gone."""


def processed(tmp_path, code, *, is_stopped=lambda: False, report=lambda *_: None, **limits):
    """Return the result of a part whose process runs some code, with the folder of the request as its argument."""
    request = PartRequest(
        part="rib.step",
        start=str(tmp_path),
        output=str(tmp_path),
        folder="rib",
        settings={},
        **limits,
    )
    return part_processed(
        request, report, is_stopped, command=("-c", f"import os, sys, time\n{code}")
    )


def gone(process):
    """Return whether a process is gone within `PATIENCE_S`; one that nobody waits for any more counts as gone."""
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        try:
            if psutil.Process(process).status() == psutil.STATUS_ZOMBIE:
                return True
        except psutil.NoSuchProcess:
            return True
        time.sleep(0.05)
    return False


def writes(file, text, code=0):
    return f"open(os.path.join(sys.argv[1], {file!r}), 'w').write({text!r})\nsys.exit({code})"


def test_what_the_process_writes_is_the_result_with_its_time_and_memory(tmp_path):
    made = PartResult(part="rib.step", folder="rib", verdict="passed", coverage=0.5)
    result = processed(tmp_path, writes(RESULT, json.dumps(made.as_dict())), memory=900.0)
    assert (result.verdict, result.coverage, result.memory_limit) == ("passed", 0.5, 900.0)
    assert result.seconds >= 0.0


def test_a_refusal_is_the_note(tmp_path):
    result = processed(tmp_path, writes(REFUSAL, "rib.step: is empty", REFUSED))
    assert (result.verdict, result.note) == ("refused", "rib.step: is empty")


def test_a_process_that_says_that_memory_ended_is_no_crash(tmp_path):
    assert processed(tmp_path, f"sys.exit({NO_MEMORY})").verdict == "out of memory"


def test_a_crash_is_named_by_its_signal_and_its_last_words_are_kept(tmp_path):
    result = processed(tmp_path, "print('at face 12', flush=True); os.abort()")
    assert result.verdict == "crashed" and "SIGABRT" in result.note
    assert result.files == (CRASH_FILE,)
    assert (tmp_path / "rib" / CRASH_FILE).read_text() == "at face 12\n"


def test_an_unexpected_error_is_a_crash_with_its_own_line(tmp_path):
    result = processed(tmp_path, "raise ValueError('no such row')")
    assert result.verdict == "crashed" and result.note.endswith("ValueError: no such row")


def test_a_process_that_takes_more_memory_than_allowed_is_ended(tmp_path):
    endless = "kept = []\nwhile True:\n kept.append(b'x' * (1 << 24))\n time.sleep(0.02)"
    result = processed(tmp_path, endless, memory=150.0)
    assert result.verdict == "out of memory" and "150 MB" in result.note
    assert 150.0 < result.memory < 1500.0


def test_memory_is_that_of_all_processes_together_and_shared_pages_count_once(tmp_path):
    made = PartResult(part="rib.step", folder="rib", verdict="passed")
    shares = "kept = b'x' * (200 << 20)\nfor _ in range(3):\n if os.fork() == 0: time.sleep(60)\n"
    code = f"{shares}time.sleep(1.0)\n{writes(RESULT, json.dumps(made.as_dict()))}"
    assert 200.0 < processed(tmp_path, code).memory < 400.0


def test_a_process_that_takes_longer_than_allowed_is_ended(tmp_path):
    result = processed(tmp_path, "time.sleep(60)", seconds=0.3)
    assert result.verdict == "over time" and 0.3 <= result.seconds < PATIENCE_S


def test_nothing_that_the_process_started_is_left(tmp_path):
    code = (
        "n = os.fork()\nif n == 0: time.sleep(60)\n"
        f"open({str(tmp_path / 'child')!r}, 'w').write(str(n)); os.abort()"
    )
    processed(tmp_path, code)
    assert gone(int((tmp_path / "child").read_text()))


def test_a_stopped_part_leaves_no_process(tmp_path):
    file = tmp_path / "process"
    code = f"open({str(file)!r}, 'w').write(str(os.getpid())); time.sleep(60)"
    with pytest.raises(Cancelled):
        processed(tmp_path, code, is_stopped=lambda: file.is_file() and bool(file.read_text()))
    assert gone(int(file.read_text()))


def test_how_far_the_process_is_is_reported(tmp_path):
    heard = []
    code = f"open(os.path.join(sys.argv[1], {REPORT!r}), 'w').write('0.25 laying paths'); time.sleep(0.6)"
    processed(tmp_path, code, report=lambda *words: heard.append(words))
    assert (0.25, "laying paths") in heard


def test_the_process_works_in_the_folder_that_the_batch_was_started_in(tmp_path):
    processed(tmp_path, "open('here', 'w').close(); os.abort()")
    assert Path(tmp_path, "here").is_file() and os.getcwd() != str(tmp_path)


@pytest.mark.skipif(not hasattr(fcntl, "F_SETSIG"), reason="Linux alone sends the signal")
def test_a_part_ends_with_its_batch_even_while_it_holds_the_interpreters_lock(tmp_path):
    file = tmp_path / "process"
    busy = (
        "import os; from trunnion.batch.child import _end_with_batch; _end_with_batch()\n"
        f"open({str(file)!r}, 'w').write(f'{{os.getpid()}}.')\nsum(range(1 << 50))"
    )
    batch = (
        "import subprocess, sys\n"
        f"subprocess.Popen([sys.executable, '-c', {busy!r}], stdin=subprocess.PIPE, start_new_session=True).wait()"
    )
    with subprocess.Popen([sys.executable, "-c", batch]) as parent:
        end = time.monotonic() + PATIENCE_S
        while not (file.is_file() and file.read_text().endswith(".")):
            assert time.monotonic() < end and parent.poll() is None
            time.sleep(0.05)
        child = int(file.read_text()[:-1])
        assert psutil.pid_exists(child)
        parent.kill()
    assert gone(child)
