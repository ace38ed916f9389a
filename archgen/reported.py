"""Which findings a check reports: all, those that a baseline does not list, or those that a change caused.

What makes two findings the same: docs/decisions/0005-known-findings.md.
"""

from __future__ import annotations

import os
from collections.abc import Hashable, Iterable
from dataclasses import dataclass
from pathlib import Path

from archgen import git, pipeline, project
from archgen.diagnostic import Diagnostic, Severity, settle
from archgen.emit import tree
from archgen.findings import baseline
from archgen.findings.rules import by_name
from archgen.identity import Known, Renames, identity, partners
from archgen.pipeline import ALL_RULES, Checked
from archgen.project import baseline as reading

FILE = "archgen-baseline.yaml"
"""The baseline of a project, unless another file is named."""
RULES = by_name(ALL_RULES)
"""Every rule by its name."""


@dataclass(frozen=True, slots=True)
class Reported:
    """What a check reports, and what it keeps quiet.

    A baseline lists `known_findings`; `earlier_findings` were there before a change. Of what the baseline lists or what
    was there before, `cured_entries` and `healed_findings` no longer exist.
    """

    findings: tuple[Diagnostic, ...]
    known: tuple[Diagnostic, ...] = ()
    cured: tuple[Known, ...] = ()
    earlier: tuple[Diagnostic, ...] = ()
    healed: tuple[Diagnostic, ...] = ()
    compared: bool = False
    """Whether there was a baseline or an earlier version to compare with."""


@dataclass(frozen=True, slots=True)
class Updated:
    """What an update of a baseline did: findings that it lists now, newly listed ones, and removed ones."""

    path: Path
    known: int
    added: int
    cured: int


def unread(findings: Iterable[Diagnostic]) -> Diagnostic | None:
    """Return the first error of reading or linking, None where there is none.

    Behind such an error more may be hidden, so nobody can say which findings are cured.
    """
    return next((d for d in findings if RULES[d.rule].fixed and d.severity is Severity.ERROR), None)


def report(checked: Checked, file: Path | None = None, before: Checked | None = None) -> Reported:
    """Compare a project's findings with a baseline and with an earlier version of the project.

    Findings about the baseline itself are reported, too.
    """
    known, problems = _read(checked, file) if file else ((), ())
    new, old, cured = baseline.divide(checked.findings, known, RULES)
    caused, healed = since(checked, before) if before else (checked.findings, ())
    found = set(caused)
    # The baseline is read after the project, so its problems have not been through `settle` yet.
    wrong = settle(problems, RULES, checked.loaded.rules)
    sound = unread(checked.findings) is None
    return Reported(
        # New to both: neither listed in the baseline nor there before the change.
        findings=tuple(sorted((*(d for d in new if d in found), *wrong), key=lambda finding: finding.key)),
        known=old,
        cured=cured if sound else (),
        earlier=tuple(finding for finding in new if finding not in found),
        healed=healed if sound else (),
        compared=file is not None or before is not None,
    )


def since(checked: Checked, before: Checked) -> tuple[tuple[Diagnostic, ...], tuple[Diagnostic, ...]]:
    """Return the findings that are new or graver than before, and those that are gone.

    Renamed elements keep their findings. Of several findings that are alike, those on the same line of the same file
    are matched first, so that the one reported is the new one.
    """
    from archgen.compare.match import match

    renames = match(before.architecture, checked.architecture)
    now = [_keys(finding, checked, None) for finding in checked.findings]
    then = [_keys(finding, before, renames) for finding in before.findings]
    old = partners(now, then)
    # Positions, not findings: equal findings may occur several times, and each is matched by itself.
    new = [
        place for place, was in enumerate(old) if was is None or _graver(checked.findings[place], before.findings[was])
    ]
    gone = set(range(len(then))).difference(old)
    return tuple(checked.findings[place] for place in new), tuple(before.findings[place] for place in sorted(gone))


def _graver(now: Diagnostic, then: Diagnostic) -> bool:
    """Whether a finding is more severe than its match, for example because its rule was set to another severity."""
    order = list(Severity)
    return order.index(now.severity or Severity.ERROR) > order.index(then.severity or Severity.ERROR)


def _keys(finding: Diagnostic, of: Checked, renames: Renames | None) -> tuple[Hashable, Hashable]:
    """Return the keys for matching, strictest first: identity with file and text of the line, then identity alone."""
    same = identity(finding, renames)
    # The line's text and not its number: lines move with every edit above them.
    line = of.sources.line(finding.span.file, finding.span.line) or ""
    return (same, finding.span.file, line.strip()), same


def earlier(path: Path | None, revision: str) -> Checked:
    """Check the project as it was at a revision; `main...` is the commit where HEAD left main.

    Raise what `pipeline.check_at` raises.
    """
    if not revision.endswith("..."):
        return pipeline.check_at(path, revision)
    tracked = project.tracked(path)
    fork = git.fork(tracked.objects.repository, revision.removesuffix("...") or "HEAD", "HEAD")
    return pipeline.check_tracked(tracked, fork.commit)


def update(checked: Checked, file: Path) -> Updated:
    """Write a baseline that lists every finding of now.

    Raise OutputError instead of replacing a file that is no baseline.
    """
    known: tuple[Known, ...] = ()
    # `lexists`: a dangling link is in the way as well and must not be replaced unread.
    if os.path.lexists(file):
        known, problems = _read(checked, file)
        if not reading.is_own(checked.sources.text(_shown(checked, file)) or ""):
            why = problems[0].message if problems else "the file is empty"
            msg = f"{file} stays as it is: {why}"
            raise tree.OutputError(msg, "give another file with `--baseline`")
    new, old, cured = baseline.divide(checked.findings, known, RULES)
    tree.write_file(file, baseline.write(checked.findings, RULES).encode())
    # Errors of reading and linking are never listed in a baseline, so they are not counted as added.
    added = sum(not RULES[finding.rule].fixed for finding in new)
    return Updated(file, len(old) + added, added, sum(entry.times for entry in cured))


def _read(checked: Checked, file: Path) -> tuple[tuple[Known, ...], tuple[Diagnostic, ...]]:
    """Read a baseline, and make its text available for excerpts in messages."""
    shown = _shown(checked, file)
    text, known, problems = reading.read(file, shown, RULES)
    checked.sources.add(shown, text)
    return known, problems


def _shown(checked: Checked, file: Path) -> str:
    """Return the path of the baseline relative to the project's folder, as paths are shown in findings."""
    return Path(os.path.relpath(file.absolute(), checked.root.absolute())).as_posix()
