"""Which findings a check reports: all, those that a baseline does not list, or those that a change caused.

What makes two findings the same: docs/decisions/0005-known-findings.md.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Collection, Hashable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from archgen import pipeline, project
from archgen.diagnostics import Diagnostic, Rule, Severity, settle_diagnostics
from archgen.diagnostics.finding_identity import BaselineEntry, IdRenamer, identify_finding, match_findings
from archgen.frozen import dataclass, replace
from archgen.pipeline import CheckedProject, VersionCache, index_all_rules
from archgen.project import baseline_reading as reading
from archgen.project.project_search import name_path_from

if TYPE_CHECKING:
    from archgen.model.architecture import Architecture
    from archgen.model.selector_evaluation import Selection

BASELINE_FILE = "archgen-baseline.yaml"
"""The baseline of a project, unless another file is named."""


@dataclass(frozen=True, slots=True)
class ReportedFindings:
    """What a check reports, and what it keeps quiet.

    A baseline lists `known_findings`; `earlier_findings` were there before a change. Of what the baseline lists or what
    was there before, `cured_entries` and `healed_findings` no longer exist.
    """

    findings: tuple[Diagnostic, ...]
    known_findings: tuple[Diagnostic, ...] = ()
    cured_entries: tuple[BaselineEntry, ...] = ()
    earlier_findings: tuple[Diagnostic, ...] = ()
    healed_findings: tuple[Diagnostic, ...] = ()
    was_compared: bool = False
    """Whether there was a baseline or an earlier version to compare with."""


@dataclass(frozen=True, slots=True)
class BaselineUpdate:
    """What an update of a baseline did: findings that it lists now, newly listed ones, and removed ones."""

    path: Path
    known_count: int
    added_count: int
    cured_count: int


def find_reading_error(findings: Iterable[Diagnostic]) -> Diagnostic | None:
    """Return the first error of reading or linking, None where there is none.

    Behind such an error more may be hidden, so nobody can say which findings are cured.
    """
    return next(
        (
            finding
            for finding in findings
            if index_all_rules()[finding.rule].fixed and finding.severity is Severity.ERROR
        ),
        None,
    )


def report_findings(
    checked_project: CheckedProject, baseline_file: Path | None = None, earlier_project: CheckedProject | None = None
) -> ReportedFindings:
    """Compare a project's findings with a baseline and with an earlier version of the project.

    Findings about the baseline itself are reported, too.
    """
    known_entries, problems = _read_baseline(checked_project, baseline_file) if baseline_file else ((), ())
    new_findings, baselined_findings, cured_entries = divide_by_baseline(
        checked_project.findings, known_entries, index_all_rules()
    )
    caused_findings, healed_findings = (
        compare_findings(checked_project, earlier_project) if earlier_project else (checked_project.findings, ())
    )
    caused_set = set(caused_findings)
    # The baseline is read after the project, so its problems have not been through `settle` yet.
    baseline_problems = settle_diagnostics(problems, index_all_rules(), checked_project.loaded_project.rule_settings)
    is_complete = find_reading_error(checked_project.findings) is None and not checked_project.waiting_rules
    return ReportedFindings(
        # New to both: neither listed in the baseline nor there before the change.
        findings=tuple(
            sorted(
                (*(d for d in new_findings if d in caused_set), *baseline_problems),
                key=lambda finding: finding.sort_key,
            )
        ),
        known_findings=baselined_findings,
        cured_entries=cured_entries if is_complete else (),
        earlier_findings=tuple(finding for finding in new_findings if finding not in caused_set),
        healed_findings=healed_findings if is_complete else (),
        was_compared=baseline_file is not None or earlier_project is not None,
    )


def keep_findings(
    reported: ReportedFindings, checked_project: CheckedProject, files: Collection[str], selection: Selection | None
) -> ReportedFindings:
    """Keep the findings that lie in some files (empty for all), and that are about some components and nodes.

    Errors that keep something from being read are about everybody. What is cured is not told of a part.
    """
    # Imported here: only who asks for a part needs it.
    from archgen.model.selector_keys import find_elements_of

    def is_asked(finding: Diagnostic) -> bool:
        if files and finding.span.file not in files:
            return False
        if selection is None or (finding.element is None and find_reading_error([finding])):
            return True
        architecture = checked_project.architecture
        hit = find_elements_of(architecture, _list_concerned(architecture, finding.element or ""))
        return not (selection.components.isdisjoint(hit.components) and selection.nodes.isdisjoint(hit.nodes))

    return replace(
        reported,
        findings=tuple(filter(is_asked, reported.findings)),
        known_findings=tuple(filter(is_asked, reported.known_findings)),
        earlier_findings=tuple(filter(is_asked, reported.earlier_findings)),
        healed_findings=(),
        cured_entries=(),
    )


def _list_concerned(architecture: Architecture, element: str) -> list[str]:
    """Return the elements that a finding on one is about: those on a chain's way, the nodes of a host."""
    if chain := architecture.chains.get(element):
        return [point.id for point in chain.through]
    return [element, *(node.id for node in architecture.nodes.values() if element and node.host == element)]


