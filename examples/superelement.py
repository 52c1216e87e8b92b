#!/usr/bin/env python3
"""A superelement for stickslip from the stiffness and the loads of another program.

    from superelement import write
    write("frame.json", K, {"weight": F}, nodes={"A": (0, 0)}, dofs=[("A", "x"), …], contacts=[…])

K may be a scipy sparse matrix, a numpy array or a list of rows; a load one number for each dof. Files K.mtx and CASE.mtx are
written beside the scenario. In space nodes are (x, y, z), dofs "x", "y", "z", "rx", "ry", "rz". `from_pynite` takes K and F from a
PyNite model in the x-y plane. Run without arguments it writes a beam on three supports of friction that it assembles itself,
with nothing but the standard library.
"""

import json
import pathlib
import sys


def entries(matrix):
    """(row, column, value) of the lower triangle, whatever holds the matrix."""
    if hasattr(matrix, "tocoo"):  # scipy.sparse
        coo = matrix.tocoo()
        coo.sum_duplicates()
        found = zip(coo.row, coo.col, coo.data)
    else:
        rows = [list(row) for row in matrix]
        found = ((i, j, value) for i, row in enumerate(rows) for j, value in enumerate(row))
    return [(int(i), int(j), float(value)) for i, j, value in found if i >= j and value != 0]


def write_matrix(path, matrix, size):
    """A symmetric matrix in Matrix Market's coordinate format, with all digits."""
    lower = entries(matrix)
    lines = [f"{i + 1} {j + 1} {value!r}" for i, j, value in lower]
    head = ["%%MatrixMarket matrix coordinate real symmetric", f"{size} {size} {len(lines)}"]
    pathlib.Path(path).write_text("\n".join(head + lines) + "\n")


def write_column(path, values):
    """A column of numbers in Matrix Market's array format."""
    lines = [repr(float(value)) for value in values]
    head = ["%%MatrixMarket matrix array real general", f"{len(lines)} 1"]
    pathlib.Path(path).write_text("\n".join(head + lines) + "\n")


def write(path, stiffness, forces, nodes, dofs, **rest):
    """Writes the scenario `path` and its matrices beside it; `rest` holds contacts, supports, further loads and the like."""
    path = pathlib.Path(path)
    file = path.stem + "-K.mtx"
    write_matrix(path.with_name(file), stiffness, len(dofs))
    cases = {}
    for name, values in forces.items():
        cases[name] = {"file": f"{path.stem}-{name}.mtx"}
        write_column(path.with_name(cases[name]["file"]), values)
    in_space = any(len(place) == 3 for place in nodes.values())
    scenario = {
        "format": "stickslip/1",
        "title": rest.pop("title", path.stem),
        **({"dimension": 3} if in_space else {}),
        "superelement": {
            "stiffness": {"file": file},
            "loads": cases,
            "nodes": {name: [float(number) for number in place] for name, place in nodes.items()},
            "dofs": [list(dof) for dof in dofs],
        },
        **rest,
    }
    path.write_text(json.dumps(scenario, indent=2) + "\n")


def from_pynite(path, model, combo="Combo 1", case="load", **rest):
    """The x-y part of a PyNite model without its supports: state them, or contacts, in `rest`.

    PyNite (3.2; before 3.0 `K` in the place of `Ke`) numbers six dofs a node (DX, DY, DZ, RX, RY, RZ) in the order of its
    nodes. Nothing is solved, so the model needs no supports.
    """
    from Pynite.Analysis import _prepare_model

    _prepare_model(model)
    names = list(model.nodes)
    dofs, keep = [], []
    for k, name in enumerate(names):
        for component, offset in (("x", 0), ("y", 1), ("r", 5)):
            dofs.append((name, component))
            keep.append(6 * k + offset)
    stiffness_of = getattr(model, "Ke", None) or model.K
    k = stiffness_of(combo, check_stability=False, sparse=False)
    f = model.P(combo) - model.FER(combo)
    stiffness = [[float(k[i, j]) for j in keep] for i in keep]
    nodes = {name: (model.nodes[name].X, model.nodes[name].Y) for name in names}
    write(path, stiffness, {case: [float(f[i, 0]) for i in keep]}, nodes, dofs, **rest)


def beam(lengths, ea, ei):
    """K of a straight chain of frame elements along x; rows x, y, r of each node."""
    size = 3 * (len(lengths) + 1)
    k = [[0.0] * size for _ in range(size)]
    for first, l in enumerate(lengths):
        a, b, d, e = ea / l, 12 * ei / l**3, 6 * ei / l**2, 2 * ei / l
        own = [
            [a, 0, 0, -a, 0, 0],
            [0, b, d, 0, -b, d],
            [0, d, 2 * e, 0, -d, e],
            [-a, 0, 0, a, 0, 0],
            [0, -b, -d, 0, b, -d],
            [0, d, e, 0, -d, 2 * e],
        ]
        for i in range(6):
            for j in range(6):
                k[3 * first + i][3 * first + j] += own[i][j]
    return k


def main(path):
    """A beam of two spans on three supports of friction, loaded in the middle of each span and pulled at one end."""
    names = ["A", "m", "B", "n", "C"]
    stiffness = beam([2.0] * 4, ea=2.1e6, ei=2.1e4)
    dofs = [(name, component) for name in names for component in "xyr"]
    weight, pull = [0.0] * 15, [0.0] * 15
    weight[4] = weight[10] = -100.0
    pull[0] = 1.0
    contact = {"against": "ground", "normal": [0, 1], "friction": "f"}
    write(
        path,
        stiffness,
        {"weight": weight, "pull": pull},
        {name: (2.0 * k, 0.0) for k, name in enumerate(names)},
        dofs,
        title="Beam on three supports of friction, from its stiffness",
        parameters={"f": {"value": 0.3, "min": 0, "max": 1}},
        contacts=[{"id": f"c{name}", "node": name, **contact} for name in ("A", "B", "C")],
    )


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "superelement-beam.json")
