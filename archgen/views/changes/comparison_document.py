"""A comparison as a document: what every format says, in which words and in which order.

`describe_comparison` decides once what is said; the printers (terminal, Markdown, HTML) hold layout only: signs,
escaping, folding, limits, colours. JSON is written from the comparison itself, since programs want all of it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from archgen.compare import Change, Comparison
from archgen.compare.edits import Edit, list_edits
from archgen.compare.element_sentences import is_read_by_others
from archgen.compare.figure_noise import FigureNoise
from archgen.diagnostics import Diagnostic, Severity, order_naturally
from archgen.frozen import NamedTuple, dataclass, field
from archgen.views.changes import breaking_verdict
from archgen.views.changes.boundary_lines import write_boundary_lines
from archgen.views.changes.breaking_items import (
    BreakingChange,
    describe_breaking_edit,
    find_repeated_findings,
    is_shown_as_break,
    name_owner,
    note_source,
)
from archgen.views.changes.change_wording import ChangeGroup, count_by_kind, group_changes, is_textual
from archgen.views.changes.figure_lines import (
    ChainRow,
    FigureLine,
    make_chain_row,
    write_limit_lines,
    write_load_lines,
    write_noise_line,
)
from archgen.views.changes.named_elements import name_each, name_elements, name_partners
from archgen.views.inline_text import count_noun
from archgen.views.picture_shapes import Graph


class ReadingErrors(NamedTuple):
    """The errors of reading and linking either version: what they are about is missing in the comparison."""

    before: tuple[Diagnostic, ...] = ()
    after: tuple[Diagnostic, ...] = ()


BREAKING_HEADING = "Breaking changes"
BOUNDARY_HEADING = "Between partners"
LOAD_HEADING = "Load of hosts and links"
CHAINS_HEADING = "Latency of chains"
UNSOUND_LEAD = "is not sound"
UNSOUND_SENTENCE = "What cannot be read there is left out of the comparison:"
_FINDING_HEADINGS = {
    "new": ("New findings", "What archgen finds now, and did not before"),
    "silenced": ("Silenced findings", "What archgen found before, and a comment or a setting hides now"),
    "cured": ("Cured findings", "What archgen found before, and does not any more"),
}
"""Heading and caption of each kind of findings, in the order of the document."""
_SEVERITY_ORDER = {severity: position for position, severity in enumerate(reversed(Severity))}


@dataclass(frozen=True, slots=True)
class NamedVersion:
    """A version by its name, with the errors of reading it: with any it is not sound."""

    name: str
    errors: tuple[Diagnostic, ...]

    @property
    def error_count(self) -> str:
        """Return how many errors there are: `2 errors`."""
        return count_noun(len(self.errors), "error")


@dataclass(frozen=True, slots=True)
class FindingGroup:
    """Findings below one heading, gravest first. `kind` is `new`, `silenced` or `cured`."""

    kind: str
    heading: str
    caption: str
    findings: tuple[Diagnostic, ...]


@dataclass(frozen=True, slots=True)
class ComparisonDocument:
    """What a comparison says, section by section in the order of its fields. What is empty has no section."""

    title: str
    before: NamedVersion
    after: NamedVersion
    headline: str
    """What changed in one line: `3 changes of the architecture`; names in backticks."""
    counts: str
    """Changes and findings by number: `3 changes (1 added, 2 removed), 1 new finding`."""
    kind_counts: str
    """Changes by kind: `1 added, 2 removed`."""
    finding_counts: tuple[str, ...]
    """New findings by severity, then how many were cured and silenced."""
    caveat: str
    """What restricts every statement where a version is not sound: ` in what could be read`."""
    obstacle: str
    """Why nobody can judge the comparison, empty where that can be done."""
    is_empty: bool
    """Whether nothing differs besides errors of reading."""
    only_breaking: bool
    broken_partners: tuple[str, ...]
    """Partners here and below by what people call them."""
    concerned_partners: tuple[str, ...]
    """All whom it concerns, those who are broken included."""
    breaking_changes: tuple[BreakingChange, ...]
    refusal_lead: str
    """Which policy refuses the changes, as the beginning of a sentence that `refusal_help` ends."""
    refusal_help: str
    """What to do if the project's policy refuses the changes, empty if it does not."""
    missing_entries: tuple[str, ...]
    """What to write for that, as YAML, with the files that it belongs into in the first line of each."""
    all_clear: str
    """Says that no change breaks another partner, empty where one does, or where nobody asks."""
    verdict: tuple[str, ...]
    """Where only breaking changes are shown: how many and what the policy says, then which accepted entries are idle."""
    changes_heading: str
    """The heading over all groups: other changes, where some are breaking."""
    change_groups: tuple[ChangeGroup, ...]
    """Changes that break nobody."""
    weighty_groups: tuple[ChangeGroup, ...]
    """The same without `textual_changes`, for formats that fold these."""
    textual_changes: tuple[Edit, ...]
    boundary_lines: tuple[FigureLine, ...]
    load_lines: tuple[FigureLine, ...]
    chain_rows: tuple[ChainRow, ...]
    finding_groups: tuple[FindingGroup, ...]
    graphs: tuple[Graph, ...] = field(default=())
    element_titles: Mapping[str, str] = field(default_factory=dict)
    """What people call components and their ports, by id: `Navigator`, `Navigator · goal`."""
    element_addresses: Mapping[str, str] = field(default_factory=dict)
    """Where on the web these are written, by id; empty where the project names no repository."""
    element_pages: Mapping[str, str] = field(default_factory=dict)
    """The anchors of their pages, by id; empty outside of a site."""

    @property
    def versions(self) -> tuple[NamedVersion, NamedVersion]:
        """Return both versions, the earlier one first."""
        return self.before, self.after

    @property
    def summary(self) -> str:
        """Return one line that closes a list: counts, whom it concerns, and whom it breaks."""
        concern_note = f"; concerns {', '.join(self.concerned_partners)}" if self.concerned_partners else ""
        breaking_note = f"; breaks {', '.join(self.broken_partners)}" if self.broken_partners else ""
        breaking_note += f"; {self.all_clear}" if self.all_clear else ""
        return self.counts + concern_note + breaking_note

    @property
    def further_partners(self) -> tuple[str, ...]:
        """Return those whom it concerns without breaking anything of theirs."""
        return tuple(partner for partner in self.concerned_partners if partner not in self.broken_partners)

    @property
    def main_graph(self) -> Graph | None:
        """Return the first picture that shows a change; components come before nodes."""
        return next((graph for graph in self.graphs if graph.arrows or any(box.change for box in graph.boxes)), None)


