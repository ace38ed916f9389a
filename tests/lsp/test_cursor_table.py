"""220 places of a cursor in four projects, with where the name there is declared, what its card is, and what is offered half way."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests import repositories
from tests.lsp.client import Client
from tests.running import ROOT

PLACES: dict[str, list[tuple[str, str, list[str], str]]] = yaml.safe_load(
    (Path(__file__).parent / "cursor_places.yaml").read_text(encoding="utf-8")
)
_SHORT = 5
_NEAR = 5
_LEAST_NEAR = 0.9
"""The share of half-typed names that stand among the first five that an editor shows."""


def find_name(text: str, line: int, column: int) -> tuple[int, int]:
    """Return where the name at a place begins and ends in its line, columns from 0: a path, or a title of several words."""
    row = text.split("\n")[line - 1]
    start, end = column - 1, column - 1
    while start and (row[start - 1].isalnum() or row[start - 1] in "_.-"):
        start -= 1
    while end < len(row) and (row[end].isalnum() or row[end] in "_.- "):
        end += 1
    return start, end - (len(row[start:end]) - len(row[start:end].rstrip()))


def has_letters(label: str, typed: str) -> bool:
    """Whether an editor shows a label: the letters that were typed stand in it, in this order."""
    rest = iter(label)
    return all(letter in rest for letter in typed)


def find_rank(client: Client, file: str, line: int, column: int) -> int:
    """Return at which place the name is offered when half of its last word is typed; a large number where it is not."""
    text = (client.folder / file).read_text(encoding="utf-8")
    rows = text.split("\n")
    start, end = find_name(text, line, column)
    name = rows[line - 1][start:end]
    last = name.rpartition(".")[2]
    # Of a number such as R-72 all but its last digit, else half.
    known = len(last) - 1 if len(last) <= _SHORT else len(last) // 2
    typed = name[: len(name) - len(last)] + last[:known]
    rows[line - 1] = rows[line - 1][:start] + typed + rows[line - 1][end:]
    client.write(file, "\n".join(rows))
    items: list[Any] = client.at("completion", file, line, start + len(typed) + 1)["items"]
    client.write(file, text)
    labels = [item["label"] for item in sorted(items, key=lambda item: item["sortText"])]
    labels = [label for label in labels if has_letters(label.casefold(), typed.casefold())]
    found = (rank for rank, label in enumerate(labels, 1) if label == name or label.endswith(f".{name}"))
    return next(found, 10_000)


@pytest.mark.slow
@pytest.mark.parametrize("name", PLACES)
def test_places_of_the_table(tmp_path: Path, name: str) -> None:
    folder = tmp_path / "project"
    shutil.copytree(ROOT / name, folder, ignore=shutil.ignore_patterns("archgen-out"))
    folder = repositories.repository(folder, {}).resolve()
    wrong: list[str] = []
    ranks: dict[str, int] = {}
    with Client(folder) as client:
        for path in sorted(folder.rglob("archgen.yaml")):
            client.open(os.path.relpath(path, folder))
            client.wait_for(os.path.relpath(path, folder))
        for place, word, declared, head in PLACES[name]:
            file, line, column = place.split(":")
            text = client.open(file) if file not in client.diagnostics else (folder / file).read_text("utf-8")
            assert text.split("\n")[int(line) - 1][int(column) - 1 :].startswith(word), place
            found: Any = client.at("definition", file, int(line), int(column)) or ()
            places = [
                f"{os.path.relpath(each['uri'].removeprefix('file://'), folder)}:{each['range']['start']['line'] + 1}"
                f":{each['range']['start']['character'] + 1}"
                for each in found
            ]
            card: Any = client.at("hover", file, int(line), int(column))
            shown = card["contents"]["value"].split("\n")[0].replace("*", "").replace("`", "") if card else ""
            if places != declared or not (shown.startswith(head) if head else not shown.startswith("component")):
                wrong.append(f"{place} {word}: {places}, {shown}")
            if declared:
                ranks[f"{place} {word}"] = find_rank(client, file, int(line), int(column))
        assert client.log == []
    assert wrong == []
    near = [each for each, rank in ranks.items() if rank <= _NEAR]
    assert len(near) >= _LEAST_NEAR * len(ranks), {each: rank for each, rank in ranks.items() if each not in near}
