# SPDX-License-Identifier: GPL-3.0-or-later
"""tests/samples/run_samples.py with a made-up project, whose evolve writes given values."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "run_samples.py")
EVOLVE = f"#!{sys.executable}\n" + '''import json, sys
output = json.load(open(sys.argv[1]))["output"]
if "fails" in output["series"]:
    sys.exit("evolve: fails.json: no such flow")
json.dump({"status": "ok", "t": [0, 0.5, 1.0], "area": [4.0, 3.0, 2.5],
           "helfrich_energy": [6.0, 5.5, 5.0]}, open(output["series"], "w"))
json.dump({"u": [1, 7, 3]}, open(output["nodal"], "w"))
'''
RIGHT = {"t": 1.0, "steps": 2, "area": 2.5, "helfrich_energy": 5.0, "max_u": 7}


class RunSamples(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.write("build/bin/evolve", EVOLVE)
        os.chmod(os.path.join(self.folder, "build/bin/evolve"), 0o755)
        self.example("one")

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def example(self, name):
        self.write(f"reference/examples/{name}.json", json.dumps({"flow": "f", "output": {"series": f"build/{name}.json"}}))

    def outcome(self, expected):
        self.write("reference/examples/expected.json", json.dumps(expected))
        done = subprocess.run([sys.executable, SCRIPT, "--build", "build"], cwd=self.folder, capture_output=True, text=True,
                              check=False)
        return done.returncode, done.stdout + done.stderr

    def test_values_as_expected(self):
        code, said = self.outcome({"one": RIGHT})
        self.assertEqual(code, 0, said)
        self.assertIn("as expected: t 1, steps 2, area 2.5, helfrich_energy 5, max_u 7", said)

    def test_each_value_that_differs_is_an_error(self):
        for name, value in RIGHT.items():
            code, said = self.outcome({"one": {**RIGHT, name: 1.00001 * value}})
            self.assertEqual(code, 1)
            self.assertIn(f"{name}: found {value:g}, expected {1.00001 * value:g}"[:20], said)
            self.assertEqual(self.outcome({"one": {**RIGHT, name: 1.00001 * value, "tolerance": 1e-4}})[0], 0)

    def test_a_failed_run_and_a_missing_entry_are_errors(self):
        self.assertIn("no entry in", self.outcome({})[1])
        self.example("fails")
        code, said = self.outcome({"one": RIGHT})
        self.assertEqual(code, 1)
        self.assertIn("fails: 0 s of CPU time, exit code 1: evolve: fails.json: no such flow", said)
        self.assertIn("samples FAILED: fails", said)


if __name__ == "__main__":
    unittest.main()
