"""Stamps of earlier builds: nothing is made again where all inputs are the same and the outputs are still there.

A stamp is a small file in the cache, named by a digest of the inputs. It holds digests of what was written, so that
files changed, moved or removed since are noticed. A damaged stamp counts as none.
"""

from __future__ import annotations

import contextlib
import json
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from archgen.cache.file_store import FileStore, digest_bytes, digest_text
from archgen.cache.program_stamp import stamp_program
from archgen.emit import file_tree

_MAX_STAMPS = 64
"""Stamps that are kept; each takes some hundred bytes."""


def make_stamp_key(build_inputs: Iterable[object]) -> str:
    """Return the name of a build: a digest of this program and of values whose `repr` is complete."""
    return digest_text("\n".join([stamp_program(), *(repr(part) for part in build_inputs)]))


def find_fresh_parts(
    folder: Path | None, stamp_key: str, target: Path, read_file: Callable[[str], bytes | None]
) -> tuple[str, ...] | None:
    """Return the names of the parts below a folder if they are all as written; None where they must be made.

    `read_file` returns the files that the writers asked for (pictures of chapters), which decide the outputs as well.
    """
    try:
        stamp = json.loads(_stamp_files(folder).load(stamp_key) or b"{}")
        asked_digests, part_digests = dict(stamp["asked"]), dict(stamp["made"])
        # The few inputs first: digests of the outputs read every file of the site.
        inputs_unchanged = all(
            digest_bytes(read_file(path)) == stored_digest for path, stored_digest in asked_digests.items()
        )
        if (
            inputs_unchanged
            and part_digests
            and all(_digest_part(target / part) == stored_digest for part, stored_digest in part_digests.items())
        ):
            return tuple(part_digests)
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None
    return None


def store_stamp(
    folder: Path | None,
    stamp_key: str,
    target: Path,
    part_names: Iterable[str],
    asked_files: Mapping[str, bytes | None],
) -> None:
    """Store the stamp of a build that was written just now.

    `part_names` are names of parts below `target`, `asked_files` the contents of the files that the writers asked for.
    """
    if folder is None:
        return
    with contextlib.suppress(OSError):  # an output that cannot be read again has no stamp
        part_digests = {part: _digest_part(target / part, just_written=True) for part in part_names}
        stamp = {"made": part_digests, "asked": {path: digest_bytes(data) for path, data in asked_files.items()}}
        _stamp_files(folder).store(stamp_key, json.dumps(stamp).encode())


def _stamp_files(folder: Path | None) -> FileStore:
    return FileStore(folder, ".stamp", _MAX_STAMPS)


def _digest_part(path: Path, *, just_written: bool = False) -> str | None:
    """Return a digest of a file, or of the manifest of a folder written by archgen; None for anything else.

    `just_written` is for folders that were written just now: their files are not read again.
    """
    if path.is_dir() and not path.is_symlink():
        return file_tree.digest_manifest(path, just_written=just_written)
    # A link is never what archgen wrote.
    return None if path.is_symlink() else digest_bytes(path.read_bytes())
