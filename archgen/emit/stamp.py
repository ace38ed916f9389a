"""Stamps of earlier builds: nothing is made again where all inputs are the same and the outputs are still there.

A stamp is a small file in the cache, named by a digest of the inputs. It holds digests of what was written, so that
files changed, moved or removed since are noticed. A damaged stamp counts as none.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from archgen.emit import shelf, tree
from archgen.emit.program import program

_MOST = 64
"""Stamps that are kept; each takes some hundred bytes."""


def key(parts: Iterable[object]) -> str:
    """Return the name of a build: a digest of this program and of values whose `repr` is complete."""
    text = "\n".join([program(), *(repr(part) for part in parts)])
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def fresh(folder: Path | None, name: str, target: Path, read: Callable[[str], bytes | None]) -> tuple[str, ...] | None:
    """Return the names of the parts below a folder if they are all as written; None where they must be made.

    `read_file` returns the files that the writers asked for (pictures of chapters), which decide the outputs as well.
    """
    try:
        stamp = json.loads((folder / f"{name}.stamp").read_bytes()) if folder else {}
        asked, made = dict(stamp["asked"]), dict(stamp["made"])
        # The few inputs first: digests of the outputs read every file of the site.
        same = all(_digest(read(path)) == held for path, held in asked.items())
        if same and made and all(_written(target / part) == held for part, held in made.items()):
            return tuple(made)
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None
    return None


def keep(folder: Path | None, name: str, target: Path, made: Iterable[str], asked: Mapping[str, bytes | None]) -> None:
    """Store the stamp of a build that was written just now.

    `part_names` are names of parts below `target`, `asked_files` the contents of the files that the writers asked for.
    """
    if folder is None:
        return
    with contextlib.suppress(OSError):  # a full or read-only disk costs only the time that this would have saved
        held = {part: _written(target / part, sure=True) for part in made}
        stamp = {"made": held, "asked": {path: _digest(data) for path, data in asked.items()}}
        shelf.put(folder / f"{name}.stamp", json.dumps(stamp).encode())
        shelf.thin(folder, ".stamp", _MOST)


def _written(path: Path, *, sure: bool = False) -> str | None:
    """Return a digest of a file, or of the manifest of a folder written by archgen; None for anything else.

    `just_written` is for folders that were written just now: their files are not read again.
    """
    if path.is_dir() and not path.is_symlink():
        return tree.manifest_digest(path, sure=sure)
    # A link is never what archgen wrote.
    return None if path.is_symlink() else _digest(path.read_bytes())


def _digest(data: bytes | None) -> str | None:
    return None if data is None else hashlib.sha256(data).hexdigest()
