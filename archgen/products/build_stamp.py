"""Stamps of earlier builds: a product is not made again where all inputs are the same and it is still there.

A stamp is a small file in the cache, one for each product, named by a digest of the inputs. It holds a digest of what was
written, so that files changed, moved or removed since are noticed. A damaged stamp counts as none.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from archgen.cache.file_store import FileStore, digest_bytes, digest_text
from archgen.cache.program_stamp import stamp_program
from archgen.emit import file_tree

_MAX_STAMPS = 256
"""Stamps that are kept, four for each build; each takes some hundred bytes."""


def make_stamp_key(build_inputs: Iterable[object]) -> str:
    """Return the name of a stamp: a digest of this program and of values whose `repr` is complete."""
    return digest_text("\n".join([stamp_program(), *(repr(part) for part in build_inputs)]))


def is_fresh(folder: Path | None, stamp_key: str, place: Path, read_file: Callable[[str], bytes | None]) -> bool:
    """Whether a product stands at its place as it was written from the same inputs.

    `read_file` returns the files that the writer asked for (pictures of chapters), which decide the product as well.
    """
    try:
        stamp = json.loads(_stamp_files(folder).load(stamp_key) or b"{}")
        asked_digests, product_digest = dict(stamp["asked"]), stamp["made"]
        # The few inputs first: the product's digest reads every file of a site.
        return all(
            digest_bytes(read_file(path)) == stored_digest for path, stored_digest in asked_digests.items()
        ) and bool(product_digest == _digest_product(place))
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return False


def store_stamp(folder: Path | None, stamp_key: str, place: Path, asked_files: Mapping[str, bytes | None]) -> None:
    """Store the stamp of a product that was written just now; `asked_files` are those that its writer asked for."""
    if folder is None:
        return
    # A full or read-only disk, or somebody who changes files meanwhile, costs only the time that this would have saved.
    with contextlib.suppress(OSError, ValueError):
        stamp = {
            "made": _digest_product(place, just_written=True),
            "asked": {path: digest_bytes(data) for path, data in asked_files.items()},
        }
        _stamp_files(folder).store(stamp_key, json.dumps(stamp).encode())


def _stamp_files(folder: Path | None) -> FileStore:
    return FileStore(folder, ".stamp", _MAX_STAMPS)


def _digest_product(place: Path, *, just_written: bool = False) -> str:
    """Return a digest of a file, or of the manifest of a folder; `absent` where nothing is.

    `just_written` is for folders that were written just now: their files are not read again. Raise ValueError for what
    archgen has not written so.
    """
    if not os.path.lexists(place):
        return "absent"
    digest = None
    if place.is_dir() and not place.is_symlink():
        digest = file_tree.digest_manifest(place, just_written=just_written)
    elif not place.is_symlink():
        digest = file_tree.digest_file(place)
    if digest is None:
        msg = f"{place} is not as archgen wrote it"
        raise ValueError(msg)
    return digest
