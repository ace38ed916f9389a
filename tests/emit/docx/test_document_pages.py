"""The documents of the case study as LibreOffice lays them out: how many pages they have, and that nothing is torn."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.emit.docx import judges
from tests.running import RAMCIP, archgen_here

pytestmark = pytest.mark.slow


def _print(document: str, folder: Path) -> list[str]:
    path = folder / f"{document}.docx"
    archgen_here("report", RAMCIP, "--document", document, "-o", path, cwd=folder)
    return judges.pages(path)


def test_the_deliverable_has_forty_pages_at_most_and_no_torn_block(tmp_path: Path) -> None:
    pages = _print("deliverable", tmp_path)
    assert 25 <= len(pages) <= 40
    (summary,) = (page for page in pages if re.search(r"^ *1 +Summary *$", page, re.MULTILINE))
    assert "What is decided next" in summary
    use_cases = [page for page in pages if re.search(r"UC-\d (An|A|The|Walking|Bringing|Staying)\b", page)]
    # From the contents on: each heading with its last line, the requirements, on one page.
    for page in use_cases[1:]:
        headings = re.findall(r"^ *\d+\.\d+ +UC-\d ", page, re.MULTILINE)
        assert len(headings) == len(re.findall(r"^ *Requirements: ", page, re.MULTILINE)), page
    chains = [len(re.findall(r"^ *All of it ", page, re.MULTILINE)) for page in pages]
    assert sum(chains) == 8
    assert max(chains) == 2


def test_each_data_sheet_is_one_page(tmp_path: Path) -> None:
    pages = _print("data-sheets", tmp_path)
    first = next(
        at for at, page in enumerate(pages) if re.search(r"^ *1\.1 +Situation Assessment *$", page, re.MULTILINE)
    )
    sheets = [re.findall(r"^ *(\d+\.\d+) +\S.*$", page[:1200], re.MULTILINE)[:1] for page in pages[first:]]
    assert [] not in sheets
    assert len({number for found in sheets for number in found}) == len(sheets) == 61