def describe_comparison(
    comparison: Comparison,
    old_name: str,
    new_name: str,
    reading_errors: ReadingErrors = ReadingErrors(),  # noqa: B008 - immutable
    graphs: tuple[Graph, ...] = (),
) -> ComparisonDocument:
    """Describe a comparison. The names are those of its versions, `graphs` its pictures if the format shows any."""
    edits = list_edits(comparison)
    breaking_edits = [edit for edit in edits if is_shown_as_break(edit, comparison)]
    partner_names = name_partners(comparison)
    broken_partners = {partner for edit in breaking_edits for partner in edit.broken_partners}
    other_edits = [
        note_source(edit, partner_names, broken_partners) for edit in edits if not is_shown_as_break(edit, comparison)
    ]
    textual_edits = [edit for edit in other_edits if _is_textual_edit(edit, comparison)]
    weighty_edits = [edit for edit in other_edits if not _is_textual_edit(edit, comparison)]
    repeated_findings = find_repeated_findings(comparison)
    caveat = " in what could be read" if any(reading_errors) else ""
    finding_groups = tuple(_group_findings(comparison, reading_errors, repeated_findings.keys()))
    noise = FigureNoise(comparison)
    verdict = tuple(breaking_verdict.describe_verdict(comparison)) if comparison.only_breaking else ()
    kind_counts = count_by_kind(edits)
    count_phrases = [count_noun(len(edits), "change") + (f" ({kind_counts})" if kind_counts else "")]
    count_phrases += [count_noun(len(group.findings), f"{group.kind} finding") for group in finding_groups]
    return ComparisonDocument(
        title=comparison.after.architecture.project.title,
        before=NamedVersion(old_name, reading_errors.before),
        after=NamedVersion(new_name, reading_errors.after),
        headline=_write_headline(comparison, edits, verdict, finding_groups, caveat),
        counts=", ".join(count_phrases),
        kind_counts=kind_counts,
        finding_counts=tuple(_count_findings(finding_groups)),
        caveat=caveat,
        obstacle=breaking_verdict.describe_obstacle(comparison),
        is_empty=not (comparison.changes or comparison.chains or finding_groups),
        only_breaking=comparison.only_breaking,
        broken_partners=name_each(_sorted_partners(breaking_edits), partner_names),
        concerned_partners=name_each(
            sorted({*comparison.concerned_owners, *_sorted_partners(comparison.changes)}, key=order_naturally),
            partner_names,
        ),
        breaking_changes=tuple(
            describe_breaking_edit(edit, comparison, partner_names, repeated_findings) for edit in breaking_edits
        ),
        refusal_lead=f"{breaking_verdict.write_policy(comparison)} refuses this: ",
        refusal_help=breaking_verdict.describe_refusal(comparison),
        missing_entries=breaking_verdict.write_missing_entries(comparison),
        all_clear="" if comparison.only_breaking else breaking_verdict.describe_all_clear(comparison),
        verdict=verdict,
        changes_heading="Other changes" if len(other_edits) < len(edits) else "Changes",
        change_groups=tuple(group_changes(other_edits, comparison, partner_names)),
        weighty_groups=tuple(group_changes(weighty_edits, comparison, partner_names)),
        textual_changes=tuple(name_owner(edit, comparison, partner_names) for edit in textual_edits),
        boundary_lines=(
            *write_limit_lines(comparison),
            *write_boundary_lines(comparison, partner_names),
            *write_noise_line(noise),
        ),
        load_lines=write_load_lines(comparison, partner_names),
        chain_rows=tuple(
            row
            for chain in comparison.chains
            if not noise.is_small_chain(chain)
            and (row := make_chain_row(chain, is_only_edit=len(edits) == 1)).says_a_change
        ),
        finding_groups=finding_groups,
        graphs=graphs,
        element_titles=name_elements(comparison),
    )


