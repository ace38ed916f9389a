"""Open workbooks and documents of Office Open XML: zip files whose parts are XML, read within limits."""

from __future__ import annotations

import io
import zipfile
from posixpath import dirname, join, normpath

from lxml import etree

from archgen.plugin.importing import ARCHIVE_DAMAGE, MAX_OFFICE_BYTES

# What zipfile and its methods of compression raise for bytes that are not what they should be.
_DAMAGE = (*ARCHIVE_DAMAGE, OSError)
_RELATION = "{http://schemas.openxmlformats.org/package/2006/relationships}Relationship"


class UnreadableOfficeFileError(Exception):
    """The bytes are no workbook or document that can be read. The text says why."""


class OfficeFile:
    """The parts of one file, by their names in it."""

    def __init__(self, data: bytes) -> None:
        """Open the file. Raise UnreadableOfficeFileError."""
        if len(data) > MAX_OFFICE_BYTES:
            raise UnreadableOfficeFileError(f"it is larger than {MAX_OFFICE_BYTES // 1024 // 1024} MiB")
        try:
            self._archive = zipfile.ZipFile(io.BytesIO(data))
        except _DAMAGE as error:
            raise UnreadableOfficeFileError(f"the file is damaged ({error})") from None
        # Together: many sheets, each within its limit, would take as long as one that is too large.
        self._bytes_left = 2 * MAX_OFFICE_BYTES
        self.names = frozenset(self._archive.namelist())

    def read_part(self, name: str) -> etree._Element | None:
        """Return the root of a part; None where there is no such part. Raise UnreadableOfficeFileError."""
        if name not in self.names:
            return None
        try:
            limit = min(MAX_OFFICE_BYTES, self._bytes_left)
            with self._archive.open(name) as stream:
                # One byte more, so that a part that is too large is seen; what its head says of its size may be a lie.
                content = stream.read(limit + 1)
            self._bytes_left -= len(content)
            if len(content) > limit:
                msg = f"its part {name} is too large: at most {MAX_OFFICE_BYTES // 1024 // 1024} MiB of a part are read"
                raise UnreadableOfficeFileError(msg)
            parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False)
            return etree.fromstring(content, parser)
        except (etree.XMLSyntaxError, *_DAMAGE) as error:
            raise UnreadableOfficeFileError(f"its part {name} cannot be read ({error})") from None

    def targets_of(self, name: str) -> dict[str, str]:
        """Return the names of the parts that a part refers to, by the id of the reference."""
        folder = dirname(name)
        relations = self.read_part(join(folder, "_rels", f"{name.rpartition('/')[2]}.rels"))
        if relations is None:
            return {}
        return {
            relation.get("Id", ""): normpath(join("/" + folder, relation.get("Target", ""))).lstrip("/")
            for relation in relations.iter(_RELATION)
            if relation.get("TargetMode") != "External"
        }
