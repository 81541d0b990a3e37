# SPDX-License-Identifier: GPL-3.0-or-later
"""Documentation, report, gallery and API as static pages, for a browser and without a server.

Usage: python3 plots/site_pages.py OUTPUT [--report FOLDER] [--figures FOLDER] [--api FOLDER]
README.md is OUTPUT/index.html; the pages of docs/ and what they link to keep their places. Needs python3-markdown. A report, figures
or API that are not there are named, and left out. Exit code 1 where a link leads nowhere.
"""
import argparse
import html
import html.parser
import os
import posixpath
import re
import shutil
import sys

from report_content import BEYOND, PAPERS
from report_html import small_png, tag, text
from report_summary import source

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FIRST = ("README.md", "docs/README.md", "CONTRIBUTING.md", "CHANGELOG.md")
SHOWN = (".png", ".json", ".html", ".pdf", ".txt", ".bib")  # a browser shows these itself
NAVIGATION = (("index.html", "esfem"), ("docs/index.html", "Documentation"), ("docs/own_problems.html", "Own problems"),
              ("docs/flows.html", "Flows"), ("gallery.html", "Gallery"), ("report/index.html", "Report"), ("api/index.html", "API"))
THUMBNAIL = 700  # pixels


def slug(words, separator="-"):
    """The anchor of a heading, as GitHub makes it."""
    return re.sub(r"[^\w\- ]", "", words.lower()).replace(" ", separator)


class Site:
    """What is written, from the files below `root`."""

    def __init__(self, root, output, markdown, parts):
        self.root, self.output, self.markdown = root, output, markdown
        self.navigation = [(target, words) for target, words in NAVIGATION
                           if target.partition("/")[0] not in ("report", "api") or target.partition("/")[0] in parts]
        self.waiting, self.done = [], set()

    def write(self, path, data):
        target = os.path.join(self.output, path)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        with open(target, "wb") as file:
            file.write(data)

    def page(self, path, title, body):
        """An HTML page at `path` below the output."""
        up = "../" * path.count("/")
        current = path if path in dict(self.navigation) or not path.startswith("docs/") else "docs/index.html"
        links = "".join(tag("a", words, href=up + target, **({"aria_current": "page"} if target == current else {}))
                        for target, words in self.navigation).replace("aria_current", "aria-current")
        self.write(path, (
            '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
            '<meta name="viewport" content="width=device-width, initial-scale=1">'
            f'<link rel="icon" href="data:,"><title>{html.escape(title)}</title><link rel="stylesheet" href="{up}site.css"></head><body>'
            f"<header>{tag('nav', links)}</header><main>{body}</main></body></html>\n").encode())

    def place(self, path):
        """Where a file or folder of the sources is in the site; it is written later."""
        path = posixpath.normpath(path)
        self.waiting.append(path)
        if os.path.isdir(os.path.join(self.root, path)):
            path = posixpath.join(path, "README.md")
        if path.endswith(".md"):
            folder, name = posixpath.split(path)
            return posixpath.join(folder, "index.html" if name == "README.md" else name[:-2] + "html")
        return path if path.endswith(SHOWN) else path + ".txt"

    def link(self, page, target):
        """A link of a page of the sources, as the page's place needs it."""
        file, hash_, anchor = target.partition("#")
        if not file or ":" in file:
            return target
        path = posixpath.normpath(posixpath.join(posixpath.dirname(page), file))
        if path.startswith("..") or not os.path.exists(os.path.join(self.root, path)):
            return target  # found by dead_links
        return posixpath.relpath(self.place(path), posixpath.dirname(page) or ".") + hash_ + anchor

    def write_source(self, path):
        """A page of Markdown, the list of a folder, or a copy."""
        full = os.path.join(self.root, path)
        if os.path.isdir(full):
            if os.path.exists(os.path.join(full, "README.md")):
                return self.waiting.append(posixpath.join(path, "README.md"))
            files = sorted(name for name in os.listdir(full) if os.path.isfile(os.path.join(full, name)))
            body = "".join(tag("li", tag("a", html.escape(name), href=posixpath.relpath(self.place(f"{path}/{name}"), path))) for name in files)
            return self.page(self.place(path), path, tag("h1", path) + tag("ul", body))
        with open(full, "rb") as file:
            data = file.read()
        if not path.endswith(".md"):
            return self.write(self.place(path), data)
        made = self.markdown.markdown(data.decode(), extensions=["tables", "fenced_code", "toc", "sane_lists"],
                                      extension_configs={"toc": {"slugify": slug}})
        made = re.sub(r'(href|src)="([^"]*)"', lambda match: f'{match[1]}="{html.escape(self.link(path, html.unescape(match[2])))}"', made)
        made = made.replace("<td><code>", '<td class="code"><code>')  # names in a column, not words of a sentence
        made = re.sub(r"<table>.*?</table>", lambda match: tag("div", match[0], class_="scroll"), made, flags=re.DOTALL)
        for head, kind in (("figure", "figures stacked"), ("verdict", "stacked")):
            made = re.sub(rf"<table>(?=\s*<thead>\s*<tr>\s*<th[^>]*>{head}</th>)", f'<table class="{kind}">', made)
        made = re.sub(r'(?<!">)(<img [^>]*src="([^"]*)"[^>]*>)', r'<a href="\2">\1</a>', made)  # at its full size
        title = re.search(r"<h1[^>]*>(.*?)</h1>", made)
        return self.page(self.place(path), "esfem" if path == "README.md" else f"esfem: {re.sub('<[^>]*>', '', title[1] if title else path)}", made)

    def write_all(self):
        """The first pages, and all that they link to."""
        self.waiting += [path for path in FIRST if os.path.exists(os.path.join(self.root, path))]
        while self.waiting:
            path = self.waiting.pop()
            if path not in self.done:
                self.done.add(path)
                self.write_source(path)


