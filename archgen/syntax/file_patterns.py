"""File patterns of a project: `*` within a name, `**` for any number of folders, never outside the project's folder.

Not `pathlib.glob`: a project may lie in a commit, and some folders are never searched.
"""

from __future__ import annotations

import re
import unicodedata
from itertools import compress
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from archgen.diagnostics import order_naturally
from archgen.frozen import NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.syntax.project_files import ProjectFiles

YAML_ENDINGS = (".yaml", ".yml")
"""How the names of YAML files end, in small letters."""
_LONGEST_NAME = 255
"""No file system has a longer name: a pattern with more letters matches none."""
_CHARACTERS = re.compile(r"\[(!?)([^\]/]+)\]")
_WILDCARD = re.compile(r"[*?\[]")
OUTPUT_FOLDER = "archgen-out"


def is_inside_project(pattern: str) -> bool:
    """Whether a pattern is relative and stays in the folder that it starts from."""
    parts = PurePosixPath(pattern).parts
    return (
        bool(pattern)
        and "\\" not in pattern
        and not pattern.startswith("/")
        and ".." not in parts
        and "\0" not in pattern
    )


def expand_pattern(files: ProjectFiles, pattern: str, skipped_folders: frozenset[str] = frozenset()) -> tuple[str, ...]:
    """Return the files that match a pattern, sorted by path.

    Wildcards never find hidden files and folders, output folders, links to folders, folders named in `skipped_folders`,
    or other projects below this one. A pattern that spells such a folder out does.
    """
    parts = PurePosixPath(pattern).parts
    # The part before the first wildcard is walked to directly; without any wildcard the pattern is a path.
    fixed_count = next((i for i, part in enumerate(parts) if _WILDCARD.search(part)), len(parts))
    prefix = _find_spelling(files, "/".join(parts[:fixed_count]))
    if fixed_count == len(parts):
        return (prefix,) if files.has_path(prefix) else ()
    path_pattern = _compile_path(parts[fixed_count:])
    matching_names = (name for name in _walk_files(files, prefix, skipped_folders) if _matches_path(path_pattern, name))
    # Sorted name by name, not as strings: `a/b` comes before `a-b/c`, as in a listing of folders, and g2 before g10.
    return tuple(
        sorted(
            (f"{prefix}/{name}" if prefix else name for name in matching_names),
            key=lambda name: [order_naturally(part) for part in name.split("/")],
        )
    )


class WalkedFiles(NamedTuple):
    """The files below a folder, by their paths, and what a search for files passes over."""

    files: tuple[str, ...]
    passed_over: tuple[str, ...]
    """Hidden files, folders that are not searched (with a slash behind), and the archgen.yaml of other projects."""


def walk_project(files: ProjectFiles, skipped_folders: frozenset[str]) -> WalkedFiles:
    """Return all files that a wildcard finds, sorted by path, and what it passes over."""
    passed_over: list[str] = []
    found = sorted(_walk_files(files, "", skipped_folders, passed_over), key=lambda name: name.split("/"))
    return WalkedFiles(tuple(found), tuple(sorted(passed_over)))


def list_yaml_files(
    files: ProjectFiles, folder: str = "", skipped_folders: frozenset[str] = frozenset(), *, is_deep: bool = True
) -> tuple[str, ...]:
    """Return the YAML files below a folder, or those in it alone, sorted by path, whichever ending they have."""
    pattern = "/".join(filter(None, (folder, "**" if is_deep else "", "*")))
    return tuple(filter(is_yaml_name, expand_pattern(files, pattern, skipped_folders)))


def is_yaml_name(name: str) -> bool:
    """Whether a file is called as YAML files are, in capitals or not."""
    return name.lower().endswith(YAML_ENDINGS)


def matches_pattern(pattern: str, file: str) -> bool:
    """Whether a pattern matches a path, whether or not the file exists."""
    return is_inside_project(pattern) and _matches_path(_compile_path(PurePosixPath(pattern).parts), file)


def _find_spelling(files: ProjectFiles, path: str) -> str:
    """Return a path as the disk has it: macOS may hold letters with accents in another form of Unicode than people type."""
    if path.isascii() or files.has_path(path):
        return path
    return next((each for form in ("NFD", "NFC") if files.has_path(each := unicodedata.normalize(form, path))), path)


