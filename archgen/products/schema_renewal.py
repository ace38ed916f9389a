"""Renew the JSON Schema of a project for editors where it is archgen's own, and git ignores it.

Nearly every check on a terminal ends here with nothing to do: this module imports the rest only to write.
"""

from __future__ import annotations

import contextlib
import os
import stat
from pathlib import Path
from typing import TYPE_CHECKING

from archgen.products.editor_schema_marks import (
    MARK,
    SCHEMA_FILE,
    digest_names,
    digest_texts,
    format_mark,
    list_project_names,
    read_head,
)

if TYPE_CHECKING:
    from archgen.pipeline import CheckedProject
    from archgen.views.offered_names import OfferedNames


def renew_schema(checked_project: CheckedProject) -> bool:
    """Write the schema of a project anew if one is there, names have changed, and git ignores it.

    Silent where that cannot be: it comes beside something else. A project that cannot be read whole keeps the names
    that it had.
    """
    path = checked_project.root / SCHEMA_FILE
    if not _is_plain_file(path) or checked_project.architecture.partial:
        return False
    head = read_head(path) or ""
    text_digest = digest_texts(checked_project)
    if not head.startswith(MARK) or head.startswith(format_mark(text_digest)):
        return False
    names = list_project_names(checked_project)
    return digest_names(names) not in head and _write_names(checked_project.root, names, text_digest)


def _write_names(root: Path, names: OfferedNames, text_digest: str) -> bool:
    from archgen.emit import file_tree
    from archgen.git.work_tree import ignores_file
    from archgen.products import editor_schema_file

    if ignores_file(root, SCHEMA_FILE):
        with contextlib.suppress(OSError, file_tree.OutputError):
            file_tree.write_file(root / SCHEMA_FILE, editor_schema_file.render_names(names, text_digest))
            return True
    return False


def _is_plain_file(path: Path) -> bool:
    """Whether there is a file, and neither it nor its folder is a link."""
    try:
        return stat.S_ISREG(os.lstat(path).st_mode) and stat.S_ISDIR(os.lstat(path.parent).st_mode)
    except OSError:
        return False
