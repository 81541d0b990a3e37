# SPDX-License-Identifier: GPL-3.0-or-later
"""experiments/harness/prepare in a made-up project, with programs that only write down how they were called."""
import os
import shutil
import subprocess
import tempfile
import unittest

PREPARE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../experiments/harness/prepare")
TOOLS = ("bash", "sh", "awk", "basename", "cat", "cksum", "cmp", "echo", "env", "find", "grep", "head", "ldd", "ls",
         "mkdir", "rm", "sed", "touch", "xargs")
PROGRAMS = {
    "c++": 'echo "c++ $(cat compiler)"',
    "clang++": "echo clang version 14",
    "cmake": '''[ "$1" != --version ] || { echo cmake version 3; exit; }
                echo "cmake $*" >>calls
                [ "$1" = --build ] || [ ! -e broken ] || { echo no such library; exit 1; }''',
    "dpkg-query": 'shift 2; for p; do grep -qxF "$p" installed && printf "%s:installed " "$p"; done; true',
    "apt-get": 'echo "apt-get $*" >>calls',
    "id": "cat user"}
LISTS = {"packages.txt": "# all\ng++  # build\nlibx-dev  # build: because\nplotter  # figures\n",
         "packages-tests.txt": "gtest  # tests\nbenchmark  # bench\n"}


class Prepare(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="ein Käse ")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        for name, text in {**LISTS, "CMakeLists.txt": "", "CMakePresets.json": "", "tests/CMakeLists.txt": "",
                           "experiments/CMakeLists.txt": "", "experiments/one.cpp": "",
                           "experiments/harness/grid.hpp": "", "solver/mesh.cpp": "", "compiler": "12", "user": "0"}.items():
            self.write(name, text)
        self.write("installed", "g++\nlibx-dev\nplotter\ngtest\nbenchmark\n")
        for name, text in PROGRAMS.items():
            self.write(f"bin/{name}", f"#!/bin/sh\n{text}\n")
            os.chmod(self.path(f"bin/{name}"), 0o755)
        for name in TOOLS:
            os.symlink(shutil.which(name), self.path(f"bin/{name}"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)

    def calls(self, *arguments, fails=False, **environment):
        """How cmake and apt-get were called, and what was said."""
        self.write("calls", "")
        done = subprocess.run([self.path("bin/bash"), PREPARE, *arguments], cwd=self.folder, capture_output=True,
                              text=True, check=False, env={"PATH": self.path("bin"), **environment})
        self.assertEqual(done.returncode, 1 if fails else 0, done.stdout + done.stderr)
        with open(self.path("calls"), encoding="utf-8") as file:
            return file.read(), done.stdout + done.stderr

    def configures(self, *arguments, **environment):
        return "--preset" in self.calls("configure", "build", *arguments, **environment)[0]

    def test_a_goal_asks_for_its_own_packages(self):
        self.write("installed", "")
        for kinds, wanted in (("build", "g++ libx-dev"), ("build figures", "g++ libx-dev plotter"),
                              ("bench", "benchmark")):
            self.assertTrue(self.calls("deps", kinds)[0].endswith(f"--no-install-recommends {wanted}\n"), kinds)
        self.assertNotIn("g++", self.calls("deps", "build", CXX="clang++")[0])
        self.write("installed", "g++\nlibx-dev\n")
        self.assertEqual(self.calls("deps", "build")[0], "")

    def test_without_root_and_sudo_it_says_what_is_missing(self):
        self.write("user", "1000")
        self.write("installed", "g++\n")
        calls, said = self.calls("build", "build", "one", fails=True)
        self.assertEqual(calls, "")
        self.assertIn("missing: libx-dev; neither root nor sudo", said)

    def test_configures_again_after_a_failure_and_when_something_has_changed(self):
        self.write("broken", "")
        for _ in range(2):
            calls, said = self.calls("configure", "build", fails=True)
            self.assertIn("--preset", calls)
            self.assertIn("no such library", said)
        os.remove(self.path("broken"))
        self.assertTrue(self.configures())
        self.assertFalse(self.configures())
        for name, text in (("CMakeLists.txt", "x"), ("tests/CMakeLists.txt", "x"), ("experiments/two.cpp", "")):
            self.write(name, text)
            self.assertTrue(self.configures(), name)
            self.assertFalse(self.configures(), name)
        for environment in ({"CXX": "clang++"}, {"CMAKE_GENERATOR": "Ninja"}, {"OPTIONS": "-DA=B"}, {"CXXFLAGS": "-g"}):
            self.assertTrue(self.configures(**environment), environment)
            self.assertFalse(self.configures(**environment), environment)

    def test_another_compiler_does_not_use_objects_of_the_last_one(self):
        self.configures()
        self.write("build/CMakeFiles/one.dir/one.o", "")
        self.configures(OPTIONS="-DA=B")
        self.assertTrue(os.path.exists(self.path("build/CMakeFiles/one.dir/one.o")))
        self.write("compiler", "13")
        self.assertTrue(self.configures(OPTIONS="-DA=B"))
        self.assertFalse(os.path.exists(self.path("build/CMakeFiles")))

    def test_tests_are_configured_when_needed_and_stay_while_their_packages_do(self):
        self.assertIn("-DESFEM_BUILD_TESTS=OFF -DESFEM_BUILD_BENCHMARKS=OFF", self.calls("configure", "build")[0])
        self.assertIn("-DESFEM_BUILD_TESTS=ON -DESFEM_BUILD_BENCHMARKS=OFF", self.calls("configure", "build tests")[0])
        self.assertFalse(self.configures())
        self.write("installed", "g++\nlibx-dev\n")
        self.assertIn("-DESFEM_BUILD_TESTS=OFF", self.calls("configure", "build")[0])

    def test_what_is_built_runs_although_a_package_has_gone(self):
        self.assertIn("--build build -j1 --target one", self.calls("build", "build figures", "one")[0])
        self.write("build/bin/one", "")
        os.chmod(self.path("build/bin/one"), 0o755)
        self.write("installed", "plotter\n")
        for targets in ("one", "experiments"):
            calls, said = self.calls("build", "build figures", targets)
            self.assertEqual((calls, said), ("", f"== built already: {targets}\n"))
        self.write("installed", "")
        self.assertTrue(self.calls("build", "build figures", "one")[0].endswith("recommends plotter\n"))
        os.utime(self.path("solver/mesh.cpp"), (2e9, 2e9))
        self.assertIn("recommends g++ libx-dev plotter", self.calls("build", "build figures", "one")[0])


if __name__ == "__main__":
    unittest.main()
