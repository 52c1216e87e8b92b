#!/usr/bin/env python3
"""A contact system for stickslip from R and RF that another program has computed.

    from contact_system import write
    write("joint.json", R, {"weight": RF}, pairs=["c1", "c2"], friction=[0.3, 0.3])

R is 2m x 2m for m pairs: all normals, then all tangentials; lists of rows, numpy arrays and matrices all do. RF has 2m numbers.
Run without arguments it condenses a beam on three supports to its contacts, with nothing but the standard library:
R = Bᵀ-block of the stiffness of the pairs once all other displacements are eliminated, RF = the forces of the clamped pairs.
"""

import json
import pathlib
import sys

from superelement import beam


def write(path, stiffness, loads, pairs, **rest):
    """Writes the scenario; `rest` holds friction, cohesion, gap, law, kernel, positions of the contact system."""
    path = pathlib.Path(path)
    scenario = {
        "format": "stickslip/1",
        "title": path.stem,
        "contact_system": {
            "pairs": list(pairs),
            "stiffness": [[float(r) for r in row] for row in stiffness],
            "loads": {name: {"vector": [float(force) for force in vector]} for name, vector in loads.items()},
            **rest,
        },
    }
    path.write_text(json.dumps(scenario, indent=2) + "\n")


def condense(stiffness, loads, kept):
    """K and each F on the rows `kept`, the others eliminated one by one (they must be held by the kept ones)."""
    k = [list(map(float, row)) for row in stiffness]
    loads = [list(map(float, load)) for load in loads]
    for i in (i for i in range(len(k)) if i not in kept):
        pivot = list(k[i])
        forces = [load[i] for load in loads]
        for j in range(len(k)):
            factor = pivot[j] / pivot[i]
            if j != i and factor != 0.0:
                k[j] = [a - factor * b for a, b in zip(k[j], pivot)]
                for load, force in zip(loads, forces):
                    load[j] -= factor * force
    return [[k[i][j] for j in kept] for i in kept], [[load[i] for i in kept] for load in loads]


def main(path):
    """The beam of superelement.py: the joints of the main system hold A, B and C, so R is K on them and RF = −F."""
    names = ["A", "B", "C"]
    weight, pull = [0.0] * 15, [0.0] * 15
    weight[4] = weight[10] = -100.0
    pull[0] = 1.0
    nodes = [0, 2, 4]
    # Against the ground n = (0, 1) gives z_n = u_y and t = (1, 0) gives z_t = u_x.
    kept = [3 * node + 1 for node in nodes] + [3 * node for node in nodes]
    r, forces = condense(beam([2.0] * 4, ea=2.1e6, ei=2.1e4), [weight, pull], kept)
    rf = [[-force for force in load] for load in forces]
    # Exactly symmetric, and the rigid motions of the beam (lifted, turned, pushed) are known.
    r = [[0.5 * (r[i][j] + r[j][i]) for j in range(6)] for i in range(6)]
    kernel = [[1, 1, 1, 0, 0, 0], [0, 4, 8, 0, 0, 0], [0, 0, 0, 1, 1, 1]]
    write(path, r, {"weight": rf[0], "pull": rf[1]}, [f"c{name}" for name in names], friction=[0.3] * 3, kernel=kernel)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "contact-system-beam.json")