def gallery(site, figures):
    """All figures, small, each a link to its PDF. Returns how many there are."""
    parts, number = [tag("h1", "Gallery")], 0
    groups = [(paper.name, tag("p", source(paper), class_="note"), paper.figures) for paper in PAPERS]
    for name, note, of_group in [*groups, ("Beyond the papers", "", BEYOND)]:
        shown = []
        for figure in of_group:
            path = os.path.join(figures, figure.name)
            if not os.path.exists(path + ".png"):
                continue
            number += 1
            site.write(f"figures/{figure.name}.png", small_png(path + ".png", THUMBNAIL))
            shutil.copyfile(path + ".pdf", os.path.join(site.output, f"figures/{figure.name}.pdf"))
            picture = f'<img loading="lazy" alt="{html.escape(figure.caption)}" src="figures/{figure.name}.png">'
            words = (f"Figure {figure.number}. " if figure.number else "") + text(figure.caption)
            shown.append(tag("figure", tag("a", picture, href=f"figures/{figure.name}.pdf") + tag("figcaption", words)))
        if shown:
            parts.append(tag("h2", text(name)) + note + tag("div", "".join(shown), class_="gallery"))
    site.page("gallery.html", "esfem: gallery", "".join(parts) if number else tag("h1", "Gallery") + tag("p", "No figures yet: make figures."))
    return number


class Targets(html.parser.HTMLParser):
    """Names of places in a page, and where its links lead."""

    def __init__(self, page):
        super().__init__()
        self.ids, self.links = set(), set()
        self.feed(page)

    def handle_starttag(self, tag_, attrs):
        for key, value in attrs:
            if key in ("id", "name"):
                self.ids.add(value)
            elif key in ("href", "src") and value:
                self.links.add(value)


def dead_links(output, apart=("api",)):
    """["PAGE: LINK"] that lead nowhere, but for the pages of folders that another program wrote."""
    pages = {}
    for folder, folders, files in os.walk(output):
        folders[:] = [name for name in folders if folder != output or name not in apart]
        for name in files:
            if name.endswith(".html"):
                path = os.path.join(folder, name)
                with open(path, encoding="utf-8") as file:
                    pages[path] = Targets(file.read())
    dead = []
    for path, page in pages.items():
        for link in sorted(page.links):
            file, _, anchor = link.partition("#")
            if ":" in file:
                continue
            target = os.path.normpath(os.path.join(os.path.dirname(path), file)) if file else path
            exists = os.path.isfile(target)
            if not exists or anchor and target in pages and anchor not in pages[target].ids:
                dead.append(f"{os.path.relpath(path, output)}: {link}")
    return dead


def copy(folder, target):
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(folder, target)


def with_way_back(path):
    """The report by itself has no other page to lead to."""
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            page = file.read()
        with open(path, "w", encoding="utf-8") as file:
            file.write(page.replace("<body>", '<body><p class="screen"><a href="../index.html">esfem</a></p>', 1))


def build(root, output, report, figures, api):
    """Writes the site; returns what is missing, and links that lead nowhere."""
    import markdown  # only this target needs it
    there = {name for name, folder in (("report", report), ("api", api)) if os.path.exists(os.path.join(folder, "index.html"))}
    missing = [f"{name} ({command})" for name, command in (("report", "make report"), ("api", "make docs")) if name not in there]
    site = Site(root, output, markdown, there)
    site.write_all()
    if not gallery(site, figures):
        missing.append("figures (make figures)")
    css = b""
    for name in ("report.css", "site.css"):
        with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), name), "rb") as file:
            css += file.read()
    site.write("site.css", css)
    for name, folder in (("report", report), ("api", api)):
        if name in there:
            copy(folder, os.path.join(output, name))
    with_way_back(os.path.join(output, "report/index.html"))
    return missing, dead_links(output)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output", help="e.g. site")
    parser.add_argument("--report", default="report")
    parser.add_argument("--figures", default="figures")
    parser.add_argument("--api", default="build/api/html")
    arguments = parser.parse_args()
    try:
        missing, dead = build(ROOT, arguments.output, arguments.report, arguments.figures, arguments.api)
    except ImportError as error:
        sys.exit(f"{parser.prog}: {error}: install python3-markdown")
    except OSError as error:
        sys.exit(f"{parser.prog}: {error.filename}: {error.strerror}")
    print(f"site: {arguments.output}/index.html" + (f"; left out: {', '.join(missing)}" if missing else ""))
    if dead:
        sys.exit("links that lead nowhere:\n" + "\n".join(dead))


if __name__ == "__main__":
    main()