def compare_findings(
    checked_project: CheckedProject, earlier_project: CheckedProject
) -> tuple[tuple[Diagnostic, ...], tuple[Diagnostic, ...]]:
    """Return the findings that are new or graver than before, and those that are gone.

    Renamed elements keep their findings. Of several findings that are alike, those on the same line of the same file
    are matched first, so that the one reported is the new one.
    """
    from archgen.compare.match_elements import match_elements

    renames = match_elements(earlier_project.architecture, checked_project.architecture)
    current_keys = [_matching_keys(finding, checked_project, None) for finding in checked_project.findings]
    earlier_keys = [_matching_keys(finding, earlier_project, renames) for finding in earlier_project.findings]
    matched_indexes = match_findings(current_keys, earlier_keys)
    # Positions, not findings: equal findings may occur several times, and each is matched by itself.
    new_indexes = [
        index
        for index, earlier_index in enumerate(matched_indexes)
        if earlier_index is None
        or checked_project.findings[index].effective_severity
        > earlier_project.findings[earlier_index].effective_severity
    ]
    gone_indexes = set(range(len(earlier_keys))).difference(matched_indexes)
    return tuple(checked_project.findings[index] for index in new_indexes), tuple(
        earlier_project.findings[index] for index in sorted(gone_indexes)
    )


def _matching_keys(
    finding: Diagnostic, checked_project: CheckedProject, renames: IdRenamer | None
) -> tuple[Hashable, Hashable]:
    """Return the keys for matching, strictest first: identity with file and text of the line, then identity alone."""
    finding_identity = identify_finding(finding, renames)
    # The line's text and not its number: lines move with every edit above them.
    line = checked_project.sources.line_of(finding.span.file, finding.span.line) or ""
    return (finding_identity, finding.span.file, line.strip()), finding_identity


def check_earlier(path: Path | None, revision: str, version_cache: VersionCache | None = None) -> CheckedProject:
    """Check the project as it was at a revision; `main...` is the commit where HEAD left main.

    Raise what `pipeline.check_at` raises.
    """
    if not revision.endswith("..."):
        return pipeline.check_at_revision(path, revision, version_cache)
    from archgen import git

    tracked_project = project.find_tracked_project(path)
    fork = git.find_common_commit(tracked_project.objects.repository, revision.removesuffix("...") or "HEAD", "HEAD")
    return pipeline.check_tracked_project(tracked_project, fork.commit_id, version_cache)


def update_baseline(checked_project: CheckedProject, baseline_file: Path) -> BaselineUpdate:
    """Write a baseline that lists every finding of now.

    Raise OutputError instead of replacing a file that is no baseline.
    """
    from archgen.emit import file_tree

    known_entries: tuple[BaselineEntry, ...] = ()
    # `lexists`: a dangling link is in the way as well and must not be replaced unread.
    if os.path.lexists(baseline_file):
        known_entries, problems = _read_baseline(checked_project, baseline_file)
        if not reading.is_baseline(
            checked_project.sources.text_of(_path_in_project(checked_project, baseline_file)) or ""
        ):
            reason = problems[0].message if problems else "the file is empty"
            msg = f"{baseline_file} stays as it is: {reason}"
            raise file_tree.OutputError(msg, "give another file with `--baseline`")
    new_findings, known_findings, cured_entries = divide_by_baseline(
        checked_project.findings, known_entries, index_all_rules()
    )
    file_tree.write_file(baseline_file, format_baseline(checked_project.findings, index_all_rules()).encode())
    # Errors of reading and linking are never listed in a baseline, so they are not counted as added.
    added_count = sum(not index_all_rules()[finding.rule].fixed for finding in new_findings)
    return BaselineUpdate(
        baseline_file, len(known_findings) + added_count, added_count, sum(entry.occurrences for entry in cured_entries)
    )


