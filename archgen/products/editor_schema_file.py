"""Write the JSON Schema of a project for editors, and renew it where it is archgen's own and nobody keeps it."""

from __future__ import annotations

import json
from pathlib import Path

from archgen import resources
from archgen.emit import file_tree
from archgen.emit.data import editor_schema
from archgen.findings.rule_pages import parse_rule_page
from archgen.pipeline import ALL_RULES, CheckedProject
from archgen.views import offered_names

SCHEMA_FILE = ".vscode/archgen.schema.json"
"""Where `archgen init` lets editors look for it, relative to the project's folder."""
_MARK = "archgen schema wrote this file: it is made again when names change, and no file to edit or to keep in git"


def render_schema(checked_project: CheckedProject) -> bytes:
    """Return the schema of a project, as one line of JSON."""
    language_schema = resources.resource_path("schemas", "archgen.schema.json").read_bytes()
    summaries = {rule.name: parse_rule_page(rule).summary for rule in ALL_RULES if not rule.fixed}
    names = offered_names.list_offered_names(checked_project.architecture)
    schema = editor_schema.make_editor_schema(language_schema, names, summaries)
    return f"{json.dumps({'$comment': _MARK} | schema, separators=(',', ':'))}\n".encode()
