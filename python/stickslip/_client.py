"""A scenario in a `stickslip serve` of its own."""

import json
import os
import shlex
import shutil
import signal
import subprocess
import sysconfig
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from ._table import Table


class Error(Exception):
    """Whatever the program could not do; `status` is the exit status that the shell command would have had."""

    def __init__(self, message, status=4):
        super().__init__(message)
        self.status = status


class CommandError(Error):
    """A command, a name or a value that the program refuses."""


@dataclass(frozen=True)
class Problem:
    """A problem of a scenario and its place."""

    file: str
    line: Optional[int]
    column: Optional[int]
    path: str
    message: str
    help: str


class ScenarioError(CommandError):
    """A scenario with problems, one by one in `problems`."""

    def __init__(self, message, status, problems):
        super().__init__(message, status)
        self.problems = [Problem(**problem) for problem in problems]


class ExpectationFailed(Error):
    """An `expect` that does not hold."""


class Interrupted(Error):
    """A command that was stopped; the session is as it was."""


class ProgramError(Error):
    """A failure of the program, or one that has ended."""


def _error(answer):
    message, status = answer.get("error", "no answer"), answer.get("status", 4)
    if answer.get("problems"):
        return ScenarioError(message, status, answer["problems"])
    kind = {1: ExpectationFailed, 2: CommandError, 130: Interrupted}.get(status, ProgramError)
    return kind(message, status)


def program():
    """The path of the program: that of the variable STICKSLIP, the one installed with this package, or on the PATH."""
    named = os.environ.get("STICKSLIP")
    if named:
        return named
    name = "stickslip.exe" if os.name == "nt" else "stickslip"
    scripts = [sysconfig.get_path("scripts")]
    if os.name in ("nt", "posix"):
        scripts.append(sysconfig.get_path("scripts", f"{os.name}_user"))
    for folder in scripts:
        if folder and (Path(folder) / name).is_file():
            return str(Path(folder) / name)
    found = shutil.which("stickslip")
    if found is None:
        raise ProgramError("the program `stickslip` is not there: install the wheel, or set STICKSLIP to its path", 2)
    return found


def open(scenario):
    """Opens a scenario: a file, or an embedded one by its name."""
    model = Model()
    try:
        model.run(f"load {shlex.quote(os.fspath(scenario))}")
    except BaseException:
        model.close()
        raise
    return model


class Answer:
    """An answer, as `stickslip solve --format json` prints it: `json` holds all of it, the rest are short ways in."""

    def __init__(self, result):
        self.json = result
        self.outcome = result["outcome"]
        self.ray = result["ray"]
        self.p = result["p"]
        self.parameters = result["parameters"]
        self.check = result["check"]

    @property
    def is_answer(self):
        """Whether the structure stands: trivial or normal."""
        return self.outcome in ("trivial", "normal")

    def _table(self, key):
        if key not in self.json:
            raise AttributeError(f"this answer has no {key} (outcome {self.outcome})")
        return Table(self.json[key])

    def __getattr__(self, name):
        if name in ("pairs", "pivots", "displacements", "members", "reactions", "stresses", "resultants", "stages"):
            return self._table(name)
        raise AttributeError(name)

    @property
    def probes(self):
        """Name → value."""
        return dict(self.json.get("probes", {}))

    def __repr__(self):
        ray = f", {self.ray['class']}" if self.ray else ""
        return f"<Answer: {self.outcome}{ray}, {len(self.json['pivots'])} pivots>"


