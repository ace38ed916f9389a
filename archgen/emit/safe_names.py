"""Make names for files that every file system takes, from any text."""

from __future__ import annotations

import hashlib
import re
import unicodedata
from collections.abc import Iterable
from functools import lru_cache

MAX_PART_LENGTH = 100
"""Characters that one part of a path may have: a third of what file systems take, so that folders can nest."""

_MAX_PATH_LENGTH = 1_000
_MAX_PATH_FOLDERS = 50
_UNSAFE_CHARACTERS = re.compile(r"[^a-z0-9._-]+")
_SURPLUS_DASHES = re.compile(r"-+(?=[-.])")
_RESERVED_NAME = re.compile(r"(?:con|prn|aux|nul|com[0-9]|lpt[0-9])(?=\.|$)")


def make_slug(text: str) -> str:
    """Make one part of a path from any text: lower case, `a-z 0-9 . _ -`, never empty, `.`, `..` or a Windows device.

    Text without any such letter, or too long a text, gets a digest, so that different texts get different names.
    """
    # NFKD splits letters from their accents, so that `é` becomes `e` instead of vanishing.
    ascii_text = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode().lower()
    name = _SURPLUS_DASHES.sub("", _UNSAFE_CHARACTERS.sub("-", ascii_text)).strip(".-")
    if not name:
        return "x-" + _short_digest(text)
    if len(name) > MAX_PART_LENGTH:
        stem, dot, ending = name.rpartition(".")
        # The ending is kept behind the digest: programs choose what to open a file with by it.
        ending = dot + ending if stem and len(ending) < 8 else ""  # noqa: PLR2004 - an ending, not a sentence
        name = name[: MAX_PART_LENGTH - 9 - len(ending)].rstrip(".-") + "-" + _short_digest(text) + ending
    reserved = _RESERVED_NAME.match(name)
    return f"{reserved.group()}_{name[reserved.end() :]}" if reserved else name


def make_safe_path(path: str) -> str:
    """Make a relative path below the output folder from any path: each part a slug, empty and dotted parts left out."""
    parts = [make_slug(part) for part in path.replace("\\", "/").split("/") if part not in {"", ".", ".."}]
    return "/".join(parts) or make_slug(path)


def explain_long_path(path: str) -> str:
    """Return why no file system takes a path below any folder; empty where it may."""
    folder_count = path.count("/")
    if len(path) <= _MAX_PATH_LENGTH and folder_count <= _MAX_PATH_FOLDERS:
        return ""
    return (
        f"the path `{path[:40]}...` has {folder_count:,} folders and {len(path):,} characters; "
        f"it may have {_MAX_PATH_FOLDERS} and {_MAX_PATH_LENGTH:,}"
    )


_UNSAFE_LETTERS = frozenset('\\:*?"<>|')


@lru_cache(65536)  # asked of each file of a site, and of each in its manifest
def is_safe_path(path: str) -> bool:
    """Return whether a path stays below its folder and means the same file on every system."""
    return all(map(_is_safe_part, path.split("/")))


@lru_cache(65536)  # files of one folder have it in common
def _is_safe_part(part: str) -> bool:
    return (
        part not in {"", ".", ".."}
        and _UNSAFE_LETTERS.isdisjoint(part)
        and part.isprintable()
        and part[-1] not in ". "
        and not _RESERVED_NAME.match(part.lower())
    )


def assign_safe_paths(paths: Iterable[str]) -> dict[str, str]:
    """Assign each path a safe path of its own.

    Where two would be one file (also on a file system that ignores case), or a file would need the name of a folder,
    the later one gets `-2`, `-3`, ... before its ending. The order decides, so the same paths get the same names.
    """
    allocator = _PathAllocator(set(), set(), {})
    return {path: allocator.add_file(make_safe_path(path)) for path in dict.fromkeys(paths)}


class _PathAllocator:
    """Remembers which names of files and folders are taken."""

    __slots__ = ("files", "folders", "moved")

    def __init__(self, files: set[str], folders: set[str], moved: dict[str, str]) -> None:
        self.files = files
        self.folders = folders
        self.moved = moved

    def add_file(self, path: str) -> str:
        folder, slash, name = path.rpartition("/")
        prefix = self.add_folder(folder) + "/" if slash else ""
        stem, dot, ending = name.rpartition(".")
        stem, ending = (stem, dot + ending) if stem else (name, "")
        candidate = prefix + name
        number = 2
        # Paths are slugs, so lower case already: comparing them as they are covers file systems that ignore case.
        while candidate in self.files or candidate in self.folders:
            candidate = f"{prefix}{stem}-{number}{ending}"
            number += 1
        self.files.add(candidate)
        return candidate

    def add_folder(self, path: str) -> str:
        if path in self.moved:
            return self.moved[path]
        parent, slash, name = path.rpartition("/")
        prefix = self.add_folder(parent) + "/" if slash else ""
        candidate = prefix + name
        number = 2
        while candidate in self.files:
            candidate = f"{prefix}{name}-{number}"
            number += 1
        self.folders.add(candidate)
        self.moved[path] = candidate
        return candidate


def _short_digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:8]


def make_identifier(text: object) -> str:
    """Make an identifier from any text. Different texts give different ones, and none is a word of a language."""
    # Doubled underscores keep escapes apart from texts that look like them: `a.b` is `a_2e_b`, `a_2e_b` is `a__2e__b`.
    doubled = str(text).replace("_", "__")
    return "n_" + re.sub(r"[^A-Za-z0-9_]", lambda found: f"_{ord(found.group()):x}_", doubled)
