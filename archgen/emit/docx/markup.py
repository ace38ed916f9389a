"""The smallest pieces of WordprocessingML as text. All text from outside is cleaned and escaped here, and nowhere else.

Elements are written as strings, not built as trees: a report has some hundred thousand of them, and strings are ten times as fast.
"""

from __future__ import annotations

import hashlib
import re

W = "http://schemas.openxmlformats.org/wordprocessingml/2006/main"
R = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
MC = "http://schemas.openxmlformats.org/markup-compatibility/2006"
SYMEX = "http://schemas.microsoft.com/office/word/2015/wordml/symex"
NAMESPACES = {
    "w": W,
    "r": R,
    "mc": MC,
    "wp": "http://schemas.openxmlformats.org/drawingml/2006/wordprocessingDrawing",
    "a": "http://schemas.openxmlformats.org/drawingml/2006/main",
    "pic": "http://schemas.openxmlformats.org/drawingml/2006/picture",
    "w16se": SYMEX,
}
"""The prefixes that the strings of this package use."""

# What XML 1.0 cannot hold (control characters, halves of surrogate pairs, two non-characters), and the C1 controls, which nobody sees.
_FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")
_ESCAPES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\n": " ", "\r": " "})
_NEEDS_CARE = re.compile('[&<>"\n\r\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]')


def clean(text: str) -> str:
    """Give the text with every character that XML cannot hold replaced by a visible sign."""
    return _FORBIDDEN.sub("\ufffd", text)


def escape(text: str) -> str:
    """Give the text as it may stand in an element or between double quotes."""
    return clean(text).translate(_ESCAPES) if _NEEDS_CARE.search(text) else text


def bookmark_name(anchor: str) -> str:
    """Give the name of an anchor's bookmark: hashed, as Word allows 40 characters; hidden in Word, as it begins with `_`."""
    return "_ag" + hashlib.sha256(anchor.encode("utf-8", "surrogatepass")).hexdigest()[:24]


def run(text: str, properties: str = "") -> str:
    """Give a run of text; tabs in it become Word's tabs."""
    props = f"<w:rPr>{properties}</w:rPr>" if properties else ""
    if "\t" not in text:
        return f'<w:r>{props}<w:t xml:space="preserve">{escape(text)}</w:t></w:r>'
    parts = "<w:tab/>".join(f'<w:t xml:space="preserve">{escape(part)}</w:t>' for part in text.split("\t"))
    return f"<w:r>{props}{parts}</w:r>"


def paragraph(style: str, content: str, properties: str = "") -> str:
    """Give a paragraph. `properties` stand behind the style, in the order of the schema."""
    return f'<w:p><w:pPr><w:pStyle w:val="{style}"/>{properties}</w:pPr>{content}</w:p>'


def field(instruction: str, result: str, properties: str = "") -> str:
    """Give a field with its stored result, as runs."""
    props = f"<w:rPr>{properties}</w:rPr>" if properties else ""
    return (
        f'<w:r>{props}<w:fldChar w:fldCharType="begin"/></w:r>'
        f'<w:r>{props}<w:instrText xml:space="preserve"> {escape(instruction)} </w:instrText></w:r>'
        f'<w:r>{props}<w:fldChar w:fldCharType="separate"/></w:r>'
        f"{run(result, properties)}"
        f'<w:r>{props}<w:fldChar w:fldCharType="end"/></w:r>'
    )


def twips(points: float) -> int:
    """Turn points into twentieths of a point."""
    return round(points * 20)