class Model:
    """A scenario that is being worked on."""

    def __init__(self):
        # a session of its own: Ctrl-C comes to Python alone, which passes it on as one interruption
        self._process = subprocess.Popen(
            [program(), "serve"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            start_new_session=os.name == "posix",
            encoding="utf-8",
        )
        self._count = 0
        # a change is solved when `solve` asks for it
        self.run("set auto off")

    def run(self, command):
        """Runs commands of the program's language and gives their report; a list of reports for several commands."""
        self._count += 1
        number = self._count
        try:
            self._process.stdin.write(json.dumps({"id": number, "command": command}) + "\n")
            self._process.stdin.flush()
        except (BrokenPipeError, ValueError):
            raise ProgramError("the program has ended") from None
        try:
            answer = self._answer(number)
        except KeyboardInterrupt:
            self._process.send_signal(signal.SIGINT)
            self._answer(number)
            raise
        if not answer["ok"]:
            raise _error(answer)
        return answer["report"]

    def _answer(self, number):
        while True:
            line = self._process.stdout.readline()
            if not line:
                raise ProgramError("the program has ended")
            answer = json.loads(line)
            if answer["id"] == number:
                return answer

    def set(self, values=None, **more):
        """Changes parameters: `set(f=0.4)`, `set({"F-2": 3})`, and rules: `set(covering="weight")`; all or none of them."""
        changes = {**(values or {}), **more}
        done = 0
        try:
            for name, value in changes.items():
                shown = repr(float(value)) if isinstance(value, (int, float)) else str(value)
                self.run(f"set {shlex.quote(name.replace('tie_break', 'tie-break'))} {shlex.quote(shown)}")
                done += 1
        except Error:
            for _ in range(done):
                self.run("undo")
            raise
        return self

    def reset(self, *names):
        """Puts parameters, or everything, back to the file."""
        for name in names or [""]:
            self.run(f"reset {shlex.quote(name)}" if name else "reset")
        return self

    @property
    def parameters(self):
        """Name → present value."""
        return {parameter["name"]: parameter["value"] for parameter in self.run("params")}

    def solve(self):
        """Solves with the present values."""
        self.run("solve")
        return self._result()

    def stages(self):
        """Follows the load history; the answer is its end, with `stages`."""
        self.run("stages")
        return self._result()

    def _result(self):
        with tempfile.TemporaryDirectory(prefix="stickslip-") as folder:
            file = Path(folder) / "result.json"
            self.export("result", file)
            return Answer(json.loads(file.read_text(encoding="utf-8")))

    def show(self, *quantities):
        """Quantities of the present answer (`help show` lists them): name → value, None where there is none."""
        return {one["quantity"]: one["value"] for one in self.run("show " + ", ".join(quantities))}

    def sweep(self, axes=None, columns=(), **more):
        """Solves over a grid: `sweep(f=(0, 1, 21))` from, to and the number of points; up to three parameters, the last
        running fastest. `columns` are quantities with columns of their own."""
        ranges = {**(axes or {}), **more}
        words = " ".join(f"{shlex.quote(name)} {float(a)!r}..{float(b)!r} {int(n)}" for name, (a, b, n) in ranges.items())
        with tempfile.TemporaryDirectory(prefix="stickslip-") as folder:
            file = Path(folder) / "sweep.json"
            option = f" --columns {shlex.quote(', '.join(columns))}" if columns else ""
            self.run(f"sweep {words}{option} --out {shlex.quote(str(file))}")
            head, *rows = file.read_text(encoding="utf-8").splitlines()
        table = Table(json.loads(row) for row in rows)
        points = json.loads(head)["points"]
        if len(table) < points:
            raise Interrupted(f"the sweep was stopped after {len(table)} of {points} points", 130)
        return table

    def export(self, what, file):
        """Writes a table, a picture, a report: `export("report", "dam.html")`, `export("path force c6", "c6.svg")`."""
        self.run(f"export {what} {shlex.quote(os.fspath(file))}")
        return self

    def close(self):
        """Ends the program."""
        if self._process.poll() is None:
            try:
                self._process.stdin.close()
                self._process.wait(timeout=5)
            except (subprocess.TimeoutExpired, BrokenPipeError):
                self._process.kill()
                self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout):
            try:
                pipe.close()
            except BrokenPipeError:
                pass

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __del__(self):
        if hasattr(self, "_process"):
            self.close()
