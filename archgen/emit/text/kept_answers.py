"""Keep what templates wrote for a later run, by a digest of all that decides it.

That is little: the worker sees its request (data, options, limits, manifest), the templates and its own code. Where nothing of
these changed, it would write the same again.
"""

from __future__ import annotations

import hashlib
import json
import marshal
import os
import stat
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from archgen.cache.file_store import FileStore
from archgen.cache.program_stamp import stamp_program
from archgen.emit.text.template_limits import MAX_TEMPLATE_BYTES

NO_ANSWERS = FileStore(None, "")
"""The store that keeps nothing."""
_MOST_ANSWERS = 48


def open_answer_store(folder: Path | None) -> FileStore:
    """Return the answers that are kept in a cache folder; without one none is."""
    return FileStore(folder, ".rendered", _MOST_ANSWERS)


def make_answer_key(request: dict[str, Any], templates: Path) -> str:
    """Return the name of what is kept: a digest of the request, of all templates, and of the code that renders them.

    Return an empty text where the request holds what is no plain data: then nothing is kept.
    """
    try:
        # Five times as fast as JSON. In this version equal data has equal bytes, and no other data has them.
        data = marshal.dumps(request, 0)
    except ValueError:
        return ""
    digest = hashlib.sha256(f"{stamp_program()}\n".encode("utf-8", "replace"))
    for part in _describe_templates(templates):
        digest.update(b"%d %b" % (len(part), part))
    digest.update(data)
    return digest.hexdigest()


def load_answer(store: FileStore, key: str) -> Mapping[str, Any] | None:
    """Return an answer with files that is kept; None where there is none, or it is damaged."""
    data = store.load(key) if key else None
    if data is None:
        return None
    try:
        answer = json.loads(zlib.decompress(data))
    except (ValueError, zlib.error):
        return None
    return answer if isinstance(answer, dict) and "files" in answer else None


def keep_answer(store: FileStore, key: str, answer: Mapping[str, Any]) -> None:
    """Keep an answer that has files: what failed is tried again."""
    if key and store.folder is not None and "files" in answer:
        # Code is mostly repetition: a fast compression makes it twenty times smaller.
        store.store(key, zlib.compress(json.dumps(answer).encode(), 1))


def _describe_templates(templates: Path) -> Iterator[bytes]:
    """Yield all that the loader of templates can read: names, contents, and where links lead; nothing else is opened."""
    for folder, subfolders, names in os.walk(templates):
        subfolders.sort()
        for name in sorted([*subfolders, *names]):
            path = Path(folder, name)
            status = path.lstat()
            yield os.fsencode(path)
            if stat.S_ISLNK(status.st_mode):
                yield os.fsencode(path.readlink())
            elif stat.S_ISREG(status.st_mode):
                # A longer one is refused whatever it says.
                yield path.read_bytes() if status.st_size <= MAX_TEMPLATE_BYTES else b"too long"
