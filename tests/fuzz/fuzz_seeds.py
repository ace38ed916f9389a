"""What the fuzzer begins with: the fixtures of this repository, in files, on pages, and as texts in the code of tests."""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import yaml
from lxml import etree

from tests.fuzz.fuzz_mutations import SEPARATOR, write_zip

ROOT = Path(__file__).resolve().parents[2]
MAX_SEED_BYTES = 6_000


def list_files(*patterns: str) -> list[bytes]:
    """Return the contents of files of the repository that are not too large."""
    paths = [path for pattern in patterns for path in sorted(ROOT.glob(pattern)) if path.is_file()]
    return [path.read_bytes() for path in paths if 0 < path.stat().st_size <= MAX_SEED_BYTES]


@cache
def list_code_texts(*folders: str) -> tuple[str, ...]:
    """Return the texts of several lines, or of markup, that stand in the Python code of some folders or modules."""
    paths = [
        path
        for folder in folders
        for path in ([ROOT / folder] if folder.endswith(".py") else sorted((ROOT / folder).rglob("*.py")))
    ]
    found: dict[str, None] = {}
    for path in paths:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and len(node.value) <= MAX_SEED_BYTES:
                found[textwrap.dedent(node.value)] = None
    return tuple(found)


def choose_texts(choose: Callable[[str], bool], *folders: str) -> list[bytes]:
    """Return those texts of `list_code_texts` that a function chooses."""
    return [text.encode("utf-8", "replace") for text in list_code_texts(*folders) if choose(text)]


@cache
def list_page_projects() -> tuple[bytes, ...]:
    """Return the projects of one file on the pages of rules: each breaks one rule, or none."""
    blocks = [
        block
        for page in sorted((ROOT / "docs").rglob("*.md"))
        for block in re.findall(r"```yaml\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    ]
    return tuple(
        dict.fromkeys(
            block.encode()
            for block in blocks
            if re.search(r"(?m)^(groups|nodes|component_types|archgen|types)\b", block)
        )
    )


def list_projects() -> list[bytes]:
    """Return projects of one file: those of pages, and the examples."""
    return [*list_page_projects(), *list_files("examples/*/archgen.yaml", "examples/*/*.yaml")]


def list_words_of_selectors() -> list[bytes]:
    """Return selectors: those of tests and pages."""
    texts = list_code_texts("tests/selector_cases.py", "tests/model")
    return [text.encode("utf-8", "replace") for text in texts if 0 < len(text) < 80 and "\n" not in text]


def join_parts(*parts: bytes) -> bytes:
    """Return an input of several parts."""
    return SEPARATOR.join(parts)


def cross_parts(*lists: Sequence[bytes], limit: int = 400) -> list[bytes]:
    """Return inputs of several parts: each of the longest list once, with those of the others in turn."""
    length = min(limit, max(map(len, lists)))
    return [join_parts(*(parts[index % len(parts)] for parts in lists)) for index in range(length)]


def number_choices(count: int) -> list[bytes]:
    """Return the first part of inputs that choose what is done with the rest."""
    return [str(number).encode() for number in range(count)]


def list_workbooks() -> Iterator[bytes]:
    """Yield workbooks and documents: fixtures of the tables."""
    from tests.workbooks import make_document, make_workbook

    yield from list_files("tests/plugins/tables/partner_tables/*.xlsx", "tests/plugins/tables/partner_tables/*.docx")
    for text in list_code_texts("tests/plugins/tables/test_workbook_sheets.py"):
        if "<sheetData>" in text:
            yield make_workbook({"S": text}, "<si><t>Group</t></si><si><t>Component</t></si>")
    cells = [
        ("Group", "Component", "Input", "From", "Rate"),
        ("a", "x", "in", "b.y.out", "10 Hz"),
        ("b", "y", "", "", ""),
    ]
    rows = "".join(
        f'<row r="{line}">'
        + "".join(
            f'<c r="{"ABCDE"[column]}{line}" t="inlineStr"><is><t>{text}</t></is></c>'
            for column, text in enumerate(row)
        )
        + "</row>"
        for line, row in enumerate(cells, 1)
    )
    yield make_workbook({"S": f"<sheetData>{rows}</sheetData>"})
    table = "".join(
        "<w:tr>" + "".join(f"<w:tc><w:p><w:r><w:t>{text}</w:t></w:r></w:p></w:tc>" for text in row) + "</w:tr>"
        for row in cells
    )
    yield make_document(f"<w:tbl>{table}</w:tbl>")


def list_launch_yaml(texts: Sequence[bytes]) -> Iterator[bytes]:
    """Yield launch files in XML as YAML: elements are lists below their tags."""
    for text in texts:
        root = etree.fromstring(text, etree.XMLParser(recover=True, resolve_entities=False))
        if root is not None:
            yield yaml.safe_dump(
                {"launch": [_entity(child) for child in root if isinstance(child.tag, str)]}, sort_keys=False
            ).encode()


def _entity(element: Any) -> dict[str, Any]:  # noqa: ANN401 - an element of lxml
    below: dict[str, Any] = {str(name): str(value) for name, value in element.attrib.items()}
    for child in element:
        if isinstance(child.tag, str):
            below.setdefault(f"{child.tag}", []) if not isinstance(below.get(child.tag), str) else None
            held = below.get(child.tag)
            if isinstance(held, list):
                held.append(_entity(child)[child.tag])
    return {str(element.tag): below}


def list_archives(name: str, contents: Sequence[bytes]) -> list[bytes]:
    """Return archives of one member each."""
    return [write_zip([(name, content)]) for content in contents]
