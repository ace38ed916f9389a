"""A comparison document as the comment on a pull request, for a reviewer who sees nothing else.

Short things come first, long lists are folded, and the length never exceeds what a comment may have: what is left out
is counted, with the command that shows it. Names, titles and messages remain text: see `comment_sentences`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from archgen.compare.edits import Edit
from archgen.diagnostics import Diagnostic, Severity, join_words, keep_first
from archgen.emit.markdown.comment_sentences import (
    ElementNames,
    escape_inert,
    make_code_cell,
    shorten_sentence_name,
    write_code,
    write_sentence,
    write_title,
)
from archgen.emit.markdown.mermaid_chart import write_flowchart
from archgen.frozen import dataclass, field
from archgen.model.variant import BASE_NAME
from archgen.views.changes import comparison_document
from archgen.views.changes.breaking_items import BreakingChange
from archgen.views.changes.change_wording import CHANGE_SIGNS, ChangeGroup
from archgen.views.changes.comparison_document import ComparisonDocument, FindingGroup, NamedVersion
from archgen.views.changes.figure_lines import ChainRow, FigureLine
from archgen.views.graphs.changes import SMALL_BUDGET
from archgen.views.graphs.changes.merged_versions import fits_budget
from archgen.views.inline_text import count_noun
from archgen.views.picture_shapes import Graph

MAX_COMMENT_SIZE = 65_536 - 200
"""GitHub's limit for one comment (GitLab's is higher), minus room for the mark by which the comment is found again."""
_CLOSING_RESERVE = 600
"""Room for what closes the comment, and says that something is left out."""


@dataclass(slots=True)
class LimitedComment:
    """Blocks of Markdown separated by blank lines. `command` shows everything; it is a code span of at most 300
    characters.
    """

    limit: int
    command: str
    blocks: list[str] = field(default_factory=list)
    used_size: int = 0
    is_cut: bool = False

    def has_room_for(self, text: str) -> bool:
        """Whether there is room for a block."""
        return self.used_size + count_characters(text) + 2 <= self.limit - _CLOSING_RESERVE

    def add_block(self, text: str) -> None:
        """Add a block if it fits, else mark the comment as cut."""
        if not self.has_room_for(text):
            self.is_cut = True
            return
        self.blocks.append(text)
        self.used_size += count_characters(text) + 2

    def add_items(
        self,
        title: str,
        items: Sequence[str],
        summary: str = "",
        open_count: int | None = None,
        uncounted_items: int = 0,
    ) -> None:
        """Add a list below a title. `shown` items are open, the others are folded below the summary, in which `{}`
        becomes their number; `less` more are only counted.
        """
        open_count = len(items) if open_count is None else open_count
        open_items, folded_items = items[:open_count], items[open_count:]
        if open_items:
            self._add_list(title, open_items, "", 0 if folded_items else uncounted_items)
        elif title:
            self.add_block(title)
        if folded_items:
            folded_summary = summary.replace("{}", str(len(folded_items)))
            self._add_list(f"<details><summary>{folded_summary}</summary>", folded_items, "</details>", uncounted_items)

    def _add_list(self, opening: str, items: Sequence[str], closing: str, uncounted_items: int) -> None:
        fitting_items = self._take_fitting(items, opening, closing)
        left_count = len(items) - len(fitting_items) + uncounted_items
        more_note = [f"- and {left_count} more: {self.command}"] if left_count > 0 else []
        self.add_block(
            "\n\n".join(part for part in (opening, "\n".join((*fitting_items, *more_note)), closing) if part)
        )

    def _take_fitting(self, lines: Iterable[str], *around: str) -> list[str]:
        """Return the first lines: those that there is room for beside what stands around them."""
        # 100 characters are for "- and N more" and the blank lines in between.
        taken = sum(map(count_characters, (*around, self.command))) + 100
        room = self.limit - self.used_size - _CLOSING_RESERVE - taken
        fitting_lines = []
        for line in lines:
            room -= count_characters(line) + 1
            if room < 0:
                break
            fitting_lines.append(line)
        return fitting_lines

    def add_table(self, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
        """Add a table with as many rows as fit; cells are escaped already."""
        lines = [_table_row(heads), _table_row(["---"] * len(heads))]
        fitting_rows = self._take_fitting(map(_table_row, rows), "\n".join(lines))
        self.add_block("\n".join((*lines, *fitting_rows)))
        if len(fitting_rows) < len(rows):
            self.add_block(f"and {len(rows) - len(fitting_rows)} more: {self.command}")

    def write_text(self) -> str:
        """Return the comment."""
        cut_note = [f"More does not fit into a comment: {self.command}"] if self.is_cut else []
        return "\n\n".join((*self.blocks, *cut_note)) + "\n"


def _table_row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def count_characters(text: str) -> int:
    """Count characters like the strictest host: those outside the basic multilingual plane are two."""
    return len(text) + sum(character > "\uffff" for character in text)


_SHOWN_PARTNERS = 12
_MAX_OPEN_ITEMS, _MAX_OPEN_TOTAL = 8, 24
"""How many changes of one group, and of all of them, are not folded."""
_MAX_ERRORS = 5
_MAX_DIFFERENCES = 10
"""How many differences of code and model are told; all are among the findings."""
_MAX_OPEN_LINES = 9
"""How many lines of what partners write are not folded."""
_MAX_COMMAND = 250
_PLAIN_COMMAND = "archgen diff"
# Escaped: at the beginning of an item "+" would start a list, and "~" a strike-through.
_MARKDOWN_SIGNS = {kind: f"\\{sign}" if sign in "+~" else sign for kind, sign in CHANGE_SIGNS.items()}


def write_comparison_markdown(
    document: ComparisonDocument, command: str = _PLAIN_COMMAND, *, limit: int = MAX_COMMENT_SIZE
) -> str:
    """Write the comment, at most `limit` characters long; `command` shows the whole comparison in a terminal."""
    # Very long names leave the command without them.
    comment = LimitedComment(limit, write_code(command if len(command) <= _MAX_COMMAND else _PLAIN_COMMAND))
    broken, further = document.broken_partners, document.further_partners
    notes = [f"breaks {_join_partners(broken)}"] if broken else []
    notes += [f"{'also ' if broken else ''}concerns {_join_partners(further)}"] if further else []
    # The obstacle has a colon of its own.
    lead = ": " if not document.obstacle else ", "
    comment.add_block(f"### {write_sentence(document.headline)}" + (f"{lead}{', '.join(notes)}" if notes else ""))
    names = " → ".join(write_code(version.name) for version in document.versions)
    phrases = [phrase for phrase in (document.kind_counts, *document.finding_counts) if phrase]
    comment.add_block(names + (f": {'; '.join(phrases)}" if phrases else ""))
    for version in document.versions:
        _add_reading_errors(comment, version)
    if document.all_clear:
        comment.add_block(f"{document.all_clear[:1].upper()}{document.all_clear[1:]}.")
    elements = ElementNames(document.element_titles, document.element_addresses)
    _add_breaking_changes(comment, document, elements)
    _add_changes(comment, document, elements)
    _add_figures(comment, comparison_document.BOUNDARY_HEADING, document.boundary_lines, elements)
    _add_figures(comment, comparison_document.LOAD_HEADING, document.load_lines, elements)
    _add_chains(comment, document.chain_rows)
    for group in document.finding_groups:
        _add_findings(comment, group)
    # Last, so that the picture never takes the room of the text.
    _add_picture(comment, document.main_graph)
    return comment.write_text()


def add_code_differences(comment: str, differences: Sequence[Diagnostic]) -> str:
    """Return a comment with a chapter on what the code does otherwise than the model says since the change, if anything."""
    if not differences:
        return comment
    lines = ["### Code and model", "", "This change alters the code, and the model does not say so:", ""]
    for finding in differences[:_MAX_DIFFERENCES]:
        places = [write_code(f"{label.span.file}:{label.span.line}") for label in finding.labels if label.span.file]
        lines.append(f"{_finding_item(finding)}{f'; in the code {places[0]}' if places else ''}")
    more = len(differences) - _MAX_DIFFERENCES
    lines += [f"- and {more} more"] if more > 0 else []
    chapter = "\n".join(lines)
    return f"{comment}\n{chapter}\n" if len(comment) + len(chapter) < MAX_COMMENT_SIZE else comment


def write_unjudged_markdown(reason: str) -> str:
    """Write the comment on a change that could not be compared: never nothing, and never a clean verdict."""
    return f"### Cannot be judged\n\n{write_sentence(reason)}\n"


def _join_partners(partners: Sequence[str]) -> str:
    return join_words(keep_first([write_sentence(name) for name in partners], _SHOWN_PARTNERS))


def _add_reading_errors(comment: LimitedComment, version: NamedVersion) -> None:
    if not version.errors:
        return
    comment.add_block(
        f"**{write_code(version.name)} {comparison_document.UNSOUND_LEAD}** ({version.error_count}). {comparison_document.UNSOUND_SENTENCE}"
    )
    items = [_finding_item(error) for error in version.errors[:_MAX_ERRORS]]
    comment.add_items("", items, uncounted_items=len(version.errors) - _MAX_ERRORS)


def _add_breaking_changes(comment: LimitedComment, document: ComparisonDocument, elements: ElementNames) -> None:
    if document.breaking_changes:
        comment.add_block(f"#### {comparison_document.BREAKING_HEADING}")
        # An alert: hosts set it in red. Elsewhere it is a quotation.
        count = len(document.breaking_changes)
        comment.add_block(
            f"> [!CAUTION]\n> {count_noun(count, 'change')} {'breaks' if count == 1 else 'break'} another partner."
        )
        comment.add_items("", [_breaking_item(item, elements) for item in document.breaking_changes])
        if document.refusal_help:
            comment.add_block(write_sentence(document.refusal_lead + document.refusal_help))
        for entries in document.missing_entries:
            comment.add_block(_entries_block(entries))
    # Without any change the verdict is the headline.
    for line in document.verdict[1 if document.is_empty else 0 :]:
        comment.add_block(write_sentence(line))


def _entries_block(entries: str) -> str:
    """Return what partners write: a block to copy, folded where it is long. No line of it can end the block."""
    block = f"```yaml\n{entries}\n```"
    line_count = entries.count("\n") + 1
    if line_count <= _MAX_OPEN_LINES:
        return block
    return f"<details><summary>{line_count} lines to copy</summary>\n\n{block}\n\n</details>"


def _breaking_item(item: BreakingChange, elements: ElementNames) -> str:
    losses = (
        f"  - **breaks {_join_partners(loss.partners)}** ({loss.category}): {write_sentence(loss.reason, elements)}"
        for loss in item.losses
    )
    change = f"- {_MARKDOWN_SIGNS[item.change.kind]} {write_sentence(item.short_text, elements)}"
    return "\n".join((change, *losses, *(f"  - {write_sentence(line)}" for line in item.agreements)))


def _add_changes(comment: LimitedComment, document: ComparisonDocument, elements: ElementNames) -> None:
    if document.weighty_groups:
        comment.add_block(f"#### {document.changes_heading}")
    open_left = _MAX_OPEN_TOTAL
    for change_group in document.weighty_groups:
        # Nine items are shown rather than eight and a fold with one.
        open_count = min(
            len(change_group.changes),
            _MAX_OPEN_ITEMS if len(change_group.changes) > _MAX_OPEN_ITEMS + 1 else _MAX_OPEN_ITEMS + 1,
            max(open_left, 0),
        )
        # A fold with one item hides no more than it says.
        open_count += len(change_group.changes) - open_count == 1
        open_left -= open_count
        comment.add_items(
            f"**{_group_heading(change_group)}**",
            [_change_item(change, elements) for change in change_group.changes],
            "{} more changes" if open_count else "{} changes",
            open_count,
        )
    if document.textual_changes:
        items = [_change_item(change, elements) for change in document.textual_changes]
        if len(items) == 1:
            comment.add_items("**Texts and pictures only**", items)
        else:
            comment.add_items("", items, f"{len(items)} changes of texts and pictures only", 0)


def _group_heading(change_group: ChangeGroup) -> str:
    title = write_title(change_group.title) if change_group.title else ""
    group_code = write_code(change_group.group_id) if change_group.group_id else ""
    heading = " · ".join(word for word in (title, group_code) if word)
    return f"{heading} ({write_sentence(change_group.owner)})" if change_group.owner else heading


def _change_item(change: Edit, elements: ElementNames) -> str:
    return f"- {_MARKDOWN_SIGNS[change.kind]} {write_sentence(change.text, elements)}"


def _add_figures(comment: LimitedComment, heading: str, lines: Sequence[FigureLine], elements: ElementNames) -> None:
    if lines:
        comment.add_block(f"#### {heading}")
        items = [f"- {_MARKDOWN_SIGNS[line.kind]} {write_sentence(line.text, elements)}" for line in lines]
        open_count = _MAX_OPEN_ITEMS if len(items) > _MAX_OPEN_ITEMS + 1 else len(items)
        comment.add_items("", items, "{} more", open_count)


def _add_chains(comment: LimitedComment, chain_rows: Sequence[ChainRow]) -> None:
    rows = [
        (
            make_code_cell(shorten_sentence_name(row.id)),
            *(escape_inert(cell) for cell in (row.before, row.after, row.growth, row.deadline)),
            f"**{row.verdict}**" if row.verdict else "",
        )
        for row in chain_rows
    ]
    if rows:
        comment.add_block(f"#### {comparison_document.CHAINS_HEADING}")
        comment.add_table(("chain", "before", "after", "difference", "deadline", "verdict"), rows)
    reasons = [
        f"- {write_code(shorten_sentence_name(row.id))} because of {write_sentence(row.reason)}"
        for row in chain_rows
        if row.reason
    ]
    if reasons:
        open_count = len(reasons) if len(reasons) <= _MAX_OPEN_ITEMS + 1 else _MAX_OPEN_ITEMS
        comment.add_items("", reasons, "{} more reasons", open_count)


def _add_findings(comment: LimitedComment, group: FindingGroup) -> None:
    """Add findings. Notes are folded where they are new, and all that were cured."""
    items = [_finding_item(finding) for finding in group.findings]
    if group.kind == "cured" and len(items) > 1:
        comment.add_items("", items, f"{len(items)} cured findings", 0)
        return
    open_count, noun = len(items), "finding"
    if group.kind == "new":
        # They are sorted by severity: what is grave comes first.
        open_count = sum(finding.severity is not Severity.NOTE for finding in group.findings)
    if open_count > _MAX_OPEN_ITEMS + 1:
        open_count = _MAX_OPEN_ITEMS
    elif group.kind == "new":
        noun = "note"
    # A fold with one item hides no more than it says.
    open_count += len(items) - open_count == 1
    if open_count:
        comment.add_block(f"#### {group.heading}")
    summary = f"{len(items) - open_count} {'more' if open_count else 'new'} {noun}s"
    comment.add_items("", items, summary, open_count)


def _finding_item(finding: Diagnostic) -> str:
    place_note = f" ({write_code(str(finding.span))})" if finding.span.file else ""
    severity = finding.effective_severity
    item = f"- {severity} {write_code(finding.rule)}: {write_sentence(finding.message)}{place_note}"
    return f"{item}\n  - {_write_holders(finding)}" if finding.variants else item


def _write_holders(finding: Diagnostic) -> str:
    """Write in which variants a finding holds, or in which it does not, whichever are fewer."""
    absent_names = (*(() if BASE_NAME in finding.variants else (BASE_NAME,)), *finding.absent_variants)
    is_rare = len(finding.variants) <= len(absent_names)
    names = ", ".join(write_code(name) for name in (finding.variants if is_rare else absent_names))
    return f"holds in: {names}" if is_rare else f"does not hold in: {names}"


def _add_picture(comment: LimitedComment, graph: Graph | None) -> None:
    if graph is None:
        return
    signs = "\\+ added, \u2212 removed, \\~ changed, → renamed or moved; the rest is as before."
    if any(box.broken for box in graph.boxes) or any(arrow.broken for arrow in graph.arrows):
        signs = f"Red with \\!: breaks another partner. {signs}"
    notes = " ".join((signs, *(write_sentence(note) for note in graph.notes)))
    text = "\n".join(("```mermaid", *write_flowchart(graph), "```", "", f"<sub>{notes}</sub>"))
    if fits_budget(graph, SMALL_BUDGET) and comment.has_room_for(text):
        comment.add_block(text)
    else:
        comment.add_block(
            f"The picture of what changed is too large for a comment: {comment.command}, with `--format svg` or `html`."
        )
