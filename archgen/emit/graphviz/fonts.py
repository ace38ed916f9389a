"""Configure the font of all pictures: it ships with archgen, so that text has the same width on every machine."""

from __future__ import annotations

import shutil
from html import escape
from pathlib import Path

FOLDER = Path(__file__).resolve().parent.parent / "fonts"
"""The folder with DejaVu Sans and its licence."""

_CONFIGURATION = """<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "urn:fontconfig:fonts.dtd">
<fontconfig>
  <dir>{fonts}</dir>
  <cachedir>{cache}</cachedir>
</fontconfig>
"""


def configure(folder: Path) -> Path:
    """Write a fontconfig file that knows this font and no other. Return its path.

    It refers to a copy: some versions of fontconfig leave a file of theirs beside the fonts that they read.
    """
    copies = folder / "fonts"
    copies.mkdir(parents=True, exist_ok=True)
    for font in sorted(FOLDER.glob("*.ttf")):
        copy = copies / font.name
        if not copy.is_file() or copy.stat().st_size != font.stat().st_size:
            shutil.copyfile(font, copy)
    file = folder / "fonts.conf"
    text = _CONFIGURATION.format(fonts=escape(str(copies)), cache=escape(str(folder / "fontconfig")))
    if not file.is_file() or file.read_text("utf-8") != text:
        file.write_text(text, "utf-8")
    return file
