"""Make the face of code in Word files: DejaVu Sans Mono with the letters of Latin, Greek and Cyrillic, and some signs.

    python -m venv /tmp/fonts && /tmp/fonts/bin/pip install fonttools==4.68.0
    /tmp/fonts/bin/python tools/make_code_font.py /usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf

All of the font is nine times as large, and lies in each report.
"""

from __future__ import annotations

import sys
from pathlib import Path

from fontTools.subset import Options, Subsetter  # type: ignore[import-not-found]
from fontTools.ttLib import TTFont  # type: ignore[import-not-found]

TARGET = Path(__file__).resolve().parent.parent / "archgen" / "emit" / "docx" / "fonts" / "DejaVuSansMono.ttf"
LETTERS = (*range(0x20, 0x7F), *range(0xA0, 0x180), *range(0x370, 0x460))
SIGNS = tuple(
    map(
        ord,
        "\u200b\u2010\u2011\u2012\u2013\u2014\u2018\u2019\u201c\u201d\u2022\u2026\u202f\u2190\u2191\u2192\u2193\u2212\u2264\u2265",
    )
)


def main() -> None:
    """Write the font from that of the path that is given."""
    options = Options()
    options.layout_features = []
    options.hinting = False
    options.name_IDs = ["*"]
    options.notdef_outline = True
    options.recalc_timestamp = False
    font = TTFont(sys.argv[1], recalcTimestamp=False)
    subsetter = Subsetter(options)
    subsetter.populate(unicodes=[*LETTERS, *SIGNS])
    subsetter.subset(font)
    font.save(TARGET)


if __name__ == "__main__":
    main()
