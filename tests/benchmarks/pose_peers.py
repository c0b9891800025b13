"""Poses beside other systems in one run: the same logs, the same relations, raw odometry as everybody's first guess.

The recordings lie in the folder that ROOMSKETCH_DATA names. ROOMSKETCH_POSE_PEERS may name a Python that has yag-slam,
kiss-icp and small_gicp; what it lacks is said in the note.
"""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from frontend.scan import Floats, Scan
from slam.recordings import open_recording
from slam.scores.trajectories import Spread, read_relations, relation_errors
from tests.benchmarks.pose_rivals import SYSTEMS
from tests.benchmarks.poses import LOGS, WARM_UP, mapped, odometry_of, recordings, track_of

RIVALS = Path(__file__).with_name("pose_rivals.py")
TARGETS: dict[
    str, dict[str, float | None]
] = {  # metres and seconds; the errors at most those of the best peer measured anywhere
    "intel": {"mean": 0.0225, "median": None, "std": 0.0145, "seconds": 6.0},
    "intel_dense": {"mean": 0.0160, "median": 0.0140, "std": 0.0105, "seconds": 20.0},
}
LONGEST = 600  # seconds that a rival may take for a log
NATURE = "KISS-ICP (scan to map) and small_gicp (scan to submap) close no loops; yag-slam does, at its defaults"
ALONE = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}  # process CPU of one thread is compared

Row = dict[str, Any]


@dataclass(frozen=True)
class Result:
    """What one system made of a log: its errors over the relations, and process CPU seconds."""

    metres: Spread
    seconds: float


def rows() -> list[Row]:
    """One row per figure. Raises BenchmarkError without the folder of real recordings."""
    folder = recordings() / "intel"
    mapped(open_recording(folder / "intel.log.gz").scans[:WARM_UP])
    return [found for log in LOGS for found in log_rows(folder / f"{log}.log.gz")]


def log_rows(path: Path) -> list[Row]:
    """Mean, median, standard deviation and CPU seconds of one log, the rivals as peers."""
    log = path.name.split(".")[0]
    results, note = measured(path)
    targets = TARGETS[log]
    errors = [
        row(f"{log}: {name} translation error", "m", {who: getattr(r.metres, key) for who, r in results.items()}, note)
        | {"target": targets[key]}
        for name, key in (("mean", "mean"), ("median", "median"), ("standard deviation of", "std"))
    ]
    seconds = {who: result.seconds for who, result in results.items() if who != "raw odometry"}
    timed = row(f"{log}: from scans to poses", "s CPU", seconds, f"without imports and compilation; {note}")
    return [*errors, timed | {"target": targets["seconds"]}]


def measured(path: Path) -> tuple[dict[str, Result], str]:
    """What each system made of a log, ours among them; and in words what must be known of it."""
    scans = open_recording(path).scans
    clock = process_time()
    poses = mapped(scans)[1].poses
    ours = judged(path, scans, poses, process_time() - clock)
    results = {"ours": ours, "raw odometry": judged(path, scans, odometry_of(scans), 0.0)}
    lacking = []
    for name in SYSTEMS:
        answer = asked(name, scans)
        if "absent" in answer:
            lacking.append(answer["absent"])
        else:
            results[name] = judged(path, scans, np.array(answer["poses"]), answer["seconds"])
    return results, "; ".join([f"{ours.metres.count} relations, {len(scans)} scans, all in one run", NATURE, *lacking])


def judged(path: Path, scans: Sequence[Scan], poses: Floats, seconds: float) -> Result:
    """Poses (n, 3) against the relations that lie beside the log."""
    relations = read_relations(path.with_suffix("").with_suffix(".relations"))
    return Result(Spread.of(relation_errors(track_of(path, scans, poses), relations)[0]), seconds)


def asked(name: str, scans: Sequence[Scan]) -> dict[str, Any]:
    """A rival's poses and CPU seconds, or why there are none."""
    log = {
        "bearings": scans[0].bearings.tolist(),
        "scans": [{"ranges": scan.ranges.tolist(), "odometry": scan.odometry.tolist()} for scan in scans],
    }
    command = [os.environ.get("ROOMSKETCH_POSE_PEERS", sys.executable), str(RIVALS), name]
    try:
        run = subprocess.run(
            command, input=json.dumps(log), capture_output=True, text=True, check=True, timeout=LONGEST,
            env={**os.environ, **ALONE},
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return {"absent": f"{name} did not finish within {LONGEST} s"}
    except subprocess.CalledProcessError as failed:
        last = failed.stderr.strip().splitlines()[-1:]
        return {"absent": f"{name} failed with exit code {failed.returncode}: {' '.join(last)}"}
    answer: dict[str, Any] = json.loads(run.stdout.splitlines()[-1])
    return answer


def row(name: str, unit: str, values: dict[str, float], note: str) -> Row:
    """A figure of ours where less is better, the others as peers."""
    peers = {who: value for who, value in values.items() if who != "ours"}
    return {
        "part": "pose_peers", "name": name, "value": values["ours"], "unit": unit, "better": "lower",
        "target": None, "peers": peers, "runs": 1, "note": note,
    }  # fmt: skip
