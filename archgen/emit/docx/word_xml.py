"""WordprocessingML as text: runs, paragraphs, fields. All text from outside is cleaned and escaped here, and nowhere else.

python-docx parses the text once, when all of it is there. Measured on the 2,366 paragraphs of example_ramcip outside of tables
and the 9,930 in cells, of which each needs a style and a run: `Document.add_paragraph` 0.67 ms each (it looks the style up by
name in all styles), python-docx's element classes 0.07 ms, text 0.01 ms with the parsing; the whole report takes a second.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping

from archgen.emit.office_package import replace_forbidden

_W = "http://schemas.openxmlformats.org/wordprocessingml/2006/main"
_R = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
MC = "http://schemas.openxmlformats.org/markup-compatibility/2006"
NAMESPACES = {
    "w": _W,
    "r": _R,
    "mc": MC,
    "wp": "http://schemas.openxmlformats.org/drawingml/2006/wordprocessingDrawing",
    "a": "http://schemas.openxmlformats.org/drawingml/2006/main",
    "pic": "http://schemas.openxmlformats.org/drawingml/2006/picture",
    "w16se": "http://schemas.microsoft.com/office/word/2015/wordml/symex",
}
"""The prefixes that the document declares at its root, so that pieces of text need not."""

_ID_HYPHEN = re.compile(r"(?<=\b[A-Z])-(?=[0-9])|(?<=\b[A-Z]{2})-(?=[0-9])|(?<=\b[A-Z]{3})-(?=[0-9])")
"""The hyphen of an id such as `R-24`, `UC-7` or `MAN-04`."""
_LABEL_MARK = re.compile(r"\[label (_ag[0-9a-f]{24})\]")
_ESCAPES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\n": " ", "\r": " "})
_LINE_ENDS = str.maketrans("\n\r", "  ")
# Most texts need nothing: one search spares them both replacements.
_NEEDS_CARE = re.compile('[&<>"\n\r\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]')


def clean_line(text: str) -> str:
    """Return clean text on one line, for attributes and properties."""
    return replace_forbidden(text).translate(_LINE_ENDS)


def escape_text(text: str) -> str:
    """Return text as it may stand in an element or between double quotes."""
    return replace_forbidden(text).translate(_ESCAPES) if _NEEDS_CARE.search(text) else text


def name_bookmark(anchor: str) -> str:
    """Return the name of an anchor's bookmark: hashed, as Word allows 40 characters; Word hides names that begin with `_`."""
    return "_ag" + hashlib.sha256(anchor.encode("utf-8", "surrogatepass")).hexdigest()[:24]


def name_label_bookmark(anchor: str) -> str:
    """Return the name of the bookmark around the label and number of a caption."""
    return name_bookmark(f"label of {anchor}")


def mark_label(anchor: str) -> str:
    """Return what stands for the label of a caption until all captions have their numbers."""
    return f"[label {name_bookmark(anchor)}]"


def fill_labels(xml: str, labels: Mapping[str, str]) -> str:
    """Put labels into the place of their marks, by the captions' bookmarks."""
    return _LABEL_MARK.sub(lambda found: labels.get(found[1], found[0]), xml)


def format_run(text: str, properties: str = "", *, joins_ids: bool = False) -> str:
    """Return a run of text; tabs in it become Word's tabs. Where it `joins_ids`, `UC-7` has a hyphen at which no line breaks."""
    props = f"<w:rPr>{properties}</w:rPr>" if properties else ""
    # Without xml:space Word drops the blanks at both ends, between two runs too (ECMA-376 17.3.3.31).
    if joins_ids and "-" in text:
        return f"<w:r>{props}{'<w:noBreakHyphen/>'.join(map(_format_tabs, _ID_HYPHEN.split(text)))}</w:r>"
    return f"<w:r>{props}{_format_tabs(text)}</w:r>"


def _format_tabs(text: str) -> str:
    return "<w:tab/>".join([f'<w:t xml:space="preserve">{escape_text(part)}</w:t>' for part in text.split("\t")])


def format_paragraph(style_id: str, content: str, properties: str = "") -> str:
    """Return a paragraph. `properties` stand behind the style, in the order of the schema (ECMA-376 17.3.1.26)."""
    return f'<w:p><w:pPr><w:pStyle w:val="{style_id}"/>{properties}</w:pPr>{content}</w:p>'


def format_field(instruction: str, result: str) -> str:
    """Return a field with its stored result, as runs (ECMA-376 17.16.18); python-docx has no fields."""
    return (
        '<w:r><w:fldChar w:fldCharType="begin"/></w:r>'
        f'<w:r><w:instrText xml:space="preserve"> {escape_text(instruction)} </w:instrText></w:r>'
        '<w:r><w:fldChar w:fldCharType="separate"/></w:r>'
        f"{format_run(result)}"
        '<w:r><w:fldChar w:fldCharType="end"/></w:r>'
    )


def points_to_twips(points: float) -> int:
    """Return points as twentieths of a point, the unit of most of Word's lengths."""
    return round(points * 20)
