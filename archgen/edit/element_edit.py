"""Plan how to add an element to a project: find its place, make the new text, prove it. Nothing is written here."""

from __future__ import annotations

import codecs
import difflib
import posixpath
import re
from collections.abc import Iterator
from dataclasses import dataclass

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.edit import edit_proof, text_insertion
from archgen.edit.element_place import ElementPlace
from archgen.edit.new_element import NewElement
from archgen.edit.text_insertion import CannotInsertError
from archgen.pipeline import CheckedProject
from archgen.syntax.project_files import FileRefusal

SCHEMA_LINE_PATTERN = re.compile(r"\A\s*# yaml-language-server: \$schema=(\S+)")


class EditRefusedError(Exception):
    """The element is not added. `message` says why, `by_hand` what a person may write instead; `errors` are shown."""

    def __init__(self, message: str, by_hand: str = "", errors: tuple[Diagnostic, ...] = ()) -> None:
        super().__init__(message)
        self.message = message
        self.by_hand = by_hand
        self.errors = errors


@dataclass(frozen=True, slots=True)
class FileEdit:
    """One file's bytes before (None: the file is new) and after, and the line at which the element begins.

    `renamed_nodes` are the old and new ids of nodes that components bring along, where the edit makes them longer.
    """

    file: str
    old_content: bytes | None
    new_content: bytes
    line: int
    renamed_nodes: tuple[tuple[str, str], ...] = ()

    def unified_diff(self) -> Iterator[str]:
        """Yield a unified diff, as git writes it."""
        old_lines = (self.old_content or b"").decode().splitlines()
        name = "/dev/null" if self.old_content is None else f"a/{self.file}"
        return difflib.unified_diff(
            old_lines, self.new_content.decode().splitlines(), name, f"b/{self.file}", lineterm=""
        )


def plan_edit(checked_project: CheckedProject, place: ElementPlace, element: NewElement, element_id: str) -> FileEdit:
    """Return the edit that adds an element; `element_id` is its complete id. Raise EditRefusedError."""
    old_content, text = (
        (None, _schema_line(checked_project, place)) if place.is_new_file else _read_file(checked_project, place)
    )
    new_text = _insert_element(place, element, text)
    # Two proofs: `adds_only_element` looks at the file alone, this one at the whole project with it.
    consequences = edit_proof.find_consequences(
        checked_project, place.file, new_text.removeprefix(_BYTE_ORDER_MARK), element_id
    )
    if consequences.errors:
        message = "with it the project would have errors that it does not have now"
        raise EditRefusedError(message, errors=consequences.errors)
    if consequences.changed_elements:
        names = ", ".join(f"`{name}`" for name in consequences.changed_elements[:3]) + (
            " and others" if consequences.changed_elements[3:] else ""
        )
        message = f"it would change what other elements mean: {names}"
        raise EditRefusedError(message, "Choose another id, or write out the references that now lead to it.")
    line = _first_changed_line(text, new_text)
    return FileEdit(place.file, old_content, new_text.encode(), line, consequences.renamed_nodes)


_BYTE_ORDER_MARK = codecs.BOM_UTF8.decode()


def _read_file(checked_project: CheckedProject, place: ElementPlace) -> tuple[bytes, str]:
    """Read a file of the project. Raise EditRefusedError."""
    data = checked_project.loaded_project.files.fetch_bytes(place.file)
    if isinstance(data, FileRefusal):
        message = f"{place.file} cannot be read: {data.message}"
        raise EditRefusedError(message)
    try:
        return data, data.decode()
    except UnicodeDecodeError:
        message = f"{place.file} is not UTF-8"
        raise EditRefusedError(message) from None


def _schema_line(checked_project: CheckedProject, place: ElementPlace) -> str:
    """Return the first line of a new file: the schema comment, where the project's other files have one."""
    for file in checked_project.yaml_files:
        match = SCHEMA_LINE_PATTERN.match(checked_project.sources.text_of(file) or "")
        # A relative path to the schema has to be rewritten for the new file's folder.
        if match and "://" not in match[1] and not match[1].startswith(("/", "\\")):
            schema = posixpath.join(posixpath.dirname(file), match[1])
            address = posixpath.relpath(schema, posixpath.dirname(place.file) or ".")
            return f"# yaml-language-server: $schema={address}\n"
        if match:
            return f"# yaml-language-server: $schema={match[1]}\n"
    return ""


def _insert_element(place: ElementPlace, element: NewElement, text: str) -> str:
    """Return the text with the element inserted, the first proposal that proves right. Raise EditRefusedError."""
    byte_order_mark = _BYTE_ORDER_MARK if text.startswith(_BYTE_ORDER_MARK) else ""
    plain_text = text.removeprefix(_BYTE_ORDER_MARK)
    try:
        for candidate in text_insertion.propose_texts(place.file, plain_text, place.path, element):
            if edit_proof.adds_only_element(plain_text, candidate, place.path, element):
                return byte_order_mark + candidate
    except CannotInsertError as error:
        raise EditRefusedError(str(error), _explain_by_hand(place, element)) from None
    message = f"the text of {place.file} is written in a way in which more than the new element would change"
    raise EditRefusedError(message, _explain_by_hand(place, element))


def _explain_by_hand(place: ElementPlace, element: NewElement) -> str:
    """Return what a person may write into the file instead."""
    lines = element.nested_below(place.path).to_block("    ", 2)
    return "\n".join((f"Write it by hand into {place.file}, or into a file of its own:", "", *lines))


def _first_changed_line(old_text: str, new_text: str) -> int:
    """Return the number of the first line that differs and is not blank."""
    old_lines, new_lines = old_text.splitlines(), new_text.splitlines()
    unchanged = next(
        (
            index
            for index, (old_line, new_line) in enumerate(zip(old_lines, new_lines, strict=False))
            if old_line != new_line
        ),
        min(len(old_lines), len(new_lines)),
    )
    return next((index + 1 for index in range(unchanged, len(new_lines)) if new_lines[index].strip()), unchanged + 1)
