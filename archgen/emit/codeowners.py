"""Write CODEOWNERS, the file that tells GitHub and GitLab who reviews which file. The last line that matches counts.

Every line names one file from the repository's root. GitHub takes neither comments behind a pattern nor `[` and `#`
escaped in it, and GitLab reads `[` as a section: `?` stands for such a character everywhere.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from archgen.views.owners import Ownership

HANDLE = re.compile(
    r"(?:@@?[A-Za-z0-9](?:[A-Za-z0-9_.-]*[A-Za-z0-9_])?(?:/[A-Za-z0-9](?:[A-Za-z0-9_.-]*[A-Za-z0-9_])?)*"
    r"|[A-Za-z0-9._%+-]+@[A-Za-z0-9-]+(?:\.[A-Za-z0-9-]+)+)\Z"
)
"""What a line may name: `@user`, `@organisation/team` or an e-mail address."""
_UNSURE = re.compile(r"[^\w ./+@=~,:%&-]")
_HEAD = (
    "# Who reviews which file: made by `archgen owners --format codeowners` from the owners in the architecture.\n"
    "# A file whose elements belong to several partners names all of them. The last line that matches a file counts:\n"
    "# add lines of your own below, and they win.\n"
)


@dataclass(frozen=True, slots=True)
class Codeowners:
    """The file's text, and warnings about what it cannot express."""

    text: str
    warnings: tuple[str, ...]


def codeowners(found: Ownership, prefix: str = "") -> Codeowners:
    """Render CODEOWNERS. `prefix` is the project's folder relative to the repository's root."""
    lines: list[str] = []
    for file, partners in sorted(found.files.items()):
        path = pattern(f"{prefix}/{file}" if prefix else file)
        # A dict, not a set: two partners may share a reviewer, and the order of the file must not change.
        handles = dict.fromkeys(name for partner in partners for name in partner.reviewers if HANDLE.match(name))
        silent = [partner.id for partner in partners if not any(map(HANDLE.match, partner.reviewers))]
        if silent:
            lines.append(f"# {path}: {', '.join(silent)} without reviewers")
        if handles:
            lines.append(f"{path} {' '.join(handles)}")
    silent = [
        owned.partner.id
        for owned in found.partners
        if owned.partner and owned.files and not any(map(HANDLE.match, owned.partner.reviewers))
    ]
    warnings = [
        f'`{name}` owns files and has no reviewers: write `reviewers: "@organisation/team"` below `partners: {name}`'
        for name in silent
    ]
    return Codeowners(_HEAD + ("\n" + "\n".join(lines) + "\n" if lines else ""), tuple(warnings))


def pattern(path: str) -> str:
    """Return the pattern that matches one file, from the repository's root."""
    safe = _UNSURE.sub("?", path).replace(" ", "\\ ")
    return f"/{safe}"
