"""Judge programs that were written: `python tests/simulation/run.py FOLDER NAME PART.step TOLD.json` (what `program --json` answered)."""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from simulation.judge import judged, stage
from simulation.written import written


def main() -> None:
    """Print one line a setup, and the deepest faults of each."""
    folder, name, part, answer = sys.argv[1:5]
    told = json.loads(Path(answer).read_text())
    for scene in written(Path(folder), name, told):
        began = time.process_time()
        report = judged(stage(scene, Path(part)), scene.text)
        clean = "clean" if report.is_clean(told["coverage"]) else "NOT CLEAN"
        print(
            f"{name}: {clean} after {told['verdict']}, coverage {100.0 * told['coverage']:.2f} %; "
            f"{len(report.faults)} faults, left on {100.0 * report.left:.3f} % of {report.columns} columns "
            f"({report.left_height:.3f} mm), {time.process_time() - began:.1f} s"
        )
        for fault in report.faults[:8]:
            print("   ", fault)


if __name__ == "__main__":
    main()
