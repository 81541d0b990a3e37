#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether check_site.py finds what is wrong; where no Chromium is installed, nothing is tested."""
import pathlib
import tempfile
import unittest

import check_site

PAGE = '<!DOCTYPE html><link rel="icon" href="data:,"><h1>a</h1>'


@unittest.skipUnless(check_site.browser(), "no Chromium is installed")
class Site(unittest.TestCase):
    def test_what_is_wrong_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            site = pathlib.Path(folder).resolve()
            for name, body in (("good", "<p>a</p>"), ("wide", '<p style="width:700px">a</p>'),
                               ("error", "<script>none()</script>"), ("scrolls", '<div style="overflow-x:auto"><p style="width:700px">a</p></div>')):
                (site / f"{name}.html").write_text(PAGE + body, encoding="utf-8")
            wrong = check_site.check(check_site.browser(), site, sorted(site.glob("*.html")))
        wide = [line for line in wrong if "CONSOLE" not in line]
        self.assertEqual(len(wide), 1, wrong)
        self.assertIn("wide.html at 400", wide[0])
        self.assertEqual(len(wrong) - len(wide), 2, "one message at each width")


if __name__ == "__main__":
    unittest.main()
