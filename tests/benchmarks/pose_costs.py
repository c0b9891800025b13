"""What poses cost besides the way from log to poses: imports, compilation and memory, each in a process of its own."""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

PROGRAM = """
import json, resource, sys
from pathlib import Path
from time import process_time
start = process_time()
from slam.mapper import Mapper
from slam.recordings import open_recording
from slam.settings import Settings
imported = process_time() - start
scans = open_recording(Path(sys.argv[1])).scans[: int(sys.argv[2])]
seconds = []
for _ in range(int(sys.argv[3])):
    start = process_time()
    mapper = Mapper(Settings().frontend, Settings().poses)
    for scan in scans:
        mapper.add(scan)
    mapper.result()
    seconds.append(process_time() - start)
megabytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
print(json.dumps({"imported": imported, "seconds": seconds, "megabytes": megabytes}))
"""


def start_costs(log: Path, scans: int) -> tuple[float, float]:
    """CPU seconds of the imports, and of compiling every loop that so many scans need."""
    with tempfile.TemporaryDirectory() as empty:
        told = _run(log, scans, 2, {"NUMBA_CACHE_DIR": empty})
    return told["imported"], told["seconds"][0] - told["seconds"][1]


def peak_megabytes(log: Path) -> float:
    """The most memory that a process needed from log to poses."""
    return float(_run(log, 10**9, 1, {})["megabytes"])


def _run(log: Path, scans: int, times: int, environment: dict[str, str]) -> dict[str, Any]:
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(log), str(scans), str(times)],
        env={**os.environ, **environment}, check=True, capture_output=True, text=True,
    )  # fmt: skip
    return dict(json.loads(done.stdout))
