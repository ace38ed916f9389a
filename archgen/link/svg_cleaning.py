"""Clean the SVG pictures that a project brings: nothing in them runs, and nothing is loaded from elsewhere.

Opened on its own, an SVG is a document like a page: scripts in it run in the origin of the site that holds it.
"""

from __future__ import annotations

import re

_KEPT_DATA = {"image": ["png", "jpeg", "gif"]}
_REFERENCE = re.compile(rb"""(\s)(?:xlink:)?href="(?!#|data:image/)[^"]*\"""")
_STYLE_ADDRESS = re.compile(rb"""url\((?!\s*['"]?(?:#|data:image/))[^)]*\)""", re.IGNORECASE)


def is_svg(data: bytes) -> bool:
    """Whether bytes are markup, and no picture of pixels: a browser takes what begins with `<` for a document."""
    return data[:4096].lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<")


def clean_project_svg(data: bytes) -> bytes | None:
    """Return the picture without scripts, handlers, foreign objects and outside addresses; None if it is no sound SVG."""
    # Imported here: only projects that show an SVG need it. It knows the elements and attributes of SVG that are harmless.
    from py_svg_hush import filter_svg

    if b"<!ENTITY" in data:  # entities may name files, or grow without end; drawing programs write none that matter
        return None
    try:
        harmless: bytes = filter_svg(data, keep_data_url_mime_types=_KEPT_DATA)
    except ValueError:
        return None
    # Of foreign addresses it keeps the path (`https://a.org/b.png` becomes `/b.png`), and it keeps relative ones: they
    # would be loaded from the site itself, or from the disk where the site is opened from there.
    return _STYLE_ADDRESS.sub(b"url(#)", _REFERENCE.sub(rb"\1", harmless))
