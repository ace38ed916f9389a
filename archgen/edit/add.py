"""Plan how to add an element to a project: find its place, make the new text, prove it. Nothing is written here."""

from __future__ import annotations

import codecs
import difflib
import posixpath
import re
from collections.abc import Iterator
from dataclasses import dataclass

from archgen.diagnostic import Diagnostic
from archgen.edit import insertion, proof
from archgen.edit.element import Element
from archgen.edit.insertion import CannotInsertError
from archgen.edit.place import Place
from archgen.pipeline import Checked
from archgen.syntax.files import Refusal

_MODELINE = re.compile(r"\A\s*# yaml-language-server: \$schema=(\S+)")


class RefusedError(Exception):
    """The element is not added. `message` says why, `by_hand` what a person may write instead; `errors` are shown."""

    def __init__(self, message: str, by_hand: str = "", errors: tuple[Diagnostic, ...] = ()) -> None:
        super().__init__(message)
        self.message = message
        self.by_hand = by_hand
        self.errors = errors


@dataclass(frozen=True, slots=True)
class Edit:
    """One file's bytes before (None: the file is new) and after, and the line at which the element begins."""

    file: str
    before: bytes | None
    after: bytes
    line: int

    def diff(self) -> Iterator[str]:
        """Yield a unified diff, as git writes it."""
        old = (self.before or b"").decode().splitlines()
        name = "/dev/null" if self.before is None else f"a/{self.file}"
        return difflib.unified_diff(old, self.after.decode().splitlines(), name, f"b/{self.file}", lineterm="")


def add(checked: Checked, place: Place, element: Element, own: str) -> Edit:
    """Return the edit that adds an element; `element_id` is its complete id. Raise EditRefusedError."""
    before, text = (None, _head(checked, place)) if place.new else _read(checked, place)
    after = _text(place, element, text)
    # Two proofs: `adds_only_element` looks at the file alone, this one at the whole project with it.
    found = proof.consequences(checked, place.file, after.removeprefix(_BOM), own)
    if found.errors:
        message = "with it the project would have errors that it does not have now"
        raise RefusedError(message, errors=found.errors)
    if found.changed:
        several = ", ".join(f"`{name}`" for name in found.changed[:3]) + (" and others" if found.changed[3:] else "")
        message = f"it would change what other elements mean: {several}"
        raise RefusedError(message, "Choose another id, or write out the references that now lead to it.")
    return Edit(place.file, before, after.encode(), _line(text, after))


_BOM = codecs.BOM_UTF8.decode()


def _read(checked: Checked, place: Place) -> tuple[bytes, str]:
    """Read a file of the project. Raise EditRefusedError."""
    data = checked.loaded.files.fetch(place.file)
    if isinstance(data, Refusal):
        message = f"{place.file} cannot be read: {data.message}"
        raise RefusedError(message)
    try:
        return data, data.decode()
    except UnicodeDecodeError:
        message = f"{place.file} is not UTF-8"
        raise RefusedError(message) from None


def _head(checked: Checked, place: Place) -> str:
    """Return the first line of a new file: the schema comment, where the project's other files have one."""
    for file in checked.files:
        found = _MODELINE.match(checked.sources.text(file) or "")
        # A relative path to the schema has to be rewritten for the new file's folder.
        if found and "://" not in found[1] and not found[1].startswith(("/", "\\")):
            schema = posixpath.join(posixpath.dirname(file), found[1])
            address = posixpath.relpath(schema, posixpath.dirname(place.file) or ".")
            return f"# yaml-language-server: $schema={address}\n"
        if found:
            return f"# yaml-language-server: $schema={found[1]}\n"
    return ""


def _text(place: Place, element: Element, text: str) -> str:
    """Return the text with the element inserted, the first proposal that proves right. Raise EditRefusedError."""
    mark = _BOM if text.startswith(_BOM) else ""
    plain = text.removeprefix(_BOM)
    try:
        for candidate in insertion.texts(place.file, plain, place.path, element):
            if proof.holds(plain, candidate, place.path, element):
                return mark + candidate
    except CannotInsertError as error:
        raise RefusedError(str(error), _by_hand(place, element)) from None
    message = f"the text of {place.file} is written in a way in which more than the new element would change"
    raise RefusedError(message, _by_hand(place, element))


def _by_hand(place: Place, element: Element) -> str:
    """Return what a person may write into the file instead."""
    lines = element.below(place.path).lines("    ", 2)
    return "\n".join((f"Write it by hand into {place.file}, or into a file of its own:", "", *lines))


def _line(before: str, after: str) -> int:
    """Return the number of the first line that differs and is not blank."""
    old, new = before.splitlines(), after.splitlines()
    same = next((n for n, (a, b) in enumerate(zip(old, new, strict=False)) if a != b), min(len(old), len(new)))
    return next((n + 1 for n in range(same, len(new)) if new[n].strip()), same + 1)
