"""`trunnion optimum` and `trunnion optimize`: the paper's example from the command line, and the comparison of a part's operations."""

from __future__ import annotations

import json

import pytest

from samples import block_with_pocket
from trunnion.cli.main import BAD, DONE, main

QUICK = ["--set", "optimize.genetic.generations=6", "--set", "optimize.genetic.population=12"]


def test_the_papers_example_runs_from_the_command_line(capsys):
    assert main(["optimum", *QUICK]) == DONE
    out = capsys.readouterr().out
    assert "paper: Face milling of C45 steel" in out
    assert "3.98, 89.72" in out and "exact" in out and "genetic" in out


def test_its_json_has_points_convergence_and_front(capsys):
    assert main(["optimum", "--json", "--reading", "m/s", *QUICK]) == DONE
    (cut,) = json.loads(capsys.readouterr().out)["cuts"]
    assert cut["speed_unit"] == "m/s" and len(cut["convergence"]) == 6 and cut["front"]
    points = {p["name"]: p for p in cut["points"]}
    assert points["handbook"]["printed"] == {"time": 3.98, "cost": 89.72}
    # With v in m/s the paper's own points pass its own largest force.
    assert points["handbook"]["feasible"] is False and points["exact"]["feasible"] is True


def test_a_setting_that_is_not_allowed_is_one_line(capsys):
    assert main(["optimum", "--set", "optimize.genetic.population=2"]) == BAD
    assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.parametrize("data", ["handbook", "optimised"])
def test_optimize_compares_the_tables_with_the_optimiser(capsys, data):
    words = ["optimize", str(block_with_pocket()), "--json", "--set", f"optimize.data={data}"]
    assert main(words) == DONE
    found = json.loads(capsys.readouterr().out)
    assert found["optimised"] is (data == "optimised")
    operations = {o["id"]: o["data"] for o in found["operations"]}
    for c in found["comparison"]:
        used = operations[c["operation"]]
        assert used["feed"] == pytest.approx(c[data]["feed"])
        assert c["optimised"]["seconds"] <= c["handbook"]["seconds"] * 1.0001
        assert c["bound_by"] and max(c["optimised"]["shares"].values()) <= 1.0 + 1e-8
        assert ("handbook_feed" in used) is (data == "optimised")
