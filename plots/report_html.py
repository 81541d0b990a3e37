# SPDX-License-Identifier: GPL-3.0-or-later
"""HTML of the report: escaped text with mathematical signs, tables, pictures inside the page."""
import base64
import html
import io
import re

from PIL import Image

from report_content import SYMBOLS

SCREEN_WIDTH = 1340  # pixels of a picture at most: 17 cm at 200 dpi


def text(words):
    """A sentence of a claim as HTML: Greek letters by name, h^2, H1, x1, x_h, >= and 1e-3 become signs."""
    escaped = html.escape(words, quote=False)
    escaped = escaped.replace("-&gt;", "→").replace("+-", "±").replace("&gt;=", "≥").replace("&lt;=", "≤")
    escaped = re.sub(r"\b(" + "|".join(SYMBOLS) + r")(?=\b|[_²³⁴]|\d)", lambda match: SYMBOLS[match[1]], escaped)
    escaped = re.sub(r"\b([HL])([12])\b", r"\1<sup>\2</sup>", escaped)
    escaped = re.sub(r"\bx([123])\b", r"x<sub>\1</sub>", escaped)
    escaped = re.sub(r"\^(\([^()]*\)|-?\d+\.\.?\d+|-?[\w∞]+)", lambda match: f"<sup>{match[1].strip('()')}</sup>", escaped)
    escaped = re.sub(r"(?<=[A-Za-zͰ-Ͽ|])_([a-zA-Z0-9]{1,2})(?![a-zA-Z0-9_])", r"<sub>\1</sub>", escaped)
    escaped = re.sub(r"(?<![\w.])(\d+(?:\.\d+)?)e([-+]?)0*(\d*)\b", power_of_ten, escaped)
    escaped = re.sub(r"(?<=Cahn|burg)-(?=Hilliard|Landau)|(?<=\d\))-(?=\(\d)", "–", escaped)
    return re.sub(r"(?<![\w)/<-])-(?=\d)", "−", escaped)


def measured_words(words):
    """What was measured, as HTML; "-" is an order that the errors do not determine."""
    return "no order" if words == "-" else text(words)


def power_of_ten(match):
    """2.5e-03 as 2.5·10⁻³, 2.5e+00 as 2.5."""
    mantissa, sign, exponent = match.groups()
    minus = "−" if sign == "-" else ""
    return f"{mantissa}·10<sup>{minus}{exponent}</sup>" if exponent else mantissa


def number(value):
    """A number of a table, short."""
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.3g}".replace("e-0", "e-").replace("e+0", "e+")
    return html.escape(str(value))


def tag(name, content, **attributes):
    """<name attributes>content</name>; class_ is class."""
    given = "".join(f' {key.rstrip("_")}="{html.escape(str(value))}"' for key, value in attributes.items())
    return f"<{name}{given}>{content}</{name}>"


def table(heads, rows, class_="", body_class=""):
    """A table that scrolls where it is wider than the page; heads and cells are HTML. A row may be (class, cells)."""
    head = "".join(tag("th", cell) for cell in heads)
    body = []
    for row in rows:
        kind, cells = row if isinstance(row, tuple) else ("", row)
        body.append(tag("tr", "".join(tag("td", cell) for cell in cells), **({"class_": kind} if kind else {})))
    made = tag("table", tag("thead", tag("tr", head)) + tag("tbody", "\n".join(body)), class_=class_)
    return tag("div", made, class_=f"scroll {body_class}".strip())


def link(target, words, **attributes):
    """A link to another place of the page, or to another page; words are HTML."""
    return tag("a", words, href=target if ":" in target else "#" + target, **attributes)


def small_png(path, width=SCREEN_WIDTH):
    """The picture in `path` as bytes of a PNG with at most 256 colours, at most `width` pixels wide."""
    with Image.open(path) as image:
        picture = image.convert("RGB")
        if picture.width > width:
            picture = picture.resize((width, round(picture.height * width / picture.width)), Image.LANCZOS)
        picture = picture.quantize(256, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
        stream = io.BytesIO()
        picture.save(stream, "PNG", optimize=True)
    return stream.getvalue()


def picture(path, alternative):
    """The picture as a part of the page."""
    data = base64.b64encode(small_png(path)).decode("ascii")
    return f'<img alt="{html.escape(alternative)}" src="data:image/png;base64,{data}">'
