"""What a project says at a commit, without places and comments: commits that say the same count the same."""

from __future__ import annotations

import hashlib
from collections.abc import Hashable

from archgen.project import Loaded
from archgen.syntax.committed import Committed
from archgen.syntax.tree import Document, Listing, Table, Value


class Contents:
    """Compares what commits say; a document that several of them share is digested once."""

    def __init__(self) -> None:
        """Start without any digest."""
        self._digests: dict[int, tuple[Document, str]] = {}

    def of(self, loaded: Loaded) -> Hashable:
        """Return a key for everything that a project says. Files that are not YAML count by their bytes."""
        documents = {document.file: self._digest(document, loaded) for document in loaded.documents}
        blobs = loaded.files.blobs if isinstance(loaded.files, Committed) else {}
        rest = tuple((path, blob.id) for path, blob in blobs.items() if path not in documents)
        said = tuple((found.rule, found.message) for found in loaded.diagnostics)
        return (tuple(documents.items()), rest, said)

    def _digest(self, document: Document, loaded: Loaded) -> str:
        """Return a document's digest. Where a comment silences findings, lines matter: then the whole text counts."""
        held = self._digests.get(id(document))
        if held is None:
            text = loaded.sources.text(document.file) if document.ignores else repr(_said(document.root))
            digest = hashlib.sha256((text or "").encode("utf-8", "surrogatepass")).hexdigest()
            # The document is kept in the entry: its id() could be used again once it is collected.
            held = self._digests[id(document)] = (document, digest)
        return held[1]


def _said(value: Value) -> object:
    """Return a value without spans and comments."""
    if isinstance(value, Table):
        return [(entry.key, _said(entry.value)) for entry in value]
    if isinstance(value, Listing):
        return [_said(item) for item in value.items]
    return (value.text, value.value)
