"""Cache drawn pictures: a file for each, named by a digest of all that the picture depends on, so none is ever out of
date.

A file is a line of JSON (sizes, warning, and the offset, length and CRC of each format), then the formats' bytes.
Reading takes only the formats that are asked for. A damaged file counts as missing.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterable, Sequence
from pathlib import Path

from archgen.cache.file_store import FileStore, digest_text
from archgen.cache.program_stamp import stamp_writers
from archgen.emit.picture import Picture

_SUFFIX = ".picture"
_RUNS_KEPT = 4
"""The pictures of this many runs are kept; the oldest beyond that are removed."""


def picture_key(visible_parts: str) -> str:
    """Return the name of a cached picture: a digest of all that is seen of it, and of this program."""
    return digest_text(f"{stamp_writers()}\n{visible_parts}")


def load_picture(folder: Path, key: str, formats: Sequence[str]) -> Picture | None:
    """Load a picture, or return None unless all the formats are cached and sound. Its source is a format, too."""
    try:
        with (folder / f"{key}{_SUFFIX}").open("rb") as file:
            head = json.loads(file.readline())
            start = file.tell()
            parts = {form: _read_blob(file.read, file.seek, start, head["parts"][form]) for form in formats}
        return Picture(
            head["id"],
            float(head["width"]),
            float(head["height"]),
            dot=(parts.pop("dot", None) or b"").decode(),
            warning=head["warning"],
            **parts,
        )
    except (OSError, ValueError, KeyError, TypeError, IndexError):
        return None


def _read_blob(read, seek, start: int, blob_range: Sequence[int]) -> bytes:  # type: ignore[no-untyped-def] # noqa: ANN001
    offset, length, check = blob_range
    seek(start + offset)
    data: bytes = read(length)
    # A run that was cut off, or a bad disk: the picture is drawn again instead of breaking a page.
    if len(data) != length or zlib.crc32(data) != check:
        raise ValueError
    return data


def store_picture(folder: Path, key: str, picture: Picture, formats: Iterable[str]) -> None:
    """Store a picture, unless one of the formats was not drawn."""
    parts, offset, blobs = {}, 0, []
    for form in (*formats, "dot"):
        data = getattr(picture, form)
        blob = data.encode() if isinstance(data, str) else data
        if blob is None:
            return
        parts[form] = (offset, len(blob), zlib.crc32(blob))
        blobs.append(blob)
        offset += len(blob)
    head = {
        "id": picture.id,
        "width": picture.width,
        "height": picture.height,
        "warning": picture.warning,
        "parts": parts,
    }
    FileStore(folder, _SUFFIX).store(key, json.dumps(head).encode() + b"\n" + b"".join(blobs))


def prune_pictures(folder: Path, count: int) -> None:
    """Remove the oldest pictures, beyond a multiple of those in use."""
    # With the 100, a run of few pictures (`archgen diagram --only`) leaves those of a whole build where they are.
    FileStore(folder, _SUFFIX).prune(_RUNS_KEPT * count + 100)
