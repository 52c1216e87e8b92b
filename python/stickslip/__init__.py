"""Structures with frictional contact from Python.

    import stickslip
    with stickslip.open("dam.json") as dam:
        answer = dam.set(f=0.4).solve()
        answer.pairs["x_n"]                       # a numpy array where numpy is there, else a list
        dam.sweep(f=(0, 1, 21))["max_slip"]

A thin client: the program itself (`stickslip serve`) runs beside it, one for each open scenario.
"""

from ._client import (
    Answer,
    CommandError,
    Error,
    ExpectationFailed,
    Interrupted,
    Model,
    Problem,
    ProgramError,
    ScenarioError,
    open,
    program,
)
from ._table import Table

__all__ = [
    "Answer",
    "CommandError",
    "Error",
    "ExpectationFailed",
    "Interrupted",
    "Model",
    "Problem",
    "ProgramError",
    "ScenarioError",
    "Table",
    "open",
    "program",
]
