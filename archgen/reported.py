"""Which findings a check reports: all of them, those that a baseline does not know, or those that a change caused."""

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
"""The baseline of a project where nobody names another file."""
RULES = by_name(ALL_RULES)
"""Every rule by its name."""


@dataclass(frozen=True, slots=True)
class Reported:
    """What a check reports.

    Kept quiet are `known` ones (a baseline lists them) and `earlier` ones (they were there before a change). `cured` is
    what the baseline lists, `healed` what was there before, and is no more.
    """

    findings: tuple[Diagnostic, ...]
    known: tuple[Diagnostic, ...] = ()
    cured: tuple[Known, ...] = ()
    earlier: tuple[Diagnostic, ...] = ()
    healed: tuple[Diagnostic, ...] = ()
    compared: bool = False
    """Whether there was anything to compare with."""


@dataclass(frozen=True, slots=True)
class Updated:
    """What an update of a baseline did: how many findings it knows, how many of them it did not know, how many it lost."""

    path: Path
    known: int
    added: int
    cured: int


def unread(findings: Iterable[Diagnostic]) -> Diagnostic | None:
    """Give the first error of reading or linking: behind such a one there is more to find, and nobody knows what is cured."""
    return next((d for d in findings if RULES[d.rule].fixed and d.severity is Severity.ERROR), None)


def report(checked: Checked, file: Path | None = None, before: Checked | None = None) -> Reported:
    """Report what a baseline does not know (and what is wrong with it), and what was not there before."""
    known, problems = _read(checked, file) if file else ((), ())
    new, old, cured = baseline.divide(checked.findings, known, RULES)
    caused, healed = since(checked, before) if before else (checked.findings, ())
    found = set(caused)
    wrong = settle(problems, RULES, checked.loaded.rules)
    sound = unread(checked.findings) is None
    return Reported(
        findings=tuple(sorted((*(d for d in new if d in found), *wrong), key=lambda finding: finding.key)),
        known=old,
        cured=cured if sound else (),
        earlier=tuple(finding for finding in new if finding not in found),
        healed=healed if sound else (),
        compared=file is not None or before is not None,
    )


def since(checked: Checked, before: Checked) -> tuple[tuple[Diagnostic, ...], tuple[Diagnostic, ...]]:
    """Give the findings that were not there before or count more now, and those that are no more. Renamed elements keep
    theirs.

    Of findings that are alike, those in the same line of the same file are matched first, so that the new one is shown.
    """
    from archgen.compare.match import match

    renames = match(before.architecture, checked.architecture)
    now = [_keys(finding, checked, None) for finding in checked.findings]
    then = [_keys(finding, before, renames) for finding in before.findings]
    old = partners(now, then)
    new = [
        place for place, was in enumerate(old) if was is None or _graver(checked.findings[place], before.findings[was])
    ]
    gone = set(range(len(then))).difference(old)
    return tuple(checked.findings[place] for place in new), tuple(before.findings[place] for place in sorted(gone))


def _graver(now: Diagnostic, then: Diagnostic) -> bool:
    """Say whether a change made a finding count more, by setting its rule for instance."""
    order = list(Severity)
    return order.index(now.severity or Severity.ERROR) > order.index(then.severity or Severity.ERROR)


def _keys(finding: Diagnostic, of: Checked, renames: Renames | None) -> tuple[Hashable, Hashable]:
    same = identity(finding, renames)
    line = of.sources.line(finding.span.file, finding.span.line) or ""
    return (same, finding.span.file, line.strip()), same


def earlier(path: Path | None, revision: str) -> Checked:
    """Judge the project as it was at a revision; `main...` is where HEAD left main.

    Raises what `pipeline.check_at` raises.
    """
    if not revision.endswith("..."):
        return pipeline.check_at(path, revision)
    tracked = project.tracked(path)
    fork = git.fork(tracked.objects.repository, revision.removesuffix("...") or "HEAD", "HEAD")
    return pipeline.check_tracked(tracked, fork.commit)


def update(checked: Checked, file: Path) -> Updated:
    """Write the baseline that knows every finding of now. A file that is none is never replaced."""
    known: tuple[Known, ...] = ()
    if os.path.lexists(file):
        known, problems = _read(checked, file)
        if not reading.is_own(checked.sources.text(_shown(checked, file)) or ""):
            why = problems[0].message if problems else "the file is empty"
            msg = f"{file} stays as it is: {why}"
            raise tree.OutputError(msg, "give another file with `--baseline`")
    new, old, cured = baseline.divide(checked.findings, known, RULES)
    tree.write_file(file, baseline.write(checked.findings, RULES).encode())
    added = sum(not RULES[finding.rule].fixed for finding in new)
    return Updated(file, len(old) + added, added, sum(entry.times for entry in cured))


def _read(checked: Checked, file: Path) -> tuple[tuple[Known, ...], tuple[Diagnostic, ...]]:
    shown = _shown(checked, file)
    text, known, problems = reading.read(file, shown, RULES)
    checked.sources.add(shown, text)
    return known, problems


def _shown(checked: Checked, file: Path) -> str:
    """Name the baseline as the project's own files are named, from the project's folder."""
    return Path(os.path.relpath(file.absolute(), checked.root.absolute())).as_posix()
