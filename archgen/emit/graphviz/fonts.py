"""The font of all pictures: one that ships with archgen, so that text is as wide on every machine as it was laid out."""

from __future__ import annotations

from pathlib import Path
from xml.sax.saxutils import escape

FOLDER = Path(__file__).resolve().parent.parent / "fonts"
"""Where DejaVu Sans lies, with its licence."""

_CONFIGURATION = """<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "urn:fontconfig:fonts.dtd">
<fontconfig>
  <dir>{fonts}</dir>
  <cachedir>{cache}</cachedir>
</fontconfig>
"""


def configure(folder: Path) -> Path:
    """Write a fontconfig file that knows this font and no other; give its path."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "fonts.conf"
    text = _CONFIGURATION.format(fonts=escape(str(FOLDER)), cache=escape(str(folder / "fontconfig")))
    if not file.is_file() or file.read_text("utf-8") != text:
        file.write_text(text, "utf-8")
    return file
