"""Make names for files that every file system takes, from any text."""

from __future__ import annotations

import hashlib
import re
import unicodedata
from collections.abc import Iterable

LONGEST = 100
"""Characters that one part of a path may have: a third of what file systems take, so that folders can nest."""

_UNSAFE = re.compile(r"[^a-z0-9._-]+")
_DASHES = re.compile(r"-+(?=[-.])")
_RESERVED = re.compile(r"(?:con|prn|aux|nul|com[0-9]|lpt[0-9])(?=\.|$)")


def slug(text: str) -> str:
    """Make one part of a path from any text: lower case, `a-z 0-9 . _ -`, never empty, `.`, `..` or a Windows device.

    Text without any such letter, or too long a text, gets a digest, so that different texts get different names.
    """
    # NFKD splits letters from their accents, so that `é` becomes `e` instead of vanishing.
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode().lower()
    name = _DASHES.sub("", _UNSAFE.sub("-", plain)).strip(".-")
    if not name:
        return "x-" + _digest(text)
    if len(name) > LONGEST:
        stem, dot, ending = name.rpartition(".")
        # The ending is kept behind the digest: programs choose what to open a file with by it.
        ending = dot + ending if stem and len(ending) < 8 else ""  # noqa: PLR2004 - an ending, not a sentence
        name = name[: LONGEST - 9 - len(ending)].rstrip(".-") + "-" + _digest(text) + ending
    reserved = _RESERVED.match(name)
    return f"{reserved.group()}_{name[reserved.end() :]}" if reserved else name


def safe_path(path: str) -> str:
    """Make a relative path below the output folder from any path: each part a slug, empty and dotted parts left out."""
    parts = [slug(part) for part in path.replace("\\", "/").split("/") if part not in {"", ".", ".."}]
    return "/".join(parts) or slug(path)


def is_safe(path: str) -> bool:
    """Return whether a path stays below its folder and means the same file on every system."""
    parts = path.split("/")
    return all(
        part not in {"", ".", ".."}
        and not set(part) & set('\\:*?"<>|')
        and part.isprintable()
        and part[-1] not in ". "
        and not _RESERVED.match(part.lower())
        for part in parts
    )


def safe_paths(paths: Iterable[str]) -> dict[str, str]:
    """Assign each path a safe path of its own.

    Where two would be one file (also on a file system that ignores case), or a file would need the name of a folder,
    the later one gets `-2`, `-3`, ... before its ending. The order decides, so the same paths get the same names.
    """
    taken = _Taken(set(), set(), {})
    return {path: taken.file(safe_path(path)) for path in dict.fromkeys(paths)}


class _Taken:
    """Remembers which names of files and folders are taken."""

    __slots__ = ("files", "folders", "moved")

    def __init__(self, files: set[str], folders: set[str], moved: dict[str, str]) -> None:
        self.files = files
        self.folders = folders
        self.moved = moved

    def file(self, path: str) -> str:
        folder, slash, name = path.rpartition("/")
        prefix = self.folder(folder) + "/" if slash else ""
        stem, dot, ending = name.rpartition(".")
        stem, ending = (stem, dot + ending) if stem else (name, "")
        found = prefix + name
        number = 2
        # Paths are slugs, so lower case already: comparing them as they are covers file systems that ignore case.
        while found in self.files or found in self.folders:
            found = f"{prefix}{stem}-{number}{ending}"
            number += 1
        self.files.add(found)
        return found

    def folder(self, path: str) -> str:
        if path in self.moved:
            return self.moved[path]
        parent, slash, name = path.rpartition("/")
        prefix = self.folder(parent) + "/" if slash else ""
        found = prefix + name
        number = 2
        while found in self.files:
            found = f"{prefix}{name}-{number}"
            number += 1
        self.folders.add(found)
        self.moved[path] = found
        return found


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:8]
