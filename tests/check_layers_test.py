#!/usr/bin/env python3
"""Tests of check_layers.py: small source trees, each with one violation.

Usage: check_layers_test.py
"""
import pathlib
import tempfile
import unittest

import check_layers

PAGE = "# Architecture\n\n## Modules\n\n| module | library |\n|---|---|\n| `depth/` | |\n| `recon/` | |\n| `recon/fit/` | |\n\n## Files\n"
# Modules are of one size, so that each has less than a fifth only where five of them are listed.
FIVE = PAGE.replace("| `depth/` | |\n", "".join(f"| `depth/{name}/` | |\n" for name in "abcdef"))


class WithTree(unittest.TestCase):
    def setUp(self):
        self.spare = tempfile.TemporaryDirectory()
        self.addCleanup(self.spare.cleanup)
        self.top = pathlib.Path(self.spare.name)
        self.write("docs/architecture.md", FIVE)
        for name in "abcdef":
            self.write(f"depth/{name}/file.h", "int x;\n" * 10)

    def write(self, name, text):
        path = self.top / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


class Modules(WithTree):
    def test_tree_of_even_modules_passes(self):
        self.assertEqual(list(check_layers.broken_rules(self.top)), [])
        self.assertEqual(list(check_layers.broken_sizes(self.top)), [])

    def test_module_of_a_fifth_is_too_large(self):
        self.write("depth/a/more.cpp", "int y;\n" * 10)
        self.assertRegex("\n".join(check_layers.broken_sizes(self.top)), r"^depth/a/: 20 of 70 lines")

    def test_file_counts_in_the_deepest_module(self):
        self.write("recon/fit/fit.cpp", "int y;\n" * 7)
        self.write("recon/posture.cpp", "int y;\n" * 3)
        sizes, _ = check_layers.module_sizes(self.top)
        self.assertEqual((sizes["recon/fit"], sizes["recon"]), (7, 3))

    def test_unlisted_folder_is_reported(self):
        self.write("recon/attic/old.cpp", "int y;\n")
        self.assertEqual(list(check_layers.broken_sizes(self.top)),
                         ["docs/architecture.md: expected recon/attic/ in the list of modules"])

    def test_upward_dependency_is_reported_by_file_and_line(self):
        self.write("depth/a/up.cpp", '\n#include "recon/posture.h"\n')
        self.assertEqual(list(check_layers.broken_rules(self.top)),
                         ["depth/a/up.cpp:2: depth/ may not include recon/posture.h"])

    def test_mutual_includes_are_reported(self):
        self.write("depth/a/b.h", '#include "depth/b/a.h"\n')
        self.write("depth/b/a.h", '#include "depth/a/b.h"\n')
        self.assertIn("include each other", "\n".join(check_layers.broken_rules(self.top)))


class Walk(WithTree):
    def setUp(self):
        super().setUp()
        # Ours, so that the steps are there.
        source = pathlib.Path(__file__).resolve().parent.parent
        for folder in check_layers.FRAME_PATH_FOLDERS:
            for path in (source / folder).glob("*.cpp"):
                self.write(f"{folder}/{path.name}", path.read_text())

    def test_repository_calls_its_steps_in_order(self):
        self.assertEqual(list(check_layers.broken_path(self.top)), [])

    def test_call_of_an_earlier_step_is_reported(self):
        self.write("tools/tracker/smoothing.cpp", "void Smooth() {\n  ChooseRaw(work);\n}\n")
        self.write("tools/tracker/person.cpp", "void Settle(SkeletonWork& work) {\n  people::DetectPeople(frame);\n}\n")
        told = "\n".join(check_layers.broken_path(self.top))
        self.assertIn("tools/tracker/smoothing.cpp:2: calls ChooseRaw out of turn", told)
        self.assertIn("tools/tracker/person.cpp:2: calls DetectPeople out of turn", told)

    def test_step_that_is_never_called_is_reported(self):
        self.write("tools/tracker/track_frame.cpp", "")
        self.assertIn("nobody calls TrackSkeleton", "\n".join(check_layers.broken_path(self.top)))


if __name__ == "__main__":
    unittest.main()
