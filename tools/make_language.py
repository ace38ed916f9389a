"""Write what follows from the description in `language/`: the JSON Schema, the tables of `archgen/language/`, those of docs."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path

from language_description import DescriptionError, add_rule_settings, find_faults, load_description, make_schema
from language_page import renew_page
from language_tables import make_tables

from archgen.findings.rule_table import index_rules
from archgen.pipeline import SHIPPED_RULES

ROOT = Path(__file__).resolve().parents[1]


def make_files() -> Mapping[Path, str]:
    """Return the text of each generated file. Raise DescriptionError for a description that says too little."""
    description = load_description()
    add_rule_settings(description, index_rules(SHIPPED_RULES))
    if faults := list(find_faults(description)):
        message = "\n".join(faults)
        raise DescriptionError(message)
    page = ROOT / "docs" / "language.md"
    return {
        page: renew_page(page.read_text(encoding="utf-8"), description),
        ROOT / "schemas" / "archgen.schema.json": json.dumps(make_schema(description), indent=2) + "\n",
        ROOT / "archgen" / "language" / "language_tables.py": make_tables(description),
    }


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
