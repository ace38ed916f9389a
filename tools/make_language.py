"""Write what follows from the description in `language/`: JSON Schemas, the tables of `archgen/language/`, those of docs."""

from __future__ import annotations

import json
import sys
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path

from language_comparison import find_comparison_faults, make_comparison_tables
from language_description import DescriptionError, add_rule_settings, find_faults, load_description, make_schema
from language_page import renew_page
from language_record import load_record, make_record_schema, make_record_tables
from language_tables import format_tables, make_tables

from archgen.compare.kinds import KIND_ORDER
from archgen.findings.rule_table import index_rules
from archgen.pipeline import SHIPPED_RULES

ROOT = Path(__file__).resolve().parents[1]


def make_files() -> Mapping[Path, str]:
    """Return the text of each generated file. Raise DescriptionError for a description that says too little."""
    description = load_description()
    add_rule_settings(description, index_rules(SHIPPED_RULES))
    if faults := [*find_faults(description), *find_comparison_faults(description)]:
        message = "\n".join(faults)
        raise DescriptionError(message)
    record = load_record(description)
    tables = {**make_tables(description), **make_comparison_tables(description), **make_record_tables(record)}
    page = ROOT / "docs" / "language.md"
    backend_schema = ROOT / "schemas" / "backend.schema.json"
    comparison_schema = ROOT / "schemas" / "diff.schema.json"
    return {
        page: renew_page(page.read_text(encoding="utf-8"), description),
        ROOT / "schemas" / "archgen.schema.json": json.dumps(make_schema(description), indent=2) + "\n",
        comparison_schema: _renew_kinds(comparison_schema.read_text(encoding="utf-8")),
        backend_schema: _renew_hint_kinds(backend_schema.read_text(encoding="utf-8"), description.kinds_with("hints")),
        ROOT / "archgen" / "language" / "tables.json": format_tables(tables),
        ROOT / "schemas" / "resolved.schema.json": json.dumps(make_record_schema(record), indent=2) + "\n",
    }


def _renew_kinds(text: str) -> str:
    """Return the schema of comparisons with the kinds of elements whose changes they tell."""
    schema = json.loads(text)
    schema["$defs"]["change"]["properties"]["sort"]["enum"] = list(KIND_ORDER)
    return json.dumps(schema, indent=2) + "\n"


def _renew_hint_kinds(text: str, kinds: Sequence[str]) -> str:
    """Return the schema of backends with the kinds of elements that may have hints for one."""
    before, start, rest = text.partition('"propertyNames": {\n        "enum": [\n')
    names = textwrap.fill(", ".join(json.dumps(kind) for kind in (*kinds, "parameter", "any")), 108)
    return before + start + textwrap.indent(names, " " * 10) + rest[rest.index("\n        ]\n") :]


def main() -> int:
    """Write the files that differ."""
    try:
        files = make_files()
    except DescriptionError as error:
        print(error, file=sys.stderr)
        return 1
    for path, text in files.items():
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8", newline="\n")
            print(f"wrote {path.relative_to(ROOT)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
