#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends runs at random moments (signal 9), cuts checkpoints, fills a disk and takes away the right to write; then looks at
what is left and what comes of it. After the restart all numbers must be those of an undisturbed run, bit for bit.

    tests/crash/crash.py [--kills N] [--cuts N] [--seed N] [--build DIR] [PART ...]

Parts: evolve, cell, make (kills), cut, disk, folder. The last two mount a small tmpfs, which needs root; they are skipped
where that does not work. Exit code 0 when everything holds, 1 otherwise."""
import argparse
import contextlib
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
SPHERE = {"surface": {"name": "sphere"}, "mesh": {"subdivisions": 1}}
ELLIPSOID = {"surface": {"name": "ellipsoid"}, "mesh": {"subdivisions": 1}}
RUNS = {
    "equal steps": {**SPHERE, "flow": "mean_curvature", "bdf": 3, "tau": 1e-3, "steps": 150, "start": "substeps:4"},
    "adaptive steps": {**ELLIPSOID, "flow": "mean_curvature", "adaptive": {"end_time": 0.05, "tolerance": 1e-4}},
    "factors for several steps": {**ELLIPSOID, "flow": "willmore", "adaptive": {"end_time": 0.02, "tolerance": 1e-4}},
    "one step": {**ELLIPSOID, "flow": "bgn", "degree": 1, "adaptive": {"end_time": 0.05}},
    "given motion": {**SPHERE, "flow": "cahn_hilliard", "bdf": 2, "tau": 1e-3, "steps": 100, "variant": {"theta": True}},
    "coupled": {**SPHERE, "flow": "coupled_diffusion", "problem": "tumour_growth", "bdf": 2, "tau": 1e-3, "steps": 100},
    "phases": {**ELLIPSOID, "flow": "cahn_hilliard", "problem": "phase_separation", "bdf": 1, "tau": 0.01, "steps": 100},
}
FILES = {"nodal": "end.json", "series": "series.json", "vtu": "run.pvd", "every": 7, "checkpoint": "run.checkpoint"}


class Failure(Exception):
    """Something does not hold."""


class Skipped(Exception):
    """This machine does not let it be tried."""


def expect(holds, what):
    if not holds:
        raise Failure(what)


def content(path):
    return path.read_bytes() if path.is_file() else None


def temporary_files(folder):
    return sorted(str(f.relative_to(folder)) for f in folder.rglob(".*.tmp"))


def wait_for_group(group):
    """Until the last killed process of a group is gone."""
    for _ in range(500):
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return
        time.sleep(0.01)


def snapshots(folder):
    return {str(f.relative_to(folder)): content(f) for f in sorted(folder.rglob("*.vtu")) + sorted(folder.rglob("*.pvd"))}


class Crash:
    def __init__(self, asked):
        self.kills, self.cuts, self.build = asked.kills, asked.cuts, pathlib.Path(asked.build).resolve()
        self.random = random.Random(asked.seed)
        self.evolve = str(self.build / "bin/evolve")
        # At each step, so that a process is often killed while it writes one.
        self.environment = {**os.environ, "ESFEM_CHECKPOINT_SECONDS": "0"}
        self.done = 0

    def run(self, command, folder, moment=None, **more):
        """The exit code, or None when it was killed at this moment, in seconds."""
        process = subprocess.Popen(command, cwd=folder, env={**self.environment, **more}, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True, text=True)
        try:
            self.said = process.communicate(timeout=moment)[1]
            return process.returncode
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            self.said = process.communicate()[1]
            wait_for_group(process.pid)
            self.done += 1
            return None

    def run_through(self, command, folder, longest, kills, **more):
        """Kills the command and starts it again until it comes to its end, with at most so many kills."""
        while True:
            moment = self.random.uniform(0, longest) if kills > 0 else None
            code = self.run(command, folder, moment, **more)
            if code is not None:
                expect(code == 0, f"exit code {code} of {' '.join(command)}: {self.said}")
                return
            kills -= 1

    # ---- evolve

    def configure(self, folder, config, output=FILES):
        (folder / "config.json").write_text(json.dumps({**config, "output": output}))

    def evolve_in(self, folder, *more, **rest):
        return self.run([self.evolve, "config.json"], folder, *more, **rest)

    def results(self, folder):
        numbers = [json.loads(content(folder / FILES[key])) for key in ("series", "nodal")]
        for file in numbers:
            del file["provenance"]
            del file["config"]
        return numbers, snapshots(folder)

    def undisturbed(self, folder, config):
        folder.mkdir()
        self.configure(folder, config)
        start = time.monotonic()
        expect(self.evolve_in(folder) == 0, self.said)
        seconds = time.monotonic() - start
        with_checkpoint = self.results(folder)
        shutil.rmtree(folder)
        folder.mkdir()
        self.configure(folder, config, {key: value for key, value in FILES.items() if key != "checkpoint"})
        expect(self.evolve_in(folder) == 0, self.said)
        expected = self.results(folder)
        # Snapshots say what the configuration was.
        expect(with_checkpoint[0] == expected[0], "a checkpoint changes the numbers")
        return with_checkpoint, seconds

    def part_evolve(self, folder):
        names = list(RUNS)
        expected = {}
        while self.done < self.kills:
            name = names[len(expected)] if len(expected) < len(names) else self.random.choice(names)
            config, place = RUNS[name], folder / "run"
            if name not in expected:
                expected[name] = self.undisturbed(folder / "whole", config)
                shutil.rmtree(folder / "whole")
            numbers, seconds = expected[name]
            place.mkdir()
            self.configure(place, config)
            self.run_through([self.evolve, "config.json"], place, 0.5 * seconds, min(10, self.kills - self.done))
            expect(self.results(place) == numbers, f"{name}: other numbers after the restart")
            expect(not temporary_files(place), f"{name}: {temporary_files(place)} are left")
            shutil.rmtree(place)
        return f"{self.done} kills of {len(expected)} kinds of runs"

    # ---- experiments

    def rows(self, table):
        rows = json.loads(content(table))["rows"]
        for row in rows:
            for key in ("seconds", "peak_memory_mb"):
                row.pop(key)
        return rows

    def part_cell(self, folder):
        stem = str(self.build / "bin/surface_diffusion")
        listed = subprocess.run([stem, "--list", "--preset", "check"], capture_output=True, text=True, check=True).stdout
        cells = [line.split()[0] for line in listed.splitlines()][-3:]
        commands = {cell: [stem, "--preset", "check", "--cell", cell, "--output", f"{cell}.json"] for cell in cells}
        expected, seconds = {}, {}
        for cell, command in commands.items():
            (folder / "whole").mkdir()
            start = time.monotonic()
            expect(self.run(command, folder / "whole") == 0, self.said)
            seconds[cell] = time.monotonic() - start
            expected[cell] = self.rows(folder / "whole" / f"{cell}.json"), snapshots(folder / "whole")
            shutil.rmtree(folder / "whole")
        while self.done < self.kills:
            cell = self.random.choice(cells)
            place = folder / "run"
            place.mkdir()
            self.run_through(commands[cell], place, 0.5 * seconds[cell], min(10, self.kills - self.done))
            expect((self.rows(place / f"{cell}.json"), snapshots(place)) == expected[cell], f"{cell}: other numbers")
            expect(not (place / cell / "checkpoint").exists(), f"{cell}: its checkpoint is left")
            expect(not temporary_files(place), f"{cell}: {temporary_files(place)} are left")
            shutil.rmtree(place)
        return f"{self.done} kills of {len(cells)} cells"

    def tree(self, folder):
        """A project whose results and figures are its own."""
        folder.mkdir()
        for name in ("Makefile", "experiments", "plots", "reference", "solver", "tests", "bench"):
            (folder / name).symlink_to(ROOT / name)
        (folder / "build").mkdir()
        (folder / "build/bin").symlink_to(self.build / "bin")
        return folder

    def part_make(self, folder):
        command = ["make", "-j2", "plots-check", "BUILD=build", "stems=surface_diffusion"]
        inside = {"MAKELEVEL": "1", "MAKEFLAGS": ""}  # nothing is built

        def tables(place):
            drawn = sorted(f.name for f in (place / "build/figures-check").rglob("*.*") if f.suffix in (".pdf", ".png"))
            return self.rows(place / "results/check/surface_diffusion.json"), snapshots(place / "results"), drawn

        whole = self.tree(folder / "whole")
        start = time.monotonic()
        expect(self.run(command, whole, **inside) == 0, self.said)
        seconds = time.monotonic() - start
        expected = tables(whole)
        expect(expected[2], "nothing is drawn")
        while self.done < self.kills:
            place = self.tree(folder / "run")
            self.run_through(command, place, 0.5 * seconds, min(10, self.kills - self.done), **inside)
            expect(tables(place) == expected, "other numbers after the restart")
            expect(not temporary_files(place / "results"), f"{temporary_files(place / 'results')} are left")
            shutil.rmtree(place)
        return f"{self.done} kills of make figures"

    # ---- damaged files, full disks, folders that cannot be written

    def refused(self, folder, words, code=1):
        """The run ends with this code and one line that has these words."""
        found = self.evolve_in(folder)
        expect(found == code, f"exit code {found}, {code} expected: {self.said}")
        lines = [line for line in self.said.splitlines() if "resumes from this checkpoint" not in line]
        expect(len(lines) == 1, f"one line expected: {self.said}")
        expect(all(word in lines[0] for word in words), f"{words} expected: {lines[0]}")

    def part_cut(self, folder):
        self.configure(folder, {**RUNS["equal steps"], "mesh": {"subdivisions": 0}, "degree": 1, "steps": 5})
        expect(self.evolve_in(folder) == 0, self.said)
        checkpoint = folder / FILES["checkpoint"]
        good, size = content(checkpoint), len(content(checkpoint))
        before = self.results(folder)
        step = max(1, (size - 400) // self.cuts) if self.cuts else size
        ends = range(200) if self.cuts else range(0, 200, 50)
        lengths = sorted({*ends, *range(200, size - 200, step), *(size - 1 - i for i in ends)})
        bad = [good[:length] for length in lengths]
        for place in sorted({0, 15, 16, size - 1, *(self.random.randrange(size) for _ in range(20))}):
            bad.append(good[:place] + bytes([good[place] ^ 1 << self.random.randrange(8)]) + good[place + 1:])
        for damaged in bad:
            checkpoint.write_bytes(damaged)
            self.refused(folder, ["run.checkpoint", "damaged", "remove it"])
            expect(content(checkpoint) == damaged, "the damaged file is not left as it is")
            expect(self.results(folder) == before, "a refused run has written something")
        checkpoint.write_bytes(good)
        expect(self.evolve_in(folder) == 0 and "resumes from" in self.said, "the good file is not taken any more")
        return f"{len(lengths)} cuts of {size} bytes, {len(bad) - len(lengths)} flipped bits"

    def part_disk(self, folder):
        config = {**RUNS["equal steps"], "steps": 60}
        numbers, _ = self.undisturbed(folder / "whole", config)
        shutil.rmtree(folder / "whole")
        count, codes = 0, []
        with small_disk(folder / "disk") as disk:
            need = self.space_of_run(disk, config)
            for tenth in range(16):
                self.configure(disk, config)
                free = shutil.disk_usage(disk).free
                (disk / "filler").write_bytes(bytes(max(0, free - need * tenth // 10)))
                code = self.evolve_in(disk)
                codes.append(code)
                if code != 0:
                    count += 1
                    lines = [line for line in self.said.splitlines() if "resumes from this" not in line]
                    expect(code == 1 and len(lines) == 1 and "No space left" in lines[0], f"exit code {code}: {self.said}")
                (disk / "filler").unlink()
                expect(not temporary_files(disk), f"{temporary_files(disk)} are left")
                expect(self.evolve_in(disk) == 0, f"with space again: {self.said}")
                expect(self.results(disk) == numbers, "other numbers after a full disk")
                for file in disk.iterdir():
                    file.unlink()
        expect(0 < count < len(codes), f"full and not full disks expected, exit codes {codes}")
        return f"{count} full disks"

    def space_of_run(self, disk, config):
        self.configure(disk, config)
        before = shutil.disk_usage(disk).free
        expect(self.evolve_in(disk) == 0, self.said)
        used = before - shutil.disk_usage(disk).free
        for file in disk.iterdir():
            file.unlink()
        return used

    def part_folder(self, folder):
        config = {**RUNS["equal steps"], "steps": 100000000}
        with small_disk(folder / "disk") as disk:
            (disk / "old.pvd").write_text("somebody's")
            subprocess.run(["mount", "-o", "remount,ro", disk], check=True)
            for key in ("nodal", "series", "checkpoint", "vtu"):
                for name in ("new.pvd", "old.pvd", "new/folder/run.pvd"):
                    self.configure(folder, config, {key: str(disk / name)})
                    self.refused(folder, [str(disk), "Read-only file system"])
            expect(content(disk / "old.pvd") == b"somebody's", "a file has changed")
        return "12 outputs on a read-only file system"


@contextlib.contextmanager
def small_disk(folder):
    """A file system of 4 MB that is there as long as the context."""
    folder.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=4m", "tmpfs", folder], capture_output=True, text=True)
    if mounted.returncode != 0:
        raise Skipped(mounted.stderr.strip() or "no tmpfs can be mounted")
    try:
        yield folder
    finally:
        subprocess.run(["umount", folder], check=True)


def main():
    parts = {name[5:]: part for name, part in vars(Crash).items() if name.startswith("part_")}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help=" ".join(parts))
    parser.add_argument("--kills", type=int, default=200, help="of each part that kills (default 200)")
    parser.add_argument("--cuts", type=int, default=200, help="of the middle of a checkpoint, beside each of the first and "
                        "last 200 bytes (default 200; 0: a few in all)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--build", default=ROOT / "build")
    asked = parser.parse_args()
    unknown = sorted(set(asked.parts) - set(parts))
    if unknown:
        parser.error(f"unknown part {unknown[0]}; parts are {' '.join(parts)}")
    failed = False
    for name in asked.parts or parts:
        crash, start = Crash(asked), time.monotonic()
        with tempfile.TemporaryDirectory(prefix="esfem_crash_") as folder:
            try:
                outcome = parts[name](crash, pathlib.Path(folder))
            except Skipped as why:
                outcome = f"skipped: {why}"
            except Failure as why:
                outcome, failed = f"FAILED after {crash.done} kills: {why}", True
        print(f"crash {name}: {outcome}, {time.monotonic() - start:.0f} s", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
