"""The place of a file in the repository: servers name files from its root, archgen from the project's folder."""

from __future__ import annotations

import posixpath


def path_in_repository(file: str, folder: str) -> str | None:
    """Return a file's path from the repository's root; None without one, or where it leads out. `folder` is the
    project's.
    """
    path = posixpath.normpath(posixpath.join(folder.strip("/"), file))
    return None if not file or path.startswith(("../", "/")) else path
