"""The judges from outside that Word reports are held against: Microsoft's Open XML SDK, and LibreOffice's pages."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

_VALIDATOR = Path(__file__).parents[2] / "judges" / "node_modules" / ".bin" / "ooxml-validator"


def validated(path: Path) -> list[dict[str, Any]]:
    """Give what Microsoft's validator says against a .docx."""
    assert _VALIDATOR.exists(), (
        "Microsoft's validator is missing: run `npm install --prefix tests/judges --no-package-lock` (it needs Node.js)"
    )
    result = subprocess.run(  # noqa: S603 - a judge of our own choice
        [_VALIDATOR, path], capture_output=True, text=True, check=False, timeout=6000
    )
    assert result.returncode in {0, 1}, f"the validator could not run: {result.stdout}{result.stderr}"
    answer = json.loads(result.stdout)
    errors: list[dict[str, Any]] = answer["errors"]
    return errors


def pages(path: Path) -> list[str]:
    """Give the text of each page that LibreOffice makes of a .docx."""
    soffice, pdftotext = _program("soffice", "libreoffice-writer-nogui"), _program("pdftotext", "poppler-utils")
    profile = f"-env:UserInstallation=file://{path.parent / 'libreoffice'}"
    command = [soffice, profile, "--headless", "--convert-to", "pdf", "--outdir", str(path.parent), str(path)]
    # Tests that draw in this process leave it the fonts of pictures alone, and then LibreOffice has no other either.
    environment = {name: value for name, value in os.environ.items() if name != "FONTCONFIG_FILE"}
    subprocess.run(command, check=True, capture_output=True, timeout=6000, env=environment)  # noqa: S603 - a judge of our own choice
    pdf = path.with_suffix(".pdf")
    assert pdf.exists(), "LibreOffice made no PDF of the report"
    command = [pdftotext, "-layout", str(pdf), "-"]
    shown = subprocess.run(command, check=True, capture_output=True, text=True, timeout=600)  # noqa: S603 - the same
    return shown.stdout.split("\f")[:-1]


def _program(name: str, package: str) -> str:
    found = shutil.which(name)
    assert found, f"`{name}` is missing: install Debian's {package}"
    return found
