"""AADL texts written to files and imported, for tests."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from archgen.importers.foreign_import import ForeignImport
from archgen.plugins.aadl.aadl_import import read_aadl
from archgen.plugins.aadl.package_parsing import ParsedText, parse_text

MODELS = Path(__file__).with_name("models")


def parse_package(body: str) -> ParsedText:
    """Return what the parser makes of the body of a package `p` that begins in line 2 of `m.aadl`."""
    return parse_text("m.aadl", f"package p public\n{body}\nend p;\n")


def list_faults(text: str) -> list[str]:
    """Return the faults of a text as `line:column message`."""
    return [f"{fault.span.line}:{fault.span.column} {fault.message}" for fault in parse_text("m.aadl", text).faults]


def import_text(folder: Path, text: str) -> ForeignImport:
    """Import a text as the only file of a model."""
    (folder / "m.aadl").write_text(text, encoding="utf-8")
    return read_aadl([folder / "m.aadl"])


def import_package(folder: Path, body: str) -> ForeignImport:
    """Import a package `p` with this body."""
    return import_text(folder, f"package p\npublic\n{body}\nend p;\n")


def merge_slices(imported: ForeignImport) -> dict[str, Any]:
    """Return the sections of all slices."""
    return {key: section for data in imported.slices.values() for key, section in data.items()}


def tell_notes(imported: ForeignImport) -> list[str]:
    """Return the notes as `line:column kind: message`."""
    return [f"{note.span.line}:{note.span.column} {note.kind}: {note.message}" for note in imported.notes]
