# SPDX-License-Identifier: GPL-3.0-or-later
"""The check of the package lists on small made-up inputs; `make packages-check` runs it on what was really read."""
import json
import os
import tempfile
import unittest
import unittest.mock

from check_packages import (RUNS, TESTS, Read, check, compiled, dependencies_in, linked, list_of, names_in,
                            ninja_dependencies_in, packages_read, source_of, steps_to, traced, without)

LISTS = {RUNS: ["g++", "libceres-dev", "libeigen3-dev"], TESTS: ["libgtest-dev", "libgmock-dev"]}
# What a package brings besides itself.
BRINGS = {"libceres-dev": {"libeigen3-dev"}, "g++": {"g++-12"}}
FOUND = {("g++-12", RUNS): Read("/usr/bin/g++-12", "cmake", RUNS, False),
         ("libceres-dev", RUNS): Read("/usr/include/ceres/ceres.h", "the compiler for fit_orders.cpp.o", RUNS, True),
         ("libgtest-dev", TESTS): Read("/usr/include/gtest/gtest.h", "the compiler for test_bdf.cpp.o", TESTS, True),
         ("libgmock-dev", TESTS): Read("/usr/include/gmock/gmock.h", "the compiler for test_grid.cpp.o", TESTS, True)}


class FakeApt:
    def closure(self, packages):
        return set(packages).union({"libc6"}, *(BRINGS.get(package, ()) for package in packages))

    def reachable(self, packages):
        """More than the closure: GoogleTest's packages are alternatives of something that g++ depends on."""
        return self.closure(packages) | ({"libgtest-dev"} if "g++" in packages else set())


class Verdicts(unittest.TestCase):
    def test_complete_lists_pass(self):
        self.assertEqual(check(FOUND, LISTS, FakeApt()), [])

    def test_a_package_that_is_missing_is_named_with_a_file_and_its_reader(self):
        lists = {RUNS: LISTS[RUNS], TESTS: ["libgtest-dev"]}
        self.assertEqual(check(FOUND, lists, FakeApt()),
                         ["/usr/include/gmock/gmock.h, read by the compiler for test_grid.cpp.o, belongs to "
                          "libgmock-dev, which nothing in packages-tests.txt (or packages.txt) brings: list it there"])

    def test_a_test_library_that_the_experiments_read_is_a_fault(self):
        leak = {("libgtest-dev", RUNS): Read("/usr/include/gtest/gtest.h", "the compiler for grid.cpp.o", RUNS, True)}
        self.assertIn("nothing in packages.txt brings", check({**FOUND, **leak}, LISTS, FakeApt())[0])

    def test_a_file_of_no_package_is_a_fault(self):
        stray = {("", RUNS): Read("/usr/local/include/ceres/ceres.h", "the compiler for grid.cpp.o", RUNS, True)}
        self.assertIn("belongs to no package", check({**FOUND, **stray}, LISTS, FakeApt())[0])

    def test_each_package_is_brought_by_another_or_missed_or_superfluous(self):
        self.assertEqual(without("libeigen3-dev", FOUND, LISTS, FakeApt())[0], "implied")
        for package in ("libgmock-dev", "libgtest-dev", "libceres-dev"):
            kind, sentence = without(package, FOUND, LISTS, FakeApt())
            self.assertEqual(kind, "missed")
            self.assertIn(f"belongs to {package}, which nothing in", sentence)
        self.assertEqual(without("g++", FOUND, LISTS, FakeApt())[0], "missed")
        lists = {RUNS: LISTS[RUNS], TESTS: [*LISTS[TESTS], "cowsay"]}
        kind, sentence = without("cowsay", FOUND, lists, FakeApt())
        self.assertEqual(kind, "superfluous")
        self.assertIn("remove it", sentence)


