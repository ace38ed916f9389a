"""`archgen lsp` from the command line."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

from archgen.cli import lsp_command
from tests.running import archgen, archgen_here


def test_without_the_extra_it_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)
    done = archgen_here("lsp", cwd=tmp_path, status=2)
    assert b'archgen lsp needs pygls: pip install "archgen[lsp]"' in done.stderr


def test_editors_may_say_that_they_use_pipes(tmp_path: Path) -> None:
    assert lsp_command.command.name == "lsp"
    done = archgen("lsp", "--stdio", cwd=tmp_path)
    assert done.stdout == b""
