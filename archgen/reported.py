"""Which findings a check reports: all of them, those that a baseline does not know, or those that a change caused."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from archgen.diagnostic import Diagnostic, Severity, settle
from archgen.emit import tree
from archgen.findings import baseline
from archgen.findings.rules import by_name
from archgen.identity import Known
from archgen.pipeline import ALL_RULES, Checked
from archgen.project import baseline as reading

FILE = "archgen-baseline.yaml"
"""The baseline of a project where nobody names another file."""
RULES = by_name(ALL_RULES)
"""Every rule by its name."""


@dataclass(frozen=True, slots=True)
class Reported:
    """What a check reports. `known` are findings kept quiet, `cured` what the baseline lists and is no more."""

    findings: tuple[Diagnostic, ...]
    known: tuple[Diagnostic, ...] = ()
    cured: tuple[Known, ...] = ()


@dataclass(frozen=True, slots=True)
class Updated:
    """What an update of a baseline did: how many findings it knows, how many of them it did not know, how many it lost."""

    path: Path
    known: int
    added: int
    cured: int


def unread(findings: Iterable[Diagnostic]) -> bool:
    """Say whether errors of reading or linking hide what else there is to find: then nobody knows what is cured."""
    return any(RULES[finding.rule].fixed and finding.severity is Severity.ERROR for finding in findings)


def beyond(checked: Checked, file: Path) -> Reported:
    """Report what a baseline does not know, and what is wrong with the baseline."""
    known, problems = _read(checked, file)
    new, old, cured = baseline.divide(checked.findings, known, RULES)
    wrong = settle(problems, RULES, checked.loaded.rules)
    gone = () if unread(checked.findings) else cured
    return Reported(tuple(sorted((*new, *wrong), key=lambda finding: finding.key)), old, gone)


def update(checked: Checked, file: Path) -> Updated:
    """Write the baseline that knows every finding of now. A file that is none is never replaced."""
    known: tuple[Known, ...] = ()
    if os.path.lexists(file):
        known, problems = _read(checked, file)
        text = checked.sources.text(_shown(checked, file)) or ""
        if not reading.is_own(text):
            said = f"{file} is no baseline, and stays as it is" if text else f"{file}: {problems[0].message}"
            raise tree.OutputError(said if problems else f"{file} is empty", "give another file with `--baseline`")
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
