"""Write CODEOWNERS, the file that tells GitHub and GitLab who reviews which file. The last line that matches counts.

Every line names one file or folder from the repository's root. GitHub takes neither comments behind a pattern nor `[` and `#`
escaped in it, and GitLab reads `[` as a section: `?` stands for such a character everywhere.
"""

from __future__ import annotations

import posixpath
import re

from archgen.frozen import dataclass
from archgen.views.partner_ownership import Ownership

REVIEWER_HANDLE = re.compile(
    r"(?:@@?[A-Za-z0-9](?:[A-Za-z0-9_.-]*[A-Za-z0-9_])?(?:/[A-Za-z0-9](?:[A-Za-z0-9_.-]*[A-Za-z0-9_])?)*"
    r"|[A-Za-z0-9._%+-]+@[A-Za-z0-9-]+(?:\.[A-Za-z0-9-]+)+)\Z"
)
"""What a line may name: `@user`, `@organisation/team` or an e-mail address."""
_UNSUPPORTED_CHARACTER = re.compile(r"[^\w ./+@=~,:%&-]")
CODEOWNERS_PATHS = {
    "github": (".github/CODEOWNERS", "CODEOWNERS", "docs/CODEOWNERS"),
    "gitlab": ("CODEOWNERS", "docs/CODEOWNERS", ".gitlab/CODEOWNERS"),
}
"""Where each forge looks for the file, in its order: the first that exists counts."""
_GUARDED_PATHS = ("/.github/", "/.gitlab/", "/.gitlab-ci.yml", "/CODEOWNERS", "/docs/CODEOWNERS")
"""What decides who reviews and what is checked: whoever may change it alone needs nobody's review."""
FILE_HEADER = (
    "# Who reviews which file: made by `archgen owners --format codeowners` from the owners in the architecture.\n"
    "# A file whose elements belong to several partners names all of them. The last line that matches a file counts:\n"
    "# add lines of your own below, and they win.\n"
)


@dataclass(frozen=True, slots=True)
class CodeownersFile:
    """The file's text, and warnings about what it cannot express."""

    text: str
    warnings: tuple[str, ...]


def render_codeowners(ownership: Ownership, prefix: str = "") -> CodeownersFile:
    """Render CODEOWNERS. `prefix` is the project's folder relative to the repository's root."""
    lines: list[str] = []
    everybody = tuple(owned.partner for owned in ownership.partners if owned.partner)
    # First, since the last line counts: what no other line names, as a file that is new.
    rest = [(f"{file_pattern(prefix)}/" if prefix else "*", everybody)]
    guards = [(path, everybody) for path in _GUARDED_PATHS]
    files = [
        (file_pattern(posixpath.normpath(posixpath.join(prefix, file))), partners)
        for file, partners in sorted(ownership.files.items())
    ]
    for path, partners in (*rest, *files, *guards):
        # A dict, not a set: two partners may share a reviewer, and the order of the file must not change.
        handles = dict.fromkeys(
            name for partner in partners for name in partner.reviewers if REVIEWER_HANDLE.match(name)
        )
        without_reviewers = [
            partner.id for partner in partners if not any(map(REVIEWER_HANDLE.match, partner.reviewers))
        ]
        # Of what is everybody's, the file of the policy says it.
        if without_reviewers and partners is not everybody:
            lines.append(f"# {path}: {', '.join(without_reviewers)} without reviewers")
        if handles:
            lines.append(f"{path} {' '.join(handles)}")
    without_reviewers = [
        owned.partner.id
        for owned in ownership.partners
        if owned.partner and owned.files and not any(map(REVIEWER_HANDLE.match, owned.partner.reviewers))
    ]
    warnings = [
        f'`{name}` owns files and has no reviewers: write `reviewers: "@organisation/team"` below `partners: {name}`'
        for name in without_reviewers
    ]
    return CodeownersFile(FILE_HEADER + ("\n" + "\n".join(lines) + "\n" if lines else ""), tuple(warnings))


def file_pattern(path: str) -> str:
    """Return the pattern that matches one file, from the repository's root."""
    escaped_path = _UNSUPPORTED_CHARACTER.sub("?", path).replace(" ", "\\ ")
    return f"/{escaped_path}"
