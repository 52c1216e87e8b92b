#!/usr/bin/env python3
"""R of two plates by stickslip, the Schur complement of the same matrices by MUMPS, and the bare factorization by PARDISO.

    pip install -r benches/requirements.txt        # python-mumps needs the library: libmumps-seq-dev, libopenblas-dev
    cargo build --release -p stickslip-benches --example measure
    RAYON_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 MKL_NUM_THREADS=1 python benches/schur.py [--pairs 401 1000 2000]
    … python benches/schur.py --bricks 30 30 10         # a block of bricks on a plane instead

Seconds of the processor, one thread each: those of the clock depend on what else the machine does. Also LAPACK's
Cholesky factorization and eigenvalues of a dense matrix of the order of R.
"""

import argparse
import json
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
import scipy.linalg
import scipy.sparse as sparse

ROOT = Path(__file__).resolve().parent.parent
# Divisions and size of a plate, about 160 000 unknowns (m = 401: 320 000).
PLATES = {
    100: (99, 399, 1.98, 7.98),
    401: (400, 200, 8, 4),
    1000: (999, 39, 19.98, 0.78),
    2000: (1999, 19, 39.98, 0.38),
}


def terms(path):
    rows, columns, values = np.loadtxt(path, unpack=True)
    return rows.astype(np.int64) - 1, columns.astype(np.int64) - 1, values


def processor(work):
    clock = time.process_time()
    result = work()
    return time.process_time() - clock, result


def mumps_schur(k, c):
    import mumps

    order, joints = k.shape[0], c.shape[1]
    whole = sparse.bmat([[k, c], [c.T, None]]).tocoo()
    context = mumps.Context()
    context.set_matrix(whole, symmetric=True)
    return context.schur(np.arange(order, order + joints, dtype=np.int32))


def pardiso(k):
    import pypardiso

    solver = pypardiso.PyPardisoSolver(mtype=2)
    solver.factorize(sparse.triu(k).tocsr())
    return solver


def exported(arguments, words):
    """What `measure` says of a model, its K_m and C."""
    with tempfile.TemporaryDirectory() as folder:
        words = [arguments.program, *words, folder]
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=True)
        own = json.loads(done.stdout)
        row, column, value = terms(f"{folder}/K.txt")
        lower = sparse.coo_matrix((value, (row, column))).tocsr()
        k = (lower + sparse.tril(lower, -1).T).tocsr()
        row, column, value = terms(f"{folder}/C.txt")
        c = sparse.coo_matrix((value, (row, column)), shape=(k.shape[0], column.max() + 1)).tocsr()
    return own, k, c


def measure_bricks(arguments):
    nx, ny, nz = arguments.bricks
    own, k, c = exported(arguments, ["space", nx, ny, nz, 8])
    print(json.dumps(own))
    report = {"unknowns": k.shape[0], "joints": c.shape[1]}
    for name, work in (("MUMPS Schur", lambda: mumps_schur(k, c)), ("PARDISO factor", lambda: pardiso(k))):
        try:
            report[name] = min(processor(work)[0] for _ in range(arguments.repetitions))
        except ImportError as error:
            report[name] = str(error)
    print(json.dumps(report))


def measure(arguments, pairs):
    nx, ny, width, height = PLATES[pairs]
    own, k, c = exported(arguments, ["schur", nx, ny, width, height])
    line = [pairs, k.shape[0], f"{own['whole']['processor']:.2f}", f"{own['peak_megabytes']:.0f}"]
    for name, work in (("MUMPS", lambda: mumps_schur(k, c)), ("PARDISO", lambda: pardiso(k))):
        try:
            seconds = [processor(work)[0] for _ in range(arguments.repetitions)]
            line.append(f"{min(seconds):.2f}")
        except ImportError as error:
            line.append(f"{name}: {error}")
    dense = np.random.default_rng(1).standard_normal((2 * pairs, 2 * pairs))
    dense = dense @ dense.T + 2 * pairs * np.eye(2 * pairs)
    line.append(f"{processor(lambda: scipy.linalg.cholesky(dense, lower=True))[0]:.2f}")
    line.append(f"{processor(lambda: scipy.linalg.eigvalsh(dense))[0]:.2f}" if pairs <= 1000 else "")
    print("| " + " | ".join(map(str, line)) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, nargs="+", default=[401, 1000, 2000], choices=PLATES)
    parser.add_argument("--repetitions", type=int, default=2)
    parser.add_argument("--program", default=ROOT / "target/release/examples/measure")
    parser.add_argument("--bricks", type=int, nargs=3, metavar=("NX", "NY", "NZ"))
    arguments = parser.parse_args()
    if arguments.bricks:
        return measure_bricks(arguments)
    print("| m | unknowns | stickslip, assembly to R | peak MB | MUMPS Schur | PARDISO factor | LAPACK potrf | syevd, values |")
    print("|" + " --- |" * 8)
    for pairs in arguments.pairs:
        measure(arguments, pairs)


if __name__ == "__main__":
    main()
