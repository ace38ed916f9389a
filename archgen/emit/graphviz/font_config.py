"""Configure the fonts of all pictures: they ship with archgen, so that text has the same width on every machine."""

from __future__ import annotations

import shutil
from html import escape
from pathlib import Path

FONT_FOLDER = Path(__file__).resolve().parent.parent / "fonts"
"""The folder with Inter and DejaVu Sans, and their licences."""

_CONFIG_TEMPLATE = """<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "urn:fontconfig:fonts.dtd">
<fontconfig>
  <dir>{fonts}</dir>
  <cachedir>{cache}</cachedir>
  <match target="font">
    <edit name="hinting" mode="assign"><bool>false</bool></edit>
    <edit name="hintstyle" mode="assign"><const>hintnone</const></edit>
  </match>
</fontconfig>
"""


def write_font_config(folder: Path) -> Path:
    """Write a fontconfig file that knows these fonts and no other. Return its path.

    It refers to a copy: some versions of fontconfig leave a file of theirs beside the fonts that they read.
    """
    copy_folder = folder / "fonts"
    copy_folder.mkdir(parents=True, exist_ok=True)
    for font in sorted(FONT_FOLDER.glob("*.ttf")):
        font_copy = copy_folder / font.name
        # Copied again only for another version of archgen: several processes may draw from the folder by then.
        if not font_copy.is_file() or font_copy.stat().st_size != font.stat().st_size:
            shutil.copyfile(font, font_copy)
    file = folder / "fonts.conf"
    text = _CONFIG_TEMPLATE.format(fonts=escape(str(copy_folder)), cache=escape(str(folder / "fontconfig")))
    if not file.is_file() or file.read_text("utf-8") != text:
        file.write_text(text, "utf-8")
    return file
