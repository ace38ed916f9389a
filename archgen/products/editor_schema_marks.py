"""What tells which project an editors' schema was made from: its mark, digests of files and names, the names themselves."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path
from typing import TYPE_CHECKING

from archgen import resources
from archgen.regular_files import open_named_file

if TYPE_CHECKING:
    from archgen.pipeline import CheckedProject
    from archgen.views.offered_names import OfferedNames


SCHEMA_FILE = ".vscode/archgen.schema.json"
"""Where `archgen init` lets editors look for it, relative to the project's folder."""
MARK = '{"$comment":"archgen schema wrote this file, and renews it; do not edit it, let git ignore it. '
"""How a schema begins that archgen wrote."""
_HEAD_LENGTH = 400
_MAKER_FILE = Path(__file__).resolve().parents[1] / "emit" / "data" / "editor_schema.py"


def list_project_names(checked_project: CheckedProject) -> OfferedNames:
    """Return the names that editors offer, all component types of the project's libraries included."""
    from archgen.compose.library_types import library_of_type, list_type_entries
    from archgen.link import mapping_values
    from archgen.views.offered_names import list_offered_names

    library_types = {
        name: mapping_values.get_title(mapping_values.get_body(entry), name.rpartition(".")[2])
        for name, entry in list_type_entries(checked_project.merged_table).items()
        if library_of_type(name)
    }
    return list_offered_names(checked_project.architecture, library_types)


def format_mark(text_digest: str, name_digest: str = "") -> str:
    """Return how a schema begins that was made from files with this digest, and holds names with that one."""
    return f"{MARK}Made from {text_digest}, names {name_digest}"


def digest_texts(checked_project: CheckedProject) -> str:
    """Return a digest of the YAML files of the project and its libraries, and of what makes schemas of them."""
    from archgen.compose import list_type_entries

    checksum = _start_digest()
    for file in (*checked_project.yaml_files, *checked_project.loaded_project.library_files):
        text = checked_project.sources.text_of(file) or ""
        checksum.update(f"{file} {len(text)}\n{text}".encode(errors="surrogatepass"))
    if any(library.is_shipped for library in checked_project.loaded_project.libraries):
        # Another archgen may ship other component types.
        checksum.update(repr(sorted(list_type_entries(checked_project.merged_table))).encode())
    return checksum.hexdigest()[:16]


def digest_names(names: OfferedNames) -> str:
    """Return a digest of the names, and of what makes a schema of them."""
    checksum = _start_digest()
    checksum.update(repr(names).encode(errors="surrogatepass"))
    return checksum.hexdigest()[:16]


def _start_digest() -> hashlib._Hash:
    """Begin a digest with what makes schemas: another archgen makes another schema."""
    return hashlib.sha256(language_schema_path().read_bytes() + _MAKER_FILE.read_bytes())


def language_schema_path() -> Path:
    """Return the file with the language's own schema."""
    return resources.resource_path("schemas", "archgen.schema.json")


def read_head(path: Path) -> str | None:
    """Return the beginning of a file, empty if it cannot be read; None if there is none."""
    if not os.path.lexists(path):
        return None
    try:
        with open_named_file(path) as stream:
            return stream.read(_HEAD_LENGTH).decode("utf-8", "replace")
    except OSError:
        return ""
