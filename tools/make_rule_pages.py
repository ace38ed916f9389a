"""Write into docs/rules/NAME.md what follows from the rule, and the index of the rules; and what is counted of the generators."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path

from generator_table import PAGE, renew_table

from archgen.findings import rule_pages
from archgen.findings.rule_table import COMPARISON_RULES, FAILED_RULE, index_rules
from archgen.pipeline import SHIPPED_RULES
from archgen.views.generation.architecture_needs import GENERATION_RULES

FOLDER = Path(__file__).resolve().parent.parent / "docs" / "rules"


def pages() -> Mapping[str, str]:
    """Give the text of every page by its file name."""
    rules = index_rules((*SHIPPED_RULES, FAILED_RULE, *COMPARISON_RULES, *GENERATION_RULES))
    return {
        "README.md": rule_pages.format_rule_index(rules),
        **{f"{name}.md": rule_pages.rule_page_to_markdown(rule) for name, rule in rules.items()},
    }


def main() -> int:
    """Write the pages; nothing where a page is that of no rule."""
    wanted = pages()
    if strange := sorted({page.name for page in FOLDER.glob("*.md")} - wanted.keys()):
        print(f"pages of no rule, to be renamed or removed: {', '.join(strange)}", file=sys.stderr)
        return 1
    for name, text in wanted.items():
        (FOLDER / name).write_text(text, encoding="utf-8", newline="\n")
    print(f"{len(wanted)} pages in {FOLDER}")
    PAGE.write_text(renew_table(PAGE.read_text(encoding="utf-8")), encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