class Readers(unittest.TestCase):
    def test_lists(self):
        self.assertEqual(names_in("# why\ng++  # build: all\n\nmake\n"), ["g++", "make"])

    def test_dependency_files(self):
        self.assertEqual(dependencies_in("a.o: b.cpp \\\n /usr/include/c.hpp \\\n /a\\ b/d.hpp\n"),
                         ["b.cpp", "/usr/include/c.hpp", "/a b/d.hpp"])
        self.assertEqual(list(ninja_dependencies_in("tests/a.o: #deps 2, deps mtime 1 (VALID)\n    /x.h\n    y.h\n\n")),
                         [("tests/a.o", "/x.h"), ("tests/a.o", "y.h")])
        self.assertEqual([list_of(target) for target in ("tests/CMakeFiles/a.o", "bench/a.o", "CMakeFiles/a.o")],
                         [TESTS, TESTS, RUNS])

    def test_objects_of_former_sources_do_not_count(self):
        with tempfile.TemporaryDirectory() as build:
            os.makedirs(os.path.join(build, "tests"))
            for name in ("new.cpp.o", "left_over.cpp.o"):
                with open(os.path.join(build, f"tests/{name}.d"), "w", encoding="utf-8") as file:
                    file.write(f"{name}: \\\n /usr/include/of_{name}.h\n")
            with open(os.path.join(build, "compile_commands.json"), "w", encoding="utf-8") as file:
                json.dump([{"directory": f"{build}/tests", "command": "c++ -o new.cpp.o -c /new.cpp"}], file)
            self.assertEqual(list(compiled(build)),
                             [Read("/usr/include/of_new.cpp.o.h", "the compiler for new.cpp.o", TESTS, True)])

    def test_link_commands(self):
        with tempfile.TemporaryDirectory() as build:
            for target, library in (("x", "/usr/lib/libceres.so.3.2"), ("left_over", "/usr/lib/libold.so")):
                os.makedirs(os.path.join(build, f"tests/{target}.dir"))
                with open(os.path.join(build, f"tests/{target}.dir/link.txt"), "w", encoding="utf-8") as file:
                    file.write(f"c++ a.o -o ../bin/test_{target} ../libesfem.a /usr/lib/libgmock.a {library} -lm\n")
            os.makedirs(os.path.join(build, "CMakeFiles"))
            with open(os.path.join(build, "CMakeFiles/TargetDirectories.txt"), "w", encoding="utf-8") as file:
                file.write(f"{build}/tests/x.dir\n{build}/tests/no_program.dir\n")
            self.assertEqual([(read.path, read.reader, read.list) for read in linked(build)],
                             [("/usr/lib/libgmock.a", "the linker for test_x", TESTS),
                              ("/usr/lib/libceres.so.3.2", "the linker for test_x", TESTS)])

    def test_traces(self):
        lines = ['7 execve("/usr/bin/python3", [""...], 0x1 /* 9 vars */) = 0\n',
                 '7 openat(AT_FDCWD, "/usr/lib/python3/numpy.py", O_RDONLY|O_CLOEXEC) = 3\n',
                 '7 openat(AT_FDCWD, "/usr/share/fonts/a.ttf", O_RDONLY) = 3\n',
                 '7 openat(AT_FDCWD, "/usr/share/fontconfig/conf.avail/a.conf", O_RDONLY|O_CLOEXEC) = 3\n',
                 '7 execve("/lib/ld-linux.so.2", [""...], 0x1 /* 9 vars */) = 0\n',
                 '7 execve("/lib64/ld-linux-x86-64.so.2", [""...], 0x1 /* 9 vars */) = 0\n', "7 +++ exited with 0 +++\n",
                 '8 execve("/usr/lib/gcc/cc1plus", [""...], 0x1 /* 9 vars */) = 0\n',
                 '8 openat(AT_FDCWD, "/usr/include/optional.h", O_RDONLY|O_NOCTTY) = 4\n']
        reader = "python3 in `make test-plots`"
        self.assertEqual([(read.path, read.reader) for read in traced(lines, "test-plots")],
                         [("/usr/bin/python3", reader), ("/usr/lib/python3/numpy.py", reader),
                          ("/usr/lib/gcc/cc1plus", "cc1plus in `make test-plots`")])

    def test_compiled_python_is_its_source(self):
        self.assertEqual(source_of("/usr/lib/python3/a/__pycache__/b.cpython-311.opt-1.pyc"), "/usr/lib/python3/a/b.py")
        self.assertEqual(source_of("/usr/lib/python3/a/b.py"), "/usr/lib/python3/a/b.py")

    def test_links_count_but_those_of_alternatives(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = os.path.realpath(folder)
            place = os.path.join(folder, "libx.so.1.0")
            with open(place, "w", encoding="utf-8"):
                pass
            link, alternative = os.path.join(folder, "libx.so"), os.path.join(folder, "cc")
            os.symlink("libx.so.1.0", link)
            os.symlink("/etc/alternatives/nothing-of-this-name", alternative)
            self.assertEqual(steps_to(link), [place, link])
            self.assertEqual(steps_to(alternative), ["/etc/alternatives/nothing-of-this-name"])

    @unittest.mock.patch("check_packages.NOBODYS", ("/proc/",))
    def test_what_the_compiler_reads_must_have_a_package_but_in_the_project(self):
        with tempfile.TemporaryDirectory() as folder:
            stray = os.path.join(os.path.realpath(folder), "stray.h")
            with open(stray, "w", encoding="utf-8"):
                pass
            notes = []
            self.assertEqual(packages_read([Read(stray, "c++", RUNS, True)], [os.path.realpath(folder)], notes), {})
            self.assertEqual(list(packages_read([Read(stray, "c++", RUNS, True)], [], notes)), [("", RUNS)])
            with tempfile.TemporaryDirectory() as other:
                link = os.path.join(os.path.realpath(other), "link.h")
                os.symlink(stray, link)
                self.assertEqual(packages_read([Read(link, "c++", RUNS, True)], [os.path.realpath(folder)], notes), {})
            self.assertEqual(notes, [])
            self.assertEqual(packages_read([Read(stray, "python3", RUNS, False)], [], notes), {})
            self.assertIn("not judged", notes[0])


if __name__ == "__main__":
    unittest.main()