def _walk_files(
    files: ProjectFiles, top: str, skipped_folders: frozenset[str], passed_over: list[str] | None = None
) -> Iterator[str]:
    """Yield the files below a folder; `passed_over` collects what is not searched."""
    for relative_folder, folders, file_names in files.walk_folders(top):
        path_prefix = f"{relative_folder}/" if relative_folder else ""
        if relative_folder and "archgen.yaml" in file_names:  # a project of its own
            folders.clear()
            if passed_over is not None:
                passed_over.append(f"{path_prefix}archgen.yaml")
            continue
        is_searched = [name[0] != "." and name != OUTPUT_FOLDER and name not in skipped_folders for name in folders]
        if passed_over is not None:
            passed_over += (f"{path_prefix}{name}" for name in file_names if name[0] == ".")
            passed_over += (
                f"{path_prefix}{name}/" for name, is_kept in zip(folders, is_searched, strict=True) if not is_kept
            )
        folders[:] = sorted(compress(folders, is_searched))
        yield from (f"{path_prefix}{name}" for name in file_names if name[0] != ".")
        # A folder called `x.yaml` is yielded too: reading it then reports that it is a folder, instead of silently
        # leaving out what somebody may take for a file.
        yield from (f"{path_prefix}{name}" for name in folders if is_yaml_name(name))


def _compile_path(parts: tuple[str, ...]) -> tuple[re.Pattern[str] | None, ...]:
    """Return one expression for each name of a pattern, None for `**`. A last `**` stands for one name at least."""
    names = (*parts, "*") if parts[-1:] == ("**",) else parts
    return tuple(
        None if part == "**" else re.compile(_name_to_regex(unicodedata.normalize("NFC", part)), re.DOTALL)
        for part in names
    )


def _matches_path(path_pattern: tuple[re.Pattern[str] | None, ...], path: str) -> bool:
    """Whether the names of a path match, `**` standing for any number of them, in whatever form of Unicode.

    Only the last `**` is ever widened: what an earlier one could still take, a later one can take as well. So the time
    is bounded by the product of both lengths; one regular expression for the whole path takes exponential time.
    """
    names = unicodedata.normalize("NFC", path).split("/")
    position, index = 0, 0
    widened_position, widened_index = -1, 0
    while index < len(names):
        name_pattern = path_pattern[position] if position < len(path_pattern) else None
        if position < len(path_pattern) and name_pattern is None:
            widened_position, widened_index = position, index
            position += 1
        elif name_pattern is not None and name_pattern.fullmatch(names[index]):
            position, index = position + 1, index + 1
        elif widened_position >= 0:
            widened_index += 1
            position, index = widened_position + 1, widened_index
        else:
            return False
    return all(name_pattern is None for name_pattern in path_pattern[position:])


def _name_to_regex(part: str) -> str:
    """Translate one name of a pattern with `*`, `?` and `[abc]` into a regular expression.

    Each `*` but the last takes as little as lets the next piece match, and never takes more (an atomic group): what it
    could still take, the next `*` can take as well. Without that a stranger's `*a*a*a*` takes time without end.
    """
    first_piece, *other_pieces = _split_at_stars(part)
    if not other_pieces:
        return first_piece
    middle = "".join(f"(?>[^/]*?{piece})" for piece in other_pieces[:-1])
    return f"{first_piece}{middle}[^/]*{other_pieces[-1]}"


def _split_at_stars(part: str) -> list[str]:
    """Return the expressions of the pieces between the stars of a name; a run of stars counts as one."""
    pieces: list[list[str]] = [[]]
    place, last_bracket = 0, part.rfind("]")
    while place < len(part):
        # Behind the last bracket nothing closes a class: to look for it there takes time that grows with the square.
        match = _CHARACTERS.match(part, place) if place < last_bracket else None
        if match:
            pieces[-1].append(_character_class(match[2], negated=bool(match[1])))
        elif part[place] != "*":
            pieces[-1].append("[^/]" if part[place] == "?" else re.escape(part[place]))
        elif part[place - 1 : place] != "*":
            pieces.append([])
        place = match.end() if match else place + 1
    return ["".join(piece) for piece in pieces] if sum(map(len, pieces)) <= _LONGEST_NAME else ["(?!)"]


def _character_class(characters: str, *, negated: bool) -> str:
    # `[!a]` must not match a slash; re.escape also escapes `-`, which means a range here as it does in a shell.
    # Two of them are the end of a range and a `-`, or a range that begins with one; Python would warn of what they may mean one day.
    plain = re.sub(
        r"^--|--", lambda found: r"-\-" if found.start() else r"\--", re.escape(characters).replace(r"\-", "-")
    )
    character_class = f"[{'^/' if negated else ''}{plain}]"
    try:
        re.compile(character_class)
    except re.error:  # a range that ends before it begins: no character lies in it
        return "[^/]" if negated else "(?!)"
    return character_class
