"""The client against the program: python -m unittest, with the wheel installed or STICKSLIP set."""

import gc
import json
import math
import os
import signal
import subprocess
import tempfile
import threading
import unittest
from pathlib import Path

import stickslip

try:
    import numpy
except ImportError:
    numpy = None
try:
    import meshio
except ImportError:
    meshio = None


class Client(unittest.TestCase):
    def setUp(self):
        self.model = stickslip.open("beam")
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.addCleanup(self.model.close)

    def test_pairs_are_columns(self):
        # six supports hold at most f F = 40 each: 240, and 220 are pulled
        answer = self.model.set(f=0.4, F2=220).solve()
        self.assertEqual((answer.outcome, answer.is_answer), ("normal", True))
        pairs = answer.pairs
        self.assertEqual(len(pairs), 6)
        self.assertAlmostEqual(sum(pairs["x_t"]), -220.0, places=9)
        self.assertEqual(list(pairs.id), [f"c{i}" for i in range(1, 7)])
        self.assertEqual(answer.parameters["f"], 0.4)
        if numpy is not None:
            self.assertIsInstance(pairs.x_n, numpy.ndarray)
            self.assertTrue((abs(pairs.x_t) <= 40 + 1e-9).all())
            self.assertEqual(pairs.position.shape, (6, 2))
        with self.assertRaises(AttributeError):
            pairs.no_such

    def test_a_ray_is_an_answer_of_its_own_kind(self):
        answer = self.model.set(f=0.3).solve()
        self.assertEqual((answer.outcome, answer.ray["class"]), ("ray", "mechanism"))
        self.assertFalse(answer.is_answer)
        with self.assertRaises(AttributeError):
            answer.displacements

    def test_the_result_is_that_of_the_shell(self):
        shell = subprocess.run([stickslip.program(), "solve", "beam", "--set", "f=0.6", "--format", "json"],
                               capture_output=True, check=True, encoding="utf-8")
        self.assertEqual(self.model.set(f=0.6).solve().json, json.loads(shell.stdout))

    def test_a_sweep_is_a_table(self):
        table = self.model.sweep(f=(0, 1, 5), columns=["x_t c6"])
        self.assertEqual(list(table["f"]), [0.0, 0.25, 0.5, 0.75, 1.0])
        self.assertEqual(list(table["outcome"]), ["ray", "ray", "normal", "normal", "normal"])
        self.assertAlmostEqual(table["x_t c6"][2], -50.0, places=9)
        two = self.model.sweep(f=(0.5, 0.5, 1), F2=(0, 10, 2))
        self.assertEqual(two.rows()[1]["F2"], 10.0)

    def test_quantities_and_exports(self):
        self.model.solve()
        self.assertAlmostEqual(self.model.show("x_n c1", "sum x_t *")["sum x_t *"], -250.0, places=9)
        report = Path(self.folder.name) / "it's a report.html"
        self.model.export("report", report)
        self.assertIn("<svg", report.read_text(encoding="utf-8"))

    def test_errors_have_types(self):
        for command, kind, status in [
            ("piars", stickslip.CommandError, 2),
            ("set f x", stickslip.CommandError, 2),
            ("solve; expect p = 5", stickslip.ExpectationFailed, 1),
        ]:
            with self.assertRaises(kind) as caught:
                self.model.run(command)
            self.assertEqual(caught.exception.status, status)
        with self.assertRaises(stickslip.CommandError):
            self.model.set(f=0.9, no_such=1)
        # all or none
        self.assertEqual(self.model.parameters["f"], 0.5)
        bad = Path(self.folder.name) / "bad.json"
        bad.write_text('{\n"format": "stickslip/1", "title": "t",\n"lcp": {"M": [[1]], "q": [1, 2]}}\n', encoding="utf-8")
        with self.assertRaises(stickslip.ScenarioError) as caught:
            stickslip.open(bad)
        self.assertEqual(caught.exception.problems[0].line, 3)
        self.assertIsInstance(caught.exception, stickslip.CommandError)
        with self.assertRaises(stickslip.ScenarioError):
            stickslip.open("no such file.json")

    def test_one_that_has_ended_says_so(self):
        self.model.run("quit")
        self.model._process.wait()
        with self.assertRaises(stickslip.ProgramError):
            self.model.run("status")

    def test_nothing_is_left_running(self):
        model = stickslip.open("beam")
        process = model._process
        del model
        gc.collect()
        self.assertIsNotNone(process.poll())

    @unittest.skipIf(os.name != "posix", "signals of POSIX")
    def test_ctrl_c_stops_the_command_and_leaves_the_session(self):
        # A job in the background starts with SIGINT ignored.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        rows = Path(self.folder.name) / "rows.csv"
        with self.assertRaises(KeyboardInterrupt):
            self.model.run(f"sweep F2 0..400 1000000 --out '{rows}'")
        self.assertTrue(self.model.solve().is_answer)

    def test_a_history_has_its_stages(self):
        file = Path(self.folder.name) / "slider.json"
        file.write_text(json.dumps({
            "format": "stickslip/1", "title": "slider", "nodes": {"A": [0, 0], "B": [1, 0]},
            "materials": {"m": {"E": 1, "nu": 0}}, "sections": {"s": {"area": 1}},
            "bars": [{"id": "AB", "nodes": ["A", "B"], "kind": "truss", "material": "m", "section": "s"}],
            "supports": [{"at": "A", "fixed": ["x", "y"]}],
            "contacts": [{"id": "c", "node": "B", "against": "ground", "normal": [0, 1], "friction": 0.5}],
            "loads": {"weight": {"items": [{"point": {"at": "B", "force": [0, -2]}}]},
                      "pull": {"items": [{"point": {"at": "B", "force": [3, 0]}}]}},
            "stages": [{"weight": 1}, {"weight": 1, "pull": 1}, {"weight": 1}],
        }), encoding="utf-8")
        with stickslip.open(file) as slider:
            # pulled by 3 against f N = 1: the bar of EA/L = 1 takes 2 and stretches by 2; let go, it stays at 1
            answer = slider.stages()
            slips = [stage["pairs"][0]["z_t"] for stage in answer.json["stages"]]
            self.assertTrue(all(math.isclose(a, b, abs_tol=1e-12) for a, b in zip(slips, [0, 2, 1])), slips)
            self.assertEqual(len(answer.stages), 3)

    @unittest.skipIf(meshio is None, "meshio is not there")
    def test_meshio_reads_the_mesh(self):
        file = Path(self.folder.name) / "plates.vtu"
        with stickslip.open("plates-hinged") as plates:
            answer = plates.solve()
            plates.export("vtu", file)
        mesh = meshio.read(file)
        displacements = answer.displacements
        count = len(displacements)
        self.assertEqual(len(mesh.points), count + len(answer.pairs))
        self.assertTrue((mesh.point_data["displacement"][:count, 0] == displacements["ux"]).all())
        self.assertEqual({block.type: len(block.data) for block in mesh.cells}, {"quad": 256, "vertex": 16})
        resultant = answer.resultants.rows()[0]
        force = mesh.point_data["contact_force"].sum(axis=0)
        self.assertAlmostEqual(force[1], resultant["N"], places=9)
        self.assertAlmostEqual(force[0], resultant["T"], places=9)


if __name__ == "__main__":
    unittest.main()
