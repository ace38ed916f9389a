"""What a project says at a commit, without places and comments: commits that say the same count the same.

A digest of the files, not the comparison's normal form: it decides which commits need no reading and checking at all,
so it must be had before there is an architecture. It may only err towards "changed", which costs one more check.
"""

from __future__ import annotations

from collections.abc import Hashable

from archgen.cache.file_store import digest_text
from archgen.project import LoadedProject
from archgen.syntax.committed_files import CommittedFiles
from archgen.syntax.yaml_tree import MappingNode, SequenceNode, YamlDocument, YamlNode


class CommitContents:
    """Compares what commits say; a document that several of them share is digested once."""

    def __init__(self) -> None:
        """Start without any digest."""
        self._digests: dict[int, tuple[YamlDocument, str]] = {}

    def content_key(self, loaded_project: LoadedProject) -> Hashable:
        """Return a key for everything that a project says. Files that are not YAML count by their bytes."""
        documents = {document.file: self._digest(document, loaded_project) for document in loaded_project.documents}
        blobs = loaded_project.files.blobs if isinstance(loaded_project.files, CommittedFiles) else {}
        other_files = tuple((path, blob.object_id) for path, blob in blobs.items() if path not in documents)
        libraries = tuple(
            (library.id, self._digest(document, loaded_project))
            for library in loaded_project.libraries
            # What ships follows from the path and the distribution, which the project's own documents say.
            if not library.is_shipped
            for document in library.documents
        )
        messages = tuple((diagnostic.rule, diagnostic.message) for diagnostic in loaded_project.diagnostics)
        return (tuple(documents.items()), libraries, other_files, messages)

    def _digest(self, document: YamlDocument, loaded_project: LoadedProject) -> str:
        """Return a document's digest. Where a comment silences findings, lines matter: then the whole text counts."""
        cached = self._digests.get(id(document))
        if cached is None:
            text = (
                loaded_project.sources.text_of(document.file)
                if document.ignores
                else repr(_plain_content(document.root))
            )
            digest = digest_text(text or "")
            # The document is kept in the entry: its id() could be used again once it is collected.
            cached = self._digests[id(document)] = (document, digest)
        return cached[1]


def _plain_content(value: YamlNode) -> object:
    """Return a value without spans and comments."""
    if isinstance(value, MappingNode):
        return [(entry.key, _plain_content(entry.value)) for entry in value]
    if isinstance(value, SequenceNode):
        return [_plain_content(item) for item in value.items]
    return (value.text, value.value)
