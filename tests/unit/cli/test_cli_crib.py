"""`trunnion tools crib`: tools put into a machine, listed, worn and taken out."""

from __future__ import annotations

import json

from trunnion.cli.main import BAD, DONE, main

MILL = "Mill 1200"


def crib(capsys, folder, *arguments):
    code = main(["tools", "crib", "--user-folder", str(folder), *arguments])
    return code, capsys.readouterr()


def test_tools_are_put_into_a_machine_worn_listed_and_taken_out(tmp_path, capsys):
    assert crib(capsys, tmp_path)[1].out.strip() == "no tools in the machine"
    code, printed = crib(
        *(capsys, tmp_path, "--machine", MILL, "--put", "DR-S D8=5:12"),
        *("--put", "AL3-stub D16 R0=2", "--wear", "DR-S D8=-0.012,0.004"),
    )
    assert code == DONE
    assert [line.split("  ")[0].strip() for line in printed.out.splitlines()[1:]] == [MILL] * 2
    assert printed.out.splitlines()[2].split() == [
        *("Mill", "1200", "5", "12", "DR-S", "D8", "-0.012", "0.004"),
    ]
    # A tool that is taken out frees its number in the same call.
    code, printed = crib(
        *(capsys, tmp_path, "--machine", MILL, "--take", "DR-S D8"),
        *("--put", "AL3-stub D16 R0=5", "--json"),
    )
    assert code == DONE
    assert json.loads(printed.out) == {
        "machines": {
            MILL: [
                {
                    "name": "AL3-stub D16 R0",
                    "number": 5,
                    "pocket": 0,
                    "wear_length": 0.0,
                    "wear_radius": 0.0,
                }
            ]
        }
    }


def test_wrong_words_get_one_line(tmp_path, capsys):
    for arguments, words in (
        (["--put", "DR-S D8=5"], "want a machine"),
        (["--machine", MILL, "--put", "DR-S D8"], "--put wants NAME=T"),
        (["--machine", MILL, "--put", "DR-S D8=0"], "--put wants NAME=T"),
        (["--machine", MILL, "--put", "DR-S D8=1:x"], "--put wants NAME=T"),
        (["--machine", MILL, "--wear", "DR-S D8=1"], "--wear wants NAME=LENGTH,RADIUS"),
        (["--machine", MILL, "--wear", "=1,1"], "--wear wants NAME=LENGTH,RADIUS"),
        (["--machine", MILL, "--put", "Nothing=1"], "unknown tool Nothing"),
        (["--machine", "Mill 9"], "unknown machine Mill 9"),
        (["--machine", MILL, "--take", "DR-S D8"], "is not in the machine"),
    ):
        code, printed = crib(capsys, tmp_path, *arguments)
        assert code == BAD and words in printed.err and len(printed.err.splitlines()) == 1
    assert not (tmp_path / "crib").exists()