def _read_baseline(
    checked_project: CheckedProject, baseline_file: Path
) -> tuple[tuple[BaselineEntry, ...], tuple[Diagnostic, ...]]:
    """Read a baseline, and make its text available for excerpts in messages."""
    shown_path = _path_in_project(checked_project, baseline_file)
    text, known_entries, problems = reading.read_baseline(baseline_file, shown_path, index_all_rules())
    checked_project.sources.add_text(shown_path, text)
    return known_entries, problems


def _path_in_project(checked_project: CheckedProject, baseline_file: Path) -> str:
    """Return the path of the baseline relative to the project's folder, as paths are shown in findings."""
    return name_path_from(checked_project.root.absolute(), baseline_file.absolute())


_FILE_HEADER = """\
# Findings that this project knows of: `archgen check --baseline` keeps them quiet, and only new ones count.
# Written by `archgen check --update-baseline`, which also settles conflicts in it: it writes the file anew.
"""


def divide_by_baseline(
    findings: Iterable[Diagnostic], baseline_entries: Iterable[BaselineEntry], rules: Mapping[str, Rule]
) -> tuple[tuple[Diagnostic, ...], tuple[Diagnostic, ...], tuple[BaselineEntry, ...]]:
    """Return the findings that are new, those that are known, and the entries that are cured, with how many of each.

    Read and link errors are always new: nobody knows what is behind them.
    """
    baseline_entries = tuple(baseline_entries)
    remaining = Counter[object]()
    for entry in baseline_entries:
        remaining[entry.identity] += entry.occurrences
    new_findings, known_findings = [], []
    for finding in findings:
        # Identity leaves out lines and parts of the message (docs/decisions/0005-known-findings.md).
        finding_identity = identify_finding(finding)
        # Counted, not just looked up: a second finding alike is new.
        if remaining[finding_identity] > 0 and not rules[finding.rule].fixed:
            remaining[finding_identity] -= 1
            known_findings.append(finding)
        else:
            new_findings.append(finding)
    cured_entries = []
    for entry in reversed(baseline_entries):  # of several alike the last ones go
        cured_count = min(entry.occurrences, remaining[entry.identity])
        remaining[entry.identity] -= cured_count
        if cured_count:
            cured_entries.append(entry._replace(occurrences=cured_count))
    return tuple(new_findings), tuple(known_findings), tuple(reversed(cured_entries))


def format_baseline(findings: Iterable[Diagnostic], rules: Mapping[str, Rule]) -> str:
    """Return the text of a baseline that knows these findings, sorted, without those that no baseline may know."""
    # Sorted by content and not by place: moving lines does not change the file.
    counts = Counter(
        (finding.rule, finding.element or "", finding.message) for finding in findings if not rules[finding.rule].fixed
    )
    if not counts:
        return f"{_FILE_HEADER}archgen_baseline: 1\nfindings: []\n"
    lines = (line for entry_key, count in sorted(counts.items()) for line in _entry_lines(*entry_key, count))
    return "\n".join((f"{_FILE_HEADER}archgen_baseline: 1\nfindings:", *lines, ""))


def _entry_lines(rule: str, element: str, message: str, count: int) -> Iterator[str]:
    """Yield the lines of one entry; empty keys are left out, so that a diff shows what matters."""
    from archgen.syntax import yaml_writer

    yield f"  - rule: {yaml_writer.format_scalar(rule)}"
    if element:
        yield f"    element: {yaml_writer.format_scalar(element)}"
    yield f"    message: {yaml_writer.format_scalar(message)}"
    if count > 1:
        yield f"    count: {count}"
