"""A checked project held against robots that were observed: findings as a check has them, and what was looked at."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from functools import partial
from pathlib import Path

from archgen.checking.all_rules import index_all_rules
from archgen.conformance.accepted_differences import apply_acceptances
from archgen.conformance.conformance_rules import RULE_NAMES
from archgen.conformance.observed_robot import ObservedRobot
from archgen.conformance.robot_comparison import ComparedPart, RobotComparison, compare_robot
from archgen.conformance.seen_record import (
    SeenDifference,
    SeenRecordError,
    SeenRobot,
    replace_robots,
    write_record,
)
from archgen.diagnostics import Diagnostic, join_words, settle_diagnostics
from archgen.edit.adopted_remedies import Adoption, FindingNames, plan_adoption
from archgen.edit.earlier_import import list_stale_slices
from archgen.findings import ignore_comments
from archgen.frozen import dataclass, replace
from archgen.git.commit_log import has_tag
from archgen.model.architecture import Architecture
from archgen.pipeline import CheckedProject
from archgen.products import check_findings
from archgen.products.check_findings import ReportedFindings
from archgen.products.seen_robots import read_seen_robots
from archgen.regular_files import read_named_file

_MAX_EXCERPT_BYTES = 1_000_000


@dataclass(frozen=True, slots=True)
class ConformanceReport:
    """What was compared, robot by robot, and what is reported of it."""

    comparisons: tuple[RobotComparison, ...]
    accepted_count: int
    """How many differences the project accepts."""
    reported: ReportedFindings


def hold_against_robots(
    checked_project: CheckedProject,
    robots: Sequence[ObservedRobot],
    part: ComparedPart,
    baseline_file: Path | None = None,
) -> ConformanceReport:
    """Compare a project with each robot; comments, settings and a baseline silence findings as in a check."""
    architecture = checked_project.architecture
    comparisons = _compare_robots(checked_project, robots, part)
    all_findings = [finding for comparison in comparisons for finding in comparison.findings]
    was_compared = _list_compared(architecture, robots)
    kept_findings, accepted_count = apply_acceptances(
        all_findings, architecture.conform.accepted, was_compared, partial(has_tag, checked_project.root)
    )
    raw_findings = _place_in_project([*kept_findings, *list_stale_slices(checked_project)], checked_project)
    loaded_project = checked_project.loaded_project
    ignores = [ignore for file_ignores in loaded_project.ignores.values() for ignore in file_ignores]
    if ignores:
        first_lines = ignore_comments.find_first_lines(checked_project.architecture)
        kept = ignore_comments.apply_ignores(raw_findings, ignores, index_all_rules(), first_lines)
        # What is wrong with the comments themselves is the check's to say.
        raw_findings = [finding for finding in kept if finding.rule in RULE_NAMES]
    findings = settle_diagnostics(raw_findings, index_all_rules(), loaded_project.rule_settings)
    _quote_robots(findings, checked_project)
    return ConformanceReport(
        comparisons,
        accepted_count,
        check_findings.report_findings(replace(checked_project, findings=findings), baseline_file),
    )


def adopt_remedies(
    checked_project: CheckedProject, robots: Sequence[ObservedRobot], part: ComparedPart, rules: Collection[str]
) -> Adoption:
    """Plan what the robots know and the design does not say; of the rules that are named what differs, too, and only that.

    What the project accepts, or silences by a comment, stays as it is.
    """
    report = hold_against_robots(checked_project, robots, part)
    kept = {(each.rule, each.message) for each in report.reported.findings}
    remedies = [each for comparison in report.comparisons for each in comparison.remedies]
    chosen = [
        each
        for each in remedies
        if (each.rule in rules if rules else each.is_gap) and (not each.rule or (each.rule, each.message) in kept)
    ]

    def compare(project: CheckedProject) -> FindingNames:
        comparisons = _compare_robots(project, robots, part)
        return frozenset((each.rule, each.message) for comparison in comparisons for each in comparison.findings)

    return plan_adoption(checked_project, chosen, compare)


def keep_report(checked_project: CheckedProject, report: ConformanceReport, name: str) -> str:
    """Return the record of the project with what came out. Raise SeenRecordError where the one that is there cannot be read."""
    old_robots, obstacle = read_seen_robots(checked_project)
    if obstacle:
        raise SeenRecordError(obstacle)
    reported = {(each.rule, each.message): each for each in report.reported.findings}
    robots = [
        SeenRobot(
            name,
            comparison.robot.origin,
            comparison.robot.kind,
            comparison.ends,
            tuple(
                SeenDifference(each.rule, each.element or "", each.message)
                for each in comparison.findings
                if (each.rule, each.message) in reported
            ),
        )
        for comparison in report.comparisons
    ]
    return write_record(replace_robots(old_robots, robots))


def _compare_robots(
    checked_project: CheckedProject, robots: Iterable[ObservedRobot], part: ComparedPart
) -> tuple[RobotComparison, ...]:
    variants = (each.architecture for each in checked_project.variants.values())
    part = replace(part, other_nodes=frozenset(node.full_name for each in variants for node in each.nodes.values()))
    architecture = checked_project.architecture
    part = replace(part, ignored=(*part.ignored, *architecture.conform.ignore))
    return tuple(compare_robot(architecture, robot, part, checked_project.rule_options) for robot in robots)


def _list_compared(architecture: Architecture, robots: Sequence[ObservedRobot]) -> Callable[[str], bool]:
    """Return what says of an element whether something was seen of it: of its node, or of one that implements it."""
    seen = {node.full_name for robot in robots for node in robot.nodes if node.has_known_uses}
    compared = set(seen)
    for node in architecture.nodes.values():
        if node.full_name in seen:
            compared |= {node.id, *node.implements}
    return lambda element: element in compared or element.rpartition(".")[0] in compared


def _place_in_project(findings: Iterable[Diagnostic], checked_project: CheckedProject) -> list[Diagnostic]:
    """Return findings that say whom they concern; what stands in a library, which nobody here can change, is moved to the node."""
    architecture = checked_project.architecture
    library_files = frozenset(checked_project.loaded_project.library_files)
    # All that ships with archgen counts as written where the project names the library.
    shipped_places = {library.at for library in checked_project.loaded_project.libraries if library.is_shipped}
    placed = []
    for finding in findings:
        element = finding.element or ""
        owner = architecture.nodes.get(element) or architecture.components.get(element.rpartition(".")[0])
        is_foreign = finding.span.file in library_files or finding.span in shipped_places
        span = owner.at if is_foreign and owner is not None else finding.span
        owners = (
            [architecture.partners[each].title for each in owner.owners if each in architecture.partners]
            if owner
            else []
        )
        help_line = f"{finding.help}; it belongs to {join_words(owners)}" if owners else finding.help
        placed.append(replace(finding, span=span, help=help_line))
    return placed


def _quote_robots(findings: Iterable[Diagnostic], checked_project: CheckedProject) -> None:
    """Make the texts of the robots' files available for excerpts, as far as findings point into them."""
    spans = {
        span.file for each in findings for span in (each.span, *(label.span for label in each.labels)) if span.file
    }
    for file in sorted(spans.difference(checked_project.sources.file_names())):
        try:
            data = read_named_file(checked_project.root / file, _MAX_EXCERPT_BYTES)
        except OSError:
            continue
        checked_project.sources.add_text(file, data.decode("utf-8", "replace"))
