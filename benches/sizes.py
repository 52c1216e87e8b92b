#!/usr/bin/env python3
"""Condensation by size: time and memory against unknowns and pairs, with fitted exponents; warm starts; start-up.

    cargo build --release -p stickslip -p stickslip-benches --bin stickslip --example measure
    python benches/sizes.py unknowns | pairs | cases | warm | start     (needs nothing but Python)
"""

import json
import math
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

RELEASE = Path(__file__).resolve().parent.parent / "target/release"
REPETITIONS = 3


def condense(nx, ny, width, height, cases=2, plain=True):
    """Medians of a few runs, each a process of its own, so that the peak is that of one condensation."""
    words = [RELEASE / "examples/measure", "condense", nx, ny, width, height, cases]
    runs = []
    for _ in range(REPETITIONS):
        done = subprocess.run(
            [str(word) for word in words + ["plain"] * plain], capture_output=True, text=True
        )
        if done.returncode:
            return done.stderr.strip()
        runs.append(json.loads(done.stdout))
    return {key: statistics.median(run[key] or 0 for run in runs) for key in runs[0]}


def exponent(points):
    """Slope of log y over log x by least squares."""
    points = [(math.log(x), math.log(y)) for x, y in points if x > 0 and y > 0]
    mean_x = statistics.mean(x for x, _ in points)
    mean_y = statistics.mean(y for _, y in points)
    return sum((x - mean_x) * (y - mean_y) for x, y in points) / sum(
        (x - mean_x) ** 2 for x, _ in points
    )


HEAD = (
    "| elements of a plate | unknowns | m | assembly s | order + factor s | R, RF, kernel s | faer plain AMD s | ratio "
    "| entries 1e6 | peak MB |\n|" + " --- |" * 10
)


def line(nx, ny, run):
    if isinstance(run, str):
        print(f"| {nx} × {ny} | {run} |", flush=True)
        return
    print(
        f"| {nx} × {ny} | {run['unknowns']:.0f} | {run['pairs']:.0f} | {run['assemble']:.2f} | {run['factor']:.2f} | "
        f"{run['condense']:.3f} | {run.get('plain', 0):.2f} | {run.get('ratio', 0):.2f} | {run['entries'] / 1e6:.1f} | "
        f"{run['peak_megabytes']:.0f} |",
        flush=True,
    )


def table(sizes, against):
    print(HEAD)
    runs = []
    for nx, ny, width, height in sizes:
        run = condense(nx, ny, width, height)
        line(nx, ny, run)
        if not isinstance(run, str):
            runs.append(run)
    for what in ("factor", "condense", "peak_megabytes", "entries"):
        print(f"{what} ~ {against}^{exponent([(run[against], run[what]) for run in runs]):.2f}")
    last = runs[-3:]
    print(f"last three: factor ~ {against}^{exponent([(r[against], r['factor']) for r in last]):.2f}")


def unknowns():
    """Plates 8 × 4, elements in the ratio 2:1: 1e4 … 1e6 unknowns."""
    table([(nx, nx // 2, 8, 4) for nx in (70, 160, 240, 400, 560, 707)], "unknowns")


def pairs():
    """About 160 000 unknowns, square elements, longer and lower plates: m = 10 … 2000."""
    sizes = []
    for m in (10, 25, 50, 100, 200, 400, 1000, 2000):
        nx, ny = m - 1, round(40_000 / m) - 1
        sizes.append((nx, ny, 0.02 * nx, 0.02 * ny))
    table(sizes, "pairs")


def cases():
    """Load cases: R is made without right-hand sides, RF costs a sweep for all cases at once."""
    print("| load cases | order + factor s | R, RF, kernel s |\n| --- | --- | --- |")
    for count in (2, 10, 40):
        run = condense(400, 200, 8, 4, cases=count, plain=False)
        print(f"| {count} | {run['factor']:.2f} | {run['condense']:.3f} |", flush=True)


def warm():
    """Ratios to the cold run of Lemke's algorithm, in one process."""
    print("| m | f | change | cold Lemke ms | path ms | cold / path | whole answer: cold ms | warm ms | ratio | pivots | same |")
    print("|" + " --- |" * 11)
    for m in (100, 300, 1000):
        for friction in (0.1, 0.4, 2):
            repetitions = 3 if m == 1000 else 9
            words = [RELEASE / "examples/measure", "warm", m, friction, 60, repetitions]
            done = subprocess.run([str(w) for w in words], capture_output=True, text=True)
            if done.returncode:
                print(done.stderr)
                continue
            run = json.loads(done.stdout)
            for name, change in run["changed"].items():
                found = change["found"]
                if found is None:
                    print(f"| {m} | {friction} | {name} | {1e3 * run['cold_lemke']:.1f} | cold start instead |", flush=True)
                    continue
                print(
                    f"| {m} | {friction} | {name} | {1e3 * run['cold_lemke']:.1f} | {1e3 * found['path']:.2f} | "
                    f"{run['cold_lemke'] / found['path']:.0f} | {1e3 * run['cold_whole']:.1f} | {1e3 * found['whole']:.1f} | "
                    f"{run['cold_whole'] / found['whole']:.1f} | {found['changes']} | {'yes' if found['same'] else 'NO'}"
                    f"{', cold ' + str(change['failed']) + ' times' if change['failed'] else ''} |",
                    flush=True,
                )


def start():
    """From process start to the answer on standard output."""
    plates = {
        "format": "stickslip/1",
        "title": "About a thousand unknowns",
        "materials": {"m": {"E": 1e5, "nu": 0.3}},
        "plates": [
            {"id": name, "origin": [0, y], "size": [8, 4], "divisions": [20, 11], "thickness": 0.1, "material": "m",
             "plane": "strain"} for name, y in (("lower", 0), ("upper", 4))
        ],
        "supports": [{"at": "lower.bottom", "fixed": ["x", "y"]}],
        "contacts": [{"id": "joint", "edge": "upper.bottom", "against": "lower.top", "friction": 0.3}],
        "loads": {"weight": {"items": [{"traction": {"edge": "upper.top", "value": [0, -100]}}]},
                  "pull": {"items": [{"traction": {"edge": "upper.left", "value": [40, 0]}}]}},
    }
    path = f"/tmp/stickslip-start-{os.getpid()}.json"
    Path(path).write_text(json.dumps(plates))
    for scenario in ("beam", "plates-free", path):
        seconds = []
        for _ in range(21):
            clock = time.perf_counter()
            subprocess.run([RELEASE / "stickslip", "solve", scenario], capture_output=True)
            seconds.append(time.perf_counter() - clock)
        print(f"{scenario}: min {1e3 * min(seconds):.1f} ms, median {1e3 * statistics.median(seconds):.1f} ms")
    os.remove(path)


if __name__ == "__main__":
    known = {f.__name__: f for f in (unknowns, pairs, cases, warm, start)}
    wanted = sys.argv[1:]
    if not wanted or any(name not in known for name in wanted):
        sys.exit(__doc__)
    for name in wanted:
        print(f"\n{known[name].__doc__}\n", flush=True)
        known[name]()
