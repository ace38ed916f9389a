"""Text in ReqIF: attributes of one line, and CommonMark as paragraphs of XHTML that read the same."""

from __future__ import annotations

import re
from xml.sax.saxutils import escape

_NOT_IN_XML = re.compile(r"[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_NO_BREAK_SPACE = "\u00a0"


def make_attribute(text: str) -> str:
    """Return a text on one line, as the value of an XML attribute in double quotes."""
    return escape(_NOT_IN_XML.sub("\ufffd", " ".join(text.split())), {'"': "&quot;"})


def make_xhtml(text: str) -> str:
    """Return a text as XHTML: a paragraph for each, a break for each line; its signs stay as they are written.

    Blanks that XHTML would fold become no-break spaces, so that lists and code read as they were written.
    """
    plain = _NOT_IN_XML.sub("\ufffd", text.replace("\r\n", "\n").replace("\r", "\n").replace("\t", "    "))
    lines = [line.rstrip() for line in plain.replace(_NO_BREAK_SPACE, " ").split("\n")]
    paragraphs = [part.strip("\n") for part in re.split(r"\n{2,}", "\n".join(lines).strip())]
    blocks = (
        f"<xhtml:p>{'<xhtml:br/>'.join(_keep_blanks(line) for line in part.split(chr(10)))}</xhtml:p>"
        for part in paragraphs
        if part
    )
    return f"<xhtml:div>{''.join(blocks)}</xhtml:div>"


def _keep_blanks(line: str) -> str:
    return escape(re.sub(r"^ +| (?= )", lambda match: _NO_BREAK_SPACE * len(match[0]), line))
