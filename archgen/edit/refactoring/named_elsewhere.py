"""What names elements outside of slices: the project's chapters, which are edited, and programs and signed texts, which are not."""

from __future__ import annotations

import re
from collections.abc import Iterator

from archgen.checking.reference_index import PATH_KINDS, Element
from archgen.diagnostics.source_span import Span
from archgen.diagnostics.suggested_fixes import TextEdit
from archgen.edit.element_edit import EditRefusedError, read_editable
from archgen.edit.refactoring.judged_version import JudgedVersion
from archgen.edit.refactoring.renamed_ids import RenamedIds
from archgen.link.reference_resolution import list_endings
from archgen.project.source_reading import PASS_FOLDER

_LINKED_OR_QUOTED = re.compile(r"\(#([a-z_]{1,40}):([^)\s]{1,300})\)|`([^`\s]{1,300})`")
_PROGRAM_ENDINGS = (".py", ".j2", ".jinja")
_PROGRAM_FOLDERS = (PASS_FOLDER.rstrip("/"), "backends", "plugins")
_MOST_PROGRAM_LINES = 10


def list_chapter_edits(version: JudgedVersion, renamed: RenamedIds) -> Iterator[TextEdit]:
    """Yield the edits of links and of ids between backticks in the project's own chapters.

    What between backticks may mean several elements, of which not all are renamed, stays.
    """
    elements_by_ending: dict[str, dict[Element, None]] = {}
    for name in version.index.names:
        if name.is_declaration and not name.id.startswith("<"):
            endings = list_endings(name.id) if name.kind in PATH_KINDS else (name.id,)
            for ending in endings:
                elements_by_ending.setdefault(ending, {})[name.kind, name.id] = None
    for file in version.project.chapters.texts:
        try:
            _, text = read_editable(version.project, file)
        except EditRefusedError:  # a packed file holds it
            continue
        for number, line in enumerate(re.split(r"\r\n|\n|\r", text), start=1):
            for match in _LINKED_OR_QUOTED.finditer(line):
                group = 2 if match[2] else 3
                elements = [(match[1], match[2])] if match[2] else list(elements_by_ending.get(match[3], ()))
                texts = [_take_end(renamed.map_element(each)[1], match[group], each[0]) for each in elements]
                if len(set(texts)) == 1 and (new_text := texts[0]) != match[group]:
                    span = Span(file, number, match.start(group) + 1, number, match.end(group) + 1)
                    yield TextEdit(span, new_text)


def _take_end(new_id: str, written: str, kind: str) -> str:
    return ".".join(new_id.split(".")[-len(written.split(".")) :]) if kind in PATH_KINDS else new_id


def list_unedited(version: JudgedVersion, renamed: RenamedIds) -> Iterator[str]:
    """Yield sentences on what names what is renamed and is not edited: own passes and backends, what was signed."""
    words = {
        old_id.rpartition(".")[2]
        for (_, old_id), (_, new_id) in renamed.pairs.items()
        if old_id.rpartition(".")[2] != new_id.rpartition(".")[2]
    }
    files = version.project.loaded_project.files
    lines: list[str] = []
    for top in _PROGRAM_FOLDERS:
        for folder, _, names in files.walk_folders(top) if files.has_path(top) else ():
            for name in sorted(names):
                path = "/".join(filter(None, (top, folder, name)))
                data = files.fetch_bytes(path) if name.endswith(_PROGRAM_ENDINGS) else None
                for number, line in enumerate(data.splitlines() if isinstance(data, bytes) else (), start=1):
                    if words.intersection(re.findall(r"\w+", line.decode(errors="replace"))):
                        lines.append(f"{path}:{number}")
    if lines:
        more = f" and {len(lines) - _MOST_PROGRAM_LINES} more" if len(lines) > _MOST_PROGRAM_LINES else ""
        yield f"programs are not edited, and hold the word: {', '.join(lines[:_MOST_PROGRAM_LINES])}{more}"
    is_type = any(kind == "type" for kind, _ in renamed.pairs)
    for each in version.project.architecture.agreements.values():
        versions = each.signed.versions if each.signed else {}
        named = [("output", path) for paths in versions.values() for path in paths]
        if each.signed and (is_type or any(renamed.map_element(element) != element for element in named)):
            command = (
                f"archgen interfaces --between {' '.join(each.pair)} --signed {each.signed.tag or each.signed.revision}"
            )
            yield f"what was signed is not edited: `{command}` says what is called otherwise since"
