#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every page of the site in a headless Chromium, at 400 and 1,280 pixels: nothing on its console, and nothing wider than the page.

    tests/site/check_site.py SITE PICTURES [--pictures]     PICTURES gets a picture of each page, light and dark, if asked for

Exit code 0 when all is well or no Chromium is installed (a line says so), 1 otherwise."""
import argparse
import html
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

WIDTHS = 400, 1280
DARK = "--blink-settings=preferredColorScheme=0"
# Loads all pages in frames of each width, and writes into the title what is wider than its frame.
MEASURE = """<!DOCTYPE html><title>not finished</title><link rel="icon" href="data:,"><script>
const pages = %s, widths = %s, wrong = [];
async function measure(page, width) {
  const frame = document.createElement("iframe");
  frame.style.cssText = `width:${width}px;height:900px;border:0`;
  const loaded = new Promise(done => frame.onload = done);
  frame.src = page;
  document.body.append(frame);
  await loaded;
  const root = frame.contentDocument.documentElement;
  if (root.scrollWidth > width) {
    const wide = [...root.querySelectorAll("body *")].find(e => e.getBoundingClientRect().right > width + 1 && !e.closest(".scroll, pre"));
    wrong.push(`${page} at ${width}: ${root.scrollWidth} wide, ${wide ? wide.outerHTML.slice(0, 80) : ""}`);
  }
  if (!frame.contentDocument.querySelector("h1")) wrong.push(`${page} at ${width}: no heading`);
  frame.remove();
}
addEventListener("load", async () => {
  for (const page of pages) for (const width of widths) await measure(page, width);
  document.title = JSON.stringify(wrong);
});
</script><body></body>"""


def browser():
    return next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)


def run(program, *options):
    command = [program, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--enable-logging=stderr",
               "--allow-file-access-from-files", *options]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=600)


def messages(stderr):
    """What pages wrote on the console."""
    return [line for line in stderr.splitlines() if ":CONSOLE" in line]


def check(program, site, pages):
    """What is wrong with the pages, a line each."""
    with tempfile.TemporaryDirectory() as folder:
        wrapper = pathlib.Path(folder, "measure.html")
        wrapper.write_text(MEASURE % (json.dumps([page.as_uri() for page in pages]), json.dumps(WIDTHS)), encoding="utf-8")
        done = run(program, "--virtual-time-budget=600000", "--dump-dom", wrapper.as_uri())
    title = re.search(r"<title>(.*?)</title>", done.stdout, re.DOTALL)
    if not title or title[1] == "not finished":
        return [f"the browser did not finish: {done.stderr[-500:]}"]
    return [line.replace(site.as_uri() + "/", "") for line in json.loads(html.unescape(title[1]))] + messages(done.stderr)


def pictures(program, site, pages, folder):
    os.makedirs(folder, exist_ok=True)
    for page in pages:
        name = str(page.relative_to(site)).replace("/", "_").removesuffix(".html")
        for width in WIDTHS:
            for scheme, options in (("light", []), ("dark", [DARK])):
                run(program, *options, f"--window-size={width},2400", f"--screenshot={folder}/{name}_{width}_{scheme}.png", page.as_uri())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("site", type=pathlib.Path)
    parser.add_argument("folder")
    parser.add_argument("--pictures", action="store_true")
    arguments = parser.parse_args()
    program = browser()
    if not program:
        print("site: not looked at: no Chromium is installed")
        return
    site = arguments.site.resolve()
    pages = sorted(page for page in site.rglob("*.html") if page.relative_to(site).parts[0] != "api")
    wrong = check(program, site, pages)
    if arguments.pictures:
        pictures(program, site, pages, arguments.folder)
    if wrong:
        sys.exit("\n".join(wrong))
    print(f"site: {len(pages)} pages at {' and '.join(map(str, WIDTHS))} pixels: no message, nothing too wide")


if __name__ == "__main__":
    main()
