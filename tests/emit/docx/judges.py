"""The judges from outside that Word reports are held against: Microsoft's Open XML SDK, and LibreOffice's pages."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from tests.outside_tools import find_judge, find_tool, run_judge


def validated(path: Path) -> list[dict[str, Any]]:
    """Give what Microsoft's validator says against a .docx."""
    answer = json.loads(run_judge(find_judge(".bin/ooxml-validator"), path, statuses=(0, 1)).stdout)
    errors: list[dict[str, Any]] = answer["errors"]
    return errors


def pages(path: Path) -> list[str]:
    """Give the text of each page that LibreOffice makes of a .docx."""
    profile = f"-env:UserInstallation=file://{path.parent / 'libreoffice'}"
    # Tests that draw in this process leave it the fonts of pictures alone, and then LibreOffice has no other either.
    environment = {name: value for name, value in os.environ.items() if name != "FONTCONFIG_FILE"}
    words = (profile, "--headless", "--convert-to", "pdf", "--outdir", path.parent, path)
    done = run_judge(find_tool("soffice"), *words, env=environment)
    pdf = path.with_suffix(".pdf")
    assert pdf.exists(), f"LibreOffice made no PDF of the report: {done.stdout}{done.stderr}"
    return run_judge(find_tool("pdftotext"), "-layout", pdf, "-").stdout.split("\f")[:-1]
