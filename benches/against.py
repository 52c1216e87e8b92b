#!/usr/bin/env python3
"""Stickslip's engine and the Lemke solvers of PyPI on the same contact LCPs, alternating in one run.

    pip install -r benches/requirements.txt
    cargo build --release -p stickslip-benches --example measure
    python benches/against.py [--pairs 100 300 1000] [--friction 0.1 0.4 2] [--repetitions 7]

Every solver gets the same exported M, q and d. Stickslip's time goes from R, RF and f to the last vertex computed
afresh; the others' from M and q to z, after a warm-up run (compilation is not counted). Each answer is checked from M
and q. A ray is false where another solver's answer to the same problem passes the check.
"""

import argparse
import json
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
from scipy.io import mmread

ROOT = Path(__file__).resolve().parent.parent


class Stickslip:
    name = "stickslip"

    def __init__(self, program, pairs, friction, traction, pull, folder):
        command = [program, "engine", str(pairs), str(friction), str(traction), pull, folder]
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        if not self.process.stdout.readline():
            raise SystemExit(f"{' '.join(map(str, command))} failed")

    def run(self):
        self.process.stdin.write("run\n")
        self.process.stdin.flush()
        self.last = json.loads(self.process.stdout.readline())
        z = np.array(self.last["z"]) if self.last["outcome"] in ("Normal", "Trivial") else None
        return self.last["seconds"], z, f"{self.last['outcome'].lower()}, {self.last['pivots']} pivots"

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def quantecon(m, q, d):
    from quantecon.optimize import lcp_lemke

    def run():
        result = lcp_lemke(m, q, d)
        said = {0: "normal", 1: "pivot limit", 2: "ray"}.get(result.status, str(result.status))
        return result.z if result.success else None, f"{said}, {result.num_iter} pivots"

    return run


def lemkelcp(m, q, _):
    import builtins

    from lemkelcp import lemkelcp as module

    # Written for Python 2: it assigns to the elements of a range.
    module.range = lambda *arguments: list(builtins.range(*arguments))
    solve = module.lemkelcp

    def run():
        z, code, message = solve(m, q, maxIter=100_000)
        return (z if code == 0 else None), message.lower()

    return run


def drake(m, q, _):
    from pydrake.solvers import MathematicalProgram, UnrevisedLemkeSolver

    def run():
        # A solver keeps the basis of its last run and starts from it: each run gets its own.
        program = MathematicalProgram()
        z = program.NewContinuousVariables(len(q))
        program.AddLinearComplementarityConstraint(m, q, z)
        result = UnrevisedLemkeSolver().Solve(program)
        return (result.GetSolution(z) if result.is_success() else None), str(
            result.get_solution_result()
        )

    return run


YARDSTICKS = {
    "QuantEcon": quantecon,
    "Drake UnrevisedLemke": drake,
    "lemkelcp": lemkelcp,
}


def residuals(m, q, z):
    """min w and min z, relative to their largest; wᵀz relative to the largest product."""
    w = m @ z + q
    force, length = max(np.abs(q).max(), np.abs(w).max()), max(np.abs(z).max(), 1e-300)
    return w.min() / force, z.min() / length, np.abs(w * z).max() / (force * length)


def measure(arguments, pairs, friction):
    with tempfile.TemporaryDirectory() as folder:
        own = Stickslip(
            arguments.program, pairs, friction, arguments.traction, arguments.pull, folder
        )
        m, q, d = (np.ascontiguousarray(mmread(f"{folder}/{name}.mtx")) for name in "Mqd")
    q, d = q.ravel(), d.ravel()
    runs = {}
    for name, make in YARDSTICKS.items():
        if pairs > arguments.limit.get(name, 10**9):
            continue
        try:
            runs[name] = make(m, q, d)
        except ImportError:
            print(f"  {name} is not installed", flush=True)
    own.run()
    for name, run in list(runs.items()):
        clock = time.perf_counter()
        run()  # compiles
        if time.perf_counter() - clock > arguments.patience:
            print(f"  {name}: one run took {time.perf_counter() - clock:.1f} s; measured once more only")
    seconds = {own.name: [], **{name: [] for name in runs}}
    answers = {}
    for repetition in range(arguments.repetitions):
        took, *answers[own.name] = own.run()
        seconds[own.name].append(took)
        for name, run in runs.items():
            if repetition > 0 and seconds[name][0] > arguments.patience:
                continue
            clock = time.perf_counter()
            answers[name] = run()
            seconds[name].append(time.perf_counter() - clock)
    parts = own.last
    own.close()

    checks = {n: residuals(m, q, z) for n, (z, _) in answers.items() if z is not None}
    passed = [n for n, (w, z, wz) in checks.items() if w > -1e-9 and z > -1e-9 and wz < 1e-9]
    base = {f: f(seconds[own.name]) for f in (min, statistics.median)}
    for name, (z, said) in answers.items():
        if z is None and passed:
            said += " (FALSE: an answer exists)"
        if z is not None:
            said += "; min w {:.0e}, min z {:.0e}, |w z| {:.0e}".format(*checks[name])
            said += "" if name in passed else " WRONG"
        ratio = base[statistics.median] / statistics.median(seconds[name])
        print(
            f"| {pairs} | {friction} | {name} | {1e3 * min(seconds[name]):.1f} | "
            f"{1e3 * statistics.median(seconds[name]):.1f} | "
            f"{'1' if name == own.name else f'1/{1 / ratio:.1f}'} | {said} |",
            flush=True,
        )
    print(
        "  stickslip: form {form:.4f} s, pivoting {pivoting:.4f} s, vertex {vertex:.4f} s, "
        "{refreshes} restarts from the data, {0:.1f} µs a pivot".format(
            1e6 * parts["pivoting"] / max(parts["pivots"], 1), **parts
        ),
        flush=True,
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, nargs="+", default=[100, 300])
    parser.add_argument("--friction", type=float, nargs="+", default=[0.1, 0.4, 2.0])
    parser.add_argument("--traction", type=float, default=60.0)
    parser.add_argument("--pull", choices=["one-sided", "symmetric"], default="one-sided")
    parser.add_argument("--repetitions", type=int, default=7)
    parser.add_argument("--patience", type=float, default=5.0, help="slower ones run once")
    parser.add_argument("--program", default=ROOT / "target/release/examples/measure")
    arguments = parser.parse_args()
    # Their time grows with m⁴ and more, and they fail long before.
    arguments.limit = {"lemkelcp": 300, "Drake UnrevisedLemke": 300}
    print("| m | f | solver | min ms | median ms | stickslip / solver | result |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for pairs in arguments.pairs:
        for friction in arguments.friction:
            measure(arguments, pairs, friction)


if __name__ == "__main__":
    main()
