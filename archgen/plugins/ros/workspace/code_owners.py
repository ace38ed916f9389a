"""Who answers for the packages of a workspace: what CODEOWNERS files of its repositories say of their folders."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from archgen.plugin.importing import ForeignFileError, make_id, make_unique_id, read_bounded
from archgen.plugins.ros.ros_package.import_account import ImportAccount

_PLACES = ("CODEOWNERS", ".github/CODEOWNERS", "docs/CODEOWNERS", ".gitlab/CODEOWNERS")
_MAX_BYTES = 1_000_000
_GLOBS = frozenset("*?[")


class CodeOwners:
    """The CODEOWNERS files of the repositories below some folders, each read once."""

    def __init__(self, roots: Iterable[Path], account: ImportAccount) -> None:
        self._roots = frozenset(root.resolve() for root in roots)
        self._account = account
        self._ids: dict[str, str] = {}
        self._rules: dict[Path, list[tuple[str, tuple[str, ...]]] | None] = {}

    def find_owners(self, folder: Path) -> tuple[str, ...]:
        """Return the owners of a folder as they are written (`@org/team`): those of the last line that names it."""
        for top in (folder, *folder.parents):
            rules = self._read_rules(top)
            if rules is not None:
                path = folder.relative_to(top).as_posix()
                return next((owners for pattern, owners in reversed(rules) if _names_folder(pattern, path)), ())
            if top in self._roots:
                break
        return ()

    def name_partners(self, folder: Path) -> str | list[str] | None:
        """Return the partners that own a folder, as a component says them; None where nobody does."""
        names = []
        for owner in dict.fromkeys(self.find_owners(folder)):
            if owner not in self._ids:
                word = owner.lstrip("@").rpartition("/")[2].partition("@")[0]
                self._ids[owner] = make_unique_id(make_id(word, "partner"), set(self._ids.values()))
            names.append(self._ids[owner])
        return names[0] if len(names) == 1 else names or None

    def write_partners(self) -> dict[str, dict[str, object]]:
        """Return the partners that were named, with who reviews for them."""
        return {name: {"title": owner, "reviewers": [owner]} for owner, name in self._ids.items()}

    def _read_rules(self, top: Path) -> list[tuple[str, tuple[str, ...]]] | None:
        if top not in self._rules:
            files = (top / place for place in _PLACES)
            file = next((file for file in files if file.is_file() and not file.is_symlink()), None)
            self._rules[top] = None if file is None else list(self._parse_file(file))
        return self._rules[top]

    def _parse_file(self, file: Path) -> Iterator[tuple[str, tuple[str, ...]]]:
        try:
            text = read_bounded(file, _MAX_BYTES).decode("utf-8", "replace")
        except ForeignFileError as error:
            self._account.add_note("CODEOWNERS", error.message, error.span, error.help_line)
            return
        for line in text.splitlines():
            words = line.partition("#")[0].split()
            # GitLab's heads of sections stand in brackets.
            if words and not words[0].startswith(("[", "^[")):
                yield words[0], tuple(words[1:])


def _names_folder(pattern: str, folder: str) -> bool:
    """Whether a pattern is about all that lies in a folder. Patterns of files, such as `*.py`, are about none."""
    name = pattern.removesuffix("**").removesuffix("*").rstrip("/")
    if not name:
        return True
    if _GLOBS & set(name):
        return False
    if "/" in name:
        return f"{folder}/".startswith(f"{name.lstrip('/')}/")
    return name in folder.split("/")
