"""UML models written short, and read."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from archgen.importers.foreign_import import ForeignImport
from archgen.plugins.xmi.xmi_import import read_xmi

_HEAD = (
    '<xmi:XMI xmi:version="2.1" xmlns:xmi="http://schema.omg.org/spec/XMI/2.1" '
    'xmlns:uml="http://schema.omg.org/spec/UML/2.1"><uml:Model xmi:type="uml:Model" xmi:id="m" name="Lab">'
)
_FOOT = "</uml:Model></xmi:XMI>"


def write_model(contents: str) -> str:
    """Return a model with elements in it."""
    return f"{_HEAD}\n{contents}\n{_FOOT}"


def read_model(folder: Path, contents: str, name: str = "lab.xmi") -> ForeignImport:
    """Write a model into a folder and read it."""
    file = folder / name
    file.write_text(write_model(contents), encoding="utf-8")
    return read_xmi([file])


def merge_sections(imported: ForeignImport) -> dict[str, Any]:
    """Return the sections of all slices."""
    return {key: value for each in imported.slices.values() for key, value in each.items()}


def tell_notes(imported: ForeignImport) -> list[str]:
    """Return the notes on one line each."""
    return [f"{each.span.line} {each.kind} {each.fate}: {each.message}" for each in imported.notes]
