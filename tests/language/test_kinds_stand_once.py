"""Kinds and sections are named in the description of the language: a list of them elsewhere has a reason that stands here."""

from __future__ import annotations

import ast
import json
from collections.abc import Iterator
from pathlib import Path

from archgen.language.language_tables import ANNOTATED_KINDS, KEYS
from tests.running import ROOT

NAMES = frozenset((*KEYS, *KEYS["slice"], "components", "inputs", "outputs", "composed"))
LEAST = 6
"""So many names of kinds or sections make a list of them."""
REASONS = {
    "cli/list_command.py": "kinds of which a selector names some",
    "compare/kinds/__init__.py": "the order in which kinds are recognised under other ids",
    "plugins/xmi/xmi_import.py": "the files that a model becomes",
    "link/declare/element_declaration.py": "the class of each kind",
    "link/variants/element_removal.py": "how what is gone is taken out of each section",
    "lsp/element_navigation.py": "the symbol of an editor for each kind",
    "lsp/element_hints.py": "the colour of an editor for each kind",
    "model/document_chapters.py": "chapters, some of which are called like sections",
    "views/changes/site_changes.py": "kinds with a page of their own",
    "views/elements/element_card.py": "the function that makes each card",
    "views/elements/element_names.py": "the order in which an id that several kinds share is found, and what is named otherwise",
    "views/explorer/map_shapes.py": "tables of the explorer",
    "views/picture_shapes.py": "kinds of pictures, some of which are called like kinds of elements",
    "views/offered_names.py": "sections of which something else than each title is offered",
    "views/pages/report_outline.py": "chapters, some of which are called like sections",
    "views/records/record_sources.py": "what the record takes from elsewhere than from a field, by part",
}


def _list_literals(file: Path) -> Iterator[ast.expr]:
    text = file.read_text(encoding="utf-8")
    if sum(f'"{name}"' in text or f"'{name}'" in text for name in NAMES) < LEAST:
        return  # most files: they need not be parsed
    for node in ast.walk(ast.parse(text)):
        items = node.elts if isinstance(node, (ast.Tuple, ast.List, ast.Set)) else []
        items = [key for key in node.keys if key] if isinstance(node, ast.Dict) else items
        texts = [item.value for item in items if isinstance(item, ast.Constant)]
        names = NAMES.intersection(text for text in texts if isinstance(text, str))
        if isinstance(node, ast.expr) and len(names) >= LEAST and len(names) * 5 >= len(texts) * 3:
            yield node


def test_every_list_of_kinds_has_a_reason_and_every_reason_a_list() -> None:
    package = ROOT / "archgen"
    files = (file for file in package.rglob("*.py") if file.parent != package / "language")
    listing = {file.relative_to(package).as_posix() for file in files if any(_list_literals(file))}
    assert sorted(listing - REASONS.keys()) == [], "ask archgen.language, or say why not"
    # Where all plug-ins are taken out, reasons for theirs are none.
    kept = {file for file in REASONS if not file.startswith("plugins/") or (package / "plugins").is_dir()}
    assert sorted(kept - listing) == [], "no list of kinds stands there any more"


def test_the_schema_of_backends_knows_every_kind_with_hints() -> None:
    schema = json.loads((ROOT / "schemas" / "backend.schema.json").read_text(encoding="utf-8"))
    kinds = schema["properties"]["hints_schema"]["propertyNames"]["enum"]
    assert sorted(kinds) == sorted([*ANNOTATED_KINDS, "parameter", "any"])
