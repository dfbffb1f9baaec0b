"""A stand-in for softgrain that writes rows whose numbers follow from its values, and a folder to sweep it in."""

import contextlib
import csv
import io
import os
import stat
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
from pathlib import Path

from softgrain.sweep import __main__

PROGRAM = Path(__file__).resolve().parents[1] / "softgrain"

# Its stress is 100 friction + seed; friction = 7 fails, 8 is killed in the middle of a row the first time, 9 waits for a signal.
STAND_IN = f"""#!{sys.executable} -IS
import json, os, pathlib, signal, sys, time
verb, words = sys.argv[1], sys.argv[2:]
sets = dict(w[6:].split("=") for w in words if w.startswith("--set="))
friction, seed = float(sets.get("contact.friction", 0)), int(sets.get("sample.seed", 1))
if friction < 0:
    sys.exit("error: contact.friction = -1 is out of range") if verb == "run" else (
        print("contact.friction is out of range", file=sys.stderr), sys.exit(2))
if verb == "check":
    print(json.dumps({{"case": {{"contact": {{"friction": friction}}, "sample": {{"seed": seed}}}}}}))
    sys.exit()
folder = pathlib.Path(words[words.index("-o") + 1])
folder.mkdir(parents=True, exist_ok=True)
with (folder / "calls").open("a") as calls:
    calls.write(" ".join(words) + "\\n")
(folder / "case.toml").write_text(f"[contact]\\nfriction = {{friction}}\\n[sample]\\nseed = {{seed}}\\n")
if friction == 7 and not (folder.parent / "mended").exists():
    (folder / "run.json").write_text('{{"state": "failed", "message": "the grain has burst\\\\nin step 7"}}')
    sys.exit((print("the grain has burst", file=sys.stderr), 3)[1])
if friction == 9:
    stopped = []
    signal.signal(signal.SIGTERM, lambda *_: stopped.append(1))
    (folder / "run.json").write_text('{{"state": "running"}}')
    while not stopped:
        time.sleep(0.01)
    sys.exit(75)
if friction == 8 and not (folder / "series.csv").exists():
    (folder / "run.json").write_text('{{"state": "running", "progress": 0.5}}')
    (folder / "series.csv").write_text("strain,stress_top[Pa]\\n0,0\\n0.5,")
    os.kill(os.getpid(), signal.SIGKILL)
stress = 100 * friction + seed
rows = [f"{{e}},{{s}}" for e, s in ((0, 0), (0.5, 3 * stress), (1, stress))]
(folder / "series.csv").write_text("\\n".join(["strain,stress_top[Pa]", *rows, ""]))
(folder / "run.json").write_text('{{"state": "done", "wall_seconds": 10}}')
"""


class Temporary(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.program = self.folder / "softgrain"
        self.program.write_text(STAND_IN)
        self.program.chmod(stat.S_IRWXU)
        self.out = self.folder / "out"
        environment = unittest.mock.patch.dict(os.environ, {"SOFTGRAIN_PROGRAM": str(self.program)})
        environment.start()
        self.addCleanup(environment.stop)

    def words(self, *arguments, frictions="0,0.5", seeds="1..3"):
        return [str(self.folder / "case.toml"), "-o", str(self.out), f"--vary=contact.friction={frictions}",
                f"--vary=sample.seed={seeds}", *arguments]

    def sweep(self, *arguments, **values):
        """(exit code, stdout, stderr) of a sweep."""
        return self.call(*self.words(*arguments, **values))

    def call(self, *words):
        """The same of `softgrain sweep words`."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = __main__.main([str(word) for word in words])
        return code or 0, out.getvalue(), err.getvalue()

    def start(self, *arguments, before=(), **values):
        """The same as a process of its own; `before` are the words of a program that starts it."""
        return subprocess.Popen([*before, sys.executable, PROGRAM, "sweep", *self.words(*arguments, **values)],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def results(self):
        with (self.out / "results.csv").open() as file:
            return list(csv.DictReader(file))

    def calls(self, name):
        path = self.out / "runs" / name / "calls"
        return len(path.read_text().splitlines()) if path.exists() else 0
