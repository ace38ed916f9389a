"""Numbers of a workbook as their formats show them: percentages, dates, and units that only the format has."""

from __future__ import annotations

import datetime as dt
import re
from collections.abc import Mapping
from dataclasses import dataclass

from lxml import etree

_MAIN = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
_PERCENT_IDS, _DATE_IDS = (
    frozenset({9, 10}),
    frozenset({*range(14, 23), *range(27, 37), *range(45, 48), *range(50, 59)}),
)
"""The formats that every workbook knows without writing them down."""
_LITERAL_PATTERN = re.compile(r'"([^"]*)"|\\(.)')
# A format is of 255 characters at most.
_CURRENCY_PATTERN = re.compile(r"\[\$([^\]-]{0,255}+)[^\]]{0,255}+\]")
_CONDITION_PATTERN = re.compile(r"\[[^\]]{0,255}+\]")
_DATE_LETTERS = re.compile(r"[ymdhs]", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class CellFormats:
    """The number formats of a workbook: their codes by the cells' style, and the day on which it begins to count."""

    code_by_style: Mapping[str, str]
    begins_1904: bool = False

    @classmethod
    def read_styles(cls, styles: etree._Element | None, *, begins_1904: bool) -> CellFormats:
        """Read the part with the styles."""
        if styles is None:
            return cls({}, begins_1904)
        written = {
            element.get("numFmtId", ""): element.get("formatCode", "") for element in styles.iter(f"{_MAIN}numFmt")
        }
        used = styles.find(f"{_MAIN}cellXfs")
        style_formats = [] if used is None else [element.get("numFmtId", "0") for element in used.iter(f"{_MAIN}xf")]
        codes = {str(style): written.get(name) or _shipped_code(name) for style, name in enumerate(style_formats)}
        return cls(codes, begins_1904)

    def format_number(self, value: str, style: str) -> str:
        """Return a number as its format shows it, but with all its digits and a decimal point."""
        try:
            number = float(value)
        except ValueError:
            return value
        code = self.code_by_style.get(style, "").split(";")[0]
        # Shown text is taken out first: the letters of `0 "days"` make no date.
        plain_code = _LITERAL_PATTERN.sub("", _CONDITION_PATTERN.sub("", code))
        if _DATE_LETTERS.search(plain_code) and not re.search(r"[0#]", plain_code.replace(".0", "")):
            return _format_date(number, begins_1904=self.begins_1904) or value
        # 15 digits are what a workbook stores faithfully: 0.1 + 0.2 is shown as 0.3.
        if "%" in plain_code:
            return f"{number * 100:.15g} %"
        before, after = _read_literals(code)
        return f"{before}{number:.15g}{after}"


def _shipped_code(name: str) -> str:
    number = int(name) if name.isdecimal() and len(name) < 5 else 0  # noqa: PLR2004 - there are fewer than 200
    return "0%" if number in _PERCENT_IDS else "yyyy-mm-dd" if number in _DATE_IDS else ""


def _read_literals(code: str) -> tuple[str, str]:
    """Return the text that a format shows before and behind the digits: ` Hz` of `0" Hz"`."""
    visible_code = _CONDITION_PATTERN.sub("", _CURRENCY_PATTERN.sub(r'"\1"', code))
    hidden_literals = _LITERAL_PATTERN.sub(lambda match: " " * len(match[0]), visible_code)
    digits = [match.start() for match in re.finditer(r"[0#?]", hidden_literals)]
    if not digits:
        return "", ""
    return _show_literals(visible_code[: digits[0]]), _show_literals(visible_code[digits[-1] + 1 :])


def _show_literals(code: str) -> str:
    """Return what a piece of a format shows: quoted and escaped text, without room and filling."""
    return re.sub(r'"([^"]*)"|\\(.)|[_*].|([,.])', lambda match: match[1] or match[2] or "", code)


def _format_date(number: float, *, begins_1904: bool) -> str:
    """Return a date, a time of day, or both; empty where the number is none."""
    # Excel counts a 29 February 1900 that never was: from March 1900 on, days count from 30 December 1899.
    first_day = dt.datetime(1904, 1, 1) if begins_1904 else dt.datetime(1899, 12, 30)  # noqa: DTZ001 - no time zone
    try:
        moment = first_day + dt.timedelta(seconds=round(number * 86400))
    except (OverflowError, ValueError):
        return ""
    if 0 <= number < 1:
        return f"{moment:%H:%M:%S}".removesuffix(":00")
    return f"{moment:%Y-%m-%d}" if number == int(number) else f"{moment:%Y-%m-%d %H:%M}"
