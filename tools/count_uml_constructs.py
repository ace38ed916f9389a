"""Print what became of each construct of UML models.

    python tools/count_uml_constructs.py MODEL...

A column for each file, a row for each construct: how many were read, read and noted (or kept in another form), and not
taken. What stands inside of something that is not taken counts with it; values and ends count with what they belong to.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from archgen.importers.foreign_import import ForeignFileError
from archgen.plugins.xmi.import_ledger import NOT_TAKEN, NOTED, TAKEN, ImportLedger
from archgen.plugins.xmi.uml_catalogue import TOOL_TAGS
from archgen.plugins.xmi.uml_index import UmlIndex, XmiDocument, get_kind, is_written_here, read_documents
from archgen.plugins.xmi.xmi_import import convert_documents

FATES = (TAKEN, NOTED, NOT_TAKEN)
ConstructFates = Counter[tuple[str, str]]
"""How often each construct had each fate."""


def count_constructs(file: Path) -> ConstructFates:
    """Return the fates of the constructs in a file. Raise ForeignFileError."""
    documents = read_documents([file])
    index = UmlIndex(documents)
    ledger = ImportLedger(index)
    convert_documents(documents, index, ledger)
    return Counter(
        (name, fate) for document in documents for name, fate in _list_fates(document, ledger) if fate in FATES
    )


def _list_fates(document: XmiDocument, ledger: ImportLedger) -> Iterator[tuple[str, str | None]]:
    for child in document.surroundings:
        name = f"`{child.tag}` of the tool" if child.tag in TOOL_TAGS else "stereotypes"
        yield name, ledger.get_fate(child)
    stack = list(document.models)
    while stack:
        element = stack.pop()
        fate = ledger.get_fate(element)
        if element.tag in TOOL_TAGS:
            yield f"`{element.tag}` of the tool", fate
        elif is_written_here(element) or fate is not None:
            yield f"`{get_kind(element) or element.tag}`", fate
            stack += element.children if fate != NOT_TAKEN else ()


def make_table(counts: Sequence[ConstructFates]) -> str:
    """Return a table in Markdown: what is read most stands first."""
    totals = sum(counts, ConstructFates())
    names = {name for name, _ in totals}

    def rank(name: str) -> tuple[int, int, str]:
        return -totals[name, TAKEN] - totals[name, NOTED], -totals[name, NOT_TAKEN], name

    heads = [chr(ord("A") + number) for number in range(len(counts))]
    lines = [f"| construct | {' | '.join(heads)} |", f"|---|{'---|' * len(heads)}"]
    for name in sorted(names, key=rank):
        cells = [_write_cell(each, name) for each in counts]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    sums = [" · ".join(str(sum(each[name, fate] for name in names)) for fate in FATES) for each in counts]
    return "\n".join([*lines, f"| **all** | {' | '.join(sums)} |"])


def _write_cell(counts: ConstructFates, name: str) -> str:
    numbers = [counts[name, fate] for fate in FATES]
    return " · ".join(map(str, numbers)) if any(numbers) else ""


def main(words: Sequence[str]) -> int:
    """Print the table of the files, and which file is which column."""
    counts: list[ConstructFates] = []
    for word in words:
        try:
            counts.append(count_constructs(Path(word)))
        except ForeignFileError as error:
            print(f"refused: {error.span}: {error.message}", file=sys.stderr)
        else:
            print(f"{chr(ord('A') + len(counts) - 1)}: {word}")
    print(make_table(counts))
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
