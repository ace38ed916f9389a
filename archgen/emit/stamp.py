"""What an earlier build left: nothing is made again where all that it depends on is the same, and it still lies there.

A stamp is a small file in the cache, named by a digest of the inputs. It holds digests of what was written, so that files
that were changed, moved or removed since are seen; a stamp that is damaged is no stamp.
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
"""So many stamps are kept, each of some hundred bytes."""


def key(parts: Iterable[object]) -> str:
    """Name a build by all that it depends on: this program, and values whose `repr` holds all of them."""
    text = "\n".join([program(), *(repr(part) for part in parts)])
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def fresh(folder: Path | None, name: str, target: Path, read: Callable[[str], bytes | None]) -> tuple[str, ...] | None:
    """Give the names of what was written below a folder if all of it is as it was; None where it must be made.

    `read` gives the files that the writers asked for while they wrote: they decide the bytes as well.
    """
    try:
        stamp = json.loads((folder / f"{name}.stamp").read_bytes()) if folder else {}
        asked, made = dict(stamp["asked"]), dict(stamp["made"])
        same = all(_digest(read(path)) == held for path, held in asked.items())
        if same and made and all(_written(target / part) == held for part, held in made.items()):
            return tuple(made)
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None
    return None


def keep(folder: Path | None, name: str, target: Path, made: Iterable[str], asked: Mapping[str, bytes | None]) -> None:
    """Remember what was written just now."""
    if folder is None:
        return
    with contextlib.suppress(OSError):  # a full or read-only disk costs only the time that this would have saved
        held = {part: _written(target / part, sure=True) for part in made}
        stamp = {"made": held, "asked": {path: _digest(data) for path, data in asked.items()}}
        shelf.put(folder / f"{name}.stamp", json.dumps(stamp).encode())
        shelf.thin(folder, ".stamp", _MOST)


def _written(path: Path, *, sure: bool = False) -> str | None:
    """Digest a file, or a folder that archgen wrote, by its manifest; None for what is neither. `sure`: written just now."""
    if path.is_dir() and not path.is_symlink():
        return tree.manifest_digest(path, sure=sure)
    return None if path.is_symlink() else _digest(path.read_bytes())


def _digest(data: bytes | None) -> str | None:
    return None if data is None else hashlib.sha256(data).hexdigest()
