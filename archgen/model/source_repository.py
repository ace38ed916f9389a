"""Where the project's files are on the web: addresses of places, as GitHub, GitLab and Gitea have them."""

from __future__ import annotations

import posixpath
from typing import Literal
from urllib.parse import quote, urlsplit

from archgen.frozen import dataclass

Forge = Literal["github", "gitlab", "gitea"]
_FORGE_NAMES: tuple[tuple[str, Forge], ...] = (
    ("github", "github"),
    ("gitea", "gitea"),
    ("forgejo", "gitea"),
    ("codeberg", "gitea"),
)
"""What in a host's name tells the forge; of the others GitLab is what most run themselves."""
_FILE_PATHS = {"github": "/blob/{0}/{1}", "gitlab": "/-/blob/{0}/{1}", "gitea": "/src/branch/{0}/{1}"}
_COMMIT_PATHS = {**_FILE_PATHS, "gitea": "/src/commit/{0}/{1}"}
DEFAULT_BRANCH = "main"


@dataclass(frozen=True, slots=True)
class SourceRepository:
    """The section `site`: the repository's address, and how its files are found there.

    `folder` is the project's in the repository, None where the section leaves that to git.
    """

    address: str
    branch: str = DEFAULT_BRANCH
    folder: str | None = None
    forge: Forge | None = None
    commit: str = ""
    """The commit whose files are meant; empty for those of the branch."""

    def file_address(self, file: str, line: int | None = None) -> str | None:
        """Return the address of a file, or of a line of it, given from the project's folder; None where it leads out."""
        path = posixpath.normpath(posixpath.join((self.folder or "").strip("/"), file))
        if not file or path.startswith(("../", "/")):
            return None
        base = self.address.rstrip("/").removesuffix(".git")
        paths = _COMMIT_PATHS if self.commit else _FILE_PATHS
        file_path = paths[self.forge or self._guess_forge()].format(quote(self.commit or self.branch), quote(path))
        return f"{base}{file_path}" if line is None else f"{base}{file_path}#L{line}"

    def _guess_forge(self) -> Forge:
        host = urlsplit(self.address).hostname or ""
        return next((forge for name, forge in _FORGE_NAMES if name in host), "gitlab")