def sort_by_severity(findings: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return findings, gravest first; those of one severity keep the order of the files."""
    return tuple(sorted(findings, key=lambda finding: _SEVERITY_ORDER[finding.effective_severity]))


def _group_findings(
    comparison: Comparison, reading_errors: ReadingErrors, repeated_findings: Collection[Diagnostic]
) -> Iterator[FindingGroup]:
    # What could not be read in the later version is told before all else, and what says the same as a break with it:
    # not once more as a new finding.
    reported_errors = frozenset((*reading_errors.after, *repeated_findings))
    findings_by_kind = {
        "new": [finding for finding in comparison.new_findings if finding not in reported_errors],
        "silenced": comparison.silenced_findings,
        "cured": comparison.cured_findings,
    }
    for kind, (heading, caption) in _FINDING_HEADINGS.items():
        if findings_by_kind[kind]:
            yield FindingGroup(kind, heading, caption, sort_by_severity(findings_by_kind[kind]))


def _is_textual_edit(edit: Edit, comparison: Comparison) -> bool:
    """Whether an edit only concerns texts and pictures. What an output means to another partner is no mere text."""
    return all(is_textual(change) and not _changes_meaning(change, comparison) for change in edit.changes)


def _changes_meaning(change: Change, comparison: Comparison) -> bool:
    versions = comparison.versions
    match change.element_kind, change.key:
        case "output", "description":
            return is_read_by_others(change.element_id, versions)
        case "type", "comment":
            outputs = versions.find_elements_with("output", "type", change.element_id)
            return any(is_read_by_others(output, versions) for output in outputs)
    return False


def _write_headline(
    comparison: Comparison,
    edits: Sequence[Edit],
    verdict: Sequence[str],
    finding_groups: Sequence[FindingGroup],
    caveat: str,
) -> str:
    obstacle = breaking_verdict.describe_obstacle(comparison)
    if obstacle:
        count = f" ({count_noun(len(edits), 'certain change')})" if comparison.changes else ""
        return f"{obstacle[:1].upper()}{obstacle[1:]}{count}"
    if comparison.changes:
        return f"{count_noun(len(edits), 'change')} of the architecture{caveat}"
    if verdict:
        return f"{verdict[0][:1].upper()}{verdict[0][1:]}{caveat}"
    counts = [count_noun(len(group.findings), f"{group.kind} finding") for group in finding_groups]
    counts += [count_noun(len(comparison.chains), "chain") + " with another bound"] if comparison.chains else []
    return f"No change of the architecture{caveat}" + (f", but {' and '.join(counts)}" if counts else "")


def _count_findings(finding_groups: Sequence[FindingGroup]) -> Iterator[str]:
    for group in finding_groups:
        if group.kind == "new":
            severities = Counter(finding.effective_severity for finding in group.findings)
            counts = [count_noun(severities[name], str(name)) for name in _SEVERITY_ORDER if severities[name]]
            yield f"new: {', '.join(counts)}"
        else:
            yield f"{count_noun(len(group.findings), 'finding')} {group.kind}"


def _sorted_partners(changes: Iterable[Change | Edit]) -> tuple[str, ...]:
    return tuple(sorted({partner for change in changes for partner in change.broken_partners}, key=order_naturally))
