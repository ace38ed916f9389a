"""Write the JSON Schema of a project for editors."""

from __future__ import annotations

import json
import posixpath
from pathlib import Path

from archgen.edit.element_edit import SCHEMA_LINE_PATTERN
from archgen.emit import file_tree
from archgen.emit.data import editor_schema
from archgen.findings.rule_pages import summarise_rule
from archgen.pipeline import CheckedProject, index_all_rules
from archgen.products import editor_schema_marks
from archgen.products.product_writing import write_product_file
from archgen.project.project_search import name_path_from
from archgen.regular_files import holds_bytes
from archgen.views.offered_names import OfferedNames

_LANGUAGE_ID = '"$id": "urn:archgen:schema:1"'
"""Near the beginning of the schema without names, which older versions of `archgen init` wrote."""


def render_schema(checked_project: CheckedProject) -> bytes:
    """Return the schema of a project, as one line of JSON."""
    return render_names(
        editor_schema_marks.list_project_names(checked_project), editor_schema_marks.digest_texts(checked_project)
    )


def render_names(names: OfferedNames, text_digest: str) -> bytes:
    """Return the schema that offers these names, made from files with this digest."""
    summaries = {rule.name: summarise_rule(rule) for rule in index_all_rules().values() if not rule.fixed}
    language_schema = editor_schema_marks.language_schema_path().read_bytes()
    schema = editor_schema.make_editor_schema(language_schema, names, summaries)
    mark = editor_schema_marks.format_mark(text_digest, editor_schema_marks.digest_names(names))
    # ASCII: names may hold anything, and editors read the file in any encoding.
    return f'{mark}",{json.dumps(schema, separators=(",", ":"))[1:]}\n'.encode()


def write_schema(checked_project: CheckedProject, target: Path | None = None) -> tuple[Path, bool]:
    """Write the schema of a project, by default to its place; return where it is, and whether it was another before.

    Raise OutputError where a link or a file of somebody else stands there.
    """
    path = target or checked_project.root / editor_schema_marks.SCHEMA_FILE
    if path.is_symlink() or (target is None and path.parent.is_symlink()):
        raise file_tree.OutputError(f"{path} is a link", "remove it, or give another file with `-o`")
    content = render_schema(checked_project)
    head = editor_schema_marks.read_head(path)
    if head is not None and not head.startswith(editor_schema_marks.MARK) and _LANGUAGE_ID not in head:
        msg = f"{path} is no schema that archgen wrote"
        raise file_tree.OutputError(msg, "remove it, or give another file with `-o`")
    if head is not None and holds_bytes(path, content):
        return path, False
    write_product_file(checked_project, path, content)
    return path, True


def explain_set_up(checked_project: CheckedProject, path: Path) -> str | None:
    """Return what is still to be done so that editors find a schema that was written; None if nothing is."""
    root = checked_project.root
    address = name_path_from(root, path)
    schema_lines = {
        file: match[1]
        for file in checked_project.yaml_files
        if (match := SCHEMA_LINE_PATTERN.match(checked_project.sources.text_of(file) or ""))
    }
    # Editors follow the line before their settings.
    for file, line_address in schema_lines.items():
        if posixpath.normpath(posixpath.join(posixpath.dirname(file), line_address)) != address:
            wanted = posixpath.relpath(address, posixpath.dirname(file) or ".")
            return f"the first line of {file} names another schema: write `# yaml-language-server: $schema={wanted}`"
    if schema_lines or (root / ".vscode/settings.json").exists():
        return None
    return f"editors find it by the line `# yaml-language-server: $schema={address}` on top of a file, or by a setting"
