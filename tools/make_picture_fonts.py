"""Make the font of pictures, Inter as TrueType files, from the web fonts that the site ships.

    python -m venv /tmp/fonts && /tmp/fonts/bin/pip install fonttools==4.68.0 brotli==1.2.1
    /tmp/fonts/bin/python tools/make_picture_fonts.py

Graphviz cannot read web fonts. From the same outlines texts are as wide in a layout as in a browser. The parts for Latin and
Greek letters become one file for each weight; of the layout features those stay that browsers use unasked.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from fontTools.merge import Merger  # type: ignore[import-not-found]
from fontTools.subset import Options, Subsetter  # type: ignore[import-not-found]
from fontTools.ttLib import TTFont  # type: ignore[import-not-found]
from fontTools.varLib.instancer import instantiateVariableFont  # type: ignore[import-not-found]

ROOT = Path(__file__).resolve().parent.parent
WEB_FONTS = ROOT / "backends" / "site" / "assets" / "fonts"
FONTS = ROOT / "archgen" / "emit" / "fonts"
PARTS = ("latin", "latin-ext", "greek")
WEIGHTS = {"Regular": 400, "Bold": 700}
FEATURES = ["kern", "mark", "mkmk", "ccmp", "locl"]


def main() -> None:
    """Write a file for each weight, and the licence beside them."""
    for style, weight in WEIGHTS.items():
        with tempfile.TemporaryDirectory() as folder:
            parts = [make_part(part, weight, Path(folder)) for part in PARTS]
            font = Merger().merge([str(part) for part in parts])
        font.recalcTimestamp = False
        name_font(font, style, weight)
        font.save(FONTS / f"Inter-{style}.ttf")
    (FONTS / "LICENSE.Inter").write_bytes((WEB_FONTS / "LICENSE-Inter.txt").read_bytes())


def make_part(part: str, weight: int, folder: Path) -> Path:
    """Write one part of the font in one weight, without what varies. Return its file."""
    font = TTFont(WEB_FONTS / f"inter-{part}-wght-normal.woff2")
    font.flavor = None
    font = instantiateVariableFont(font, {"wght": weight})
    options = Options()
    options.layout_features = FEATURES
    options.name_IDs = ["*"]
    options.notdef_outline = True
    subsetter = Subsetter(options)
    subsetter.populate(unicodes=list(font.getBestCmap()))
    subsetter.subset(font)
    # The merger refuses what only variable fonts have.
    for table in ("STAT", "HVAR", "MVAR", "avar"):
        if table in font:
            del font[table]
    file = folder / f"{part}.ttf"
    font.save(file)
    return file


def name_font(font: TTFont, style: str, weight: int) -> None:
    """Name a font by its family and its style, so that fontconfig finds the weight."""
    names = {1: "Inter", 2: style, 4: f"Inter {style}", 6: f"Inter-{style}", 16: "Inter", 17: style}
    for record in font["name"].names:
        record.string = names.get(record.nameID, str(record))
    font["OS/2"].usWeightClass = weight
    # Bit 5 is bold, bit 6 regular, bit 0 italic.
    font["OS/2"].fsSelection = (font["OS/2"].fsSelection & ~0x61) | (0x20 if style == "Bold" else 0x40)
    font["head"].macStyle = int(style == "Bold")
    # The merger writes the time of day: two runs must give the same bytes.
    font["head"].created = font["head"].modified = 3786912000


if __name__ == "__main__":
    main()
