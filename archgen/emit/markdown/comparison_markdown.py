"""A comparison as the comment on a pull request, for a reviewer who sees nothing else.

Short things come first, long lists are folded, and the length never exceeds what a comment may have: what is left out
is counted, with the command that shows it. Names, titles and messages remain text: see `emit/text/inert.py`.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from archgen.compare import Change, Comparison
from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic, Severity, phrase_severity_counts, sort_gravest_first
from archgen.diagnostics.safe_text import make_visible
from archgen.emit.markdown.inert_text import escape_inert, make_code_cell
from archgen.emit.markdown.limited_comment import MAX_COMMENT_SIZE, LimitedComment
from archgen.emit.markdown.mermaid_chart import write_flowchart
from archgen.emit.text.template_filters import make_code_span
from archgen.views.changes import change_wording
from archgen.views.graphs import changes as pictures
from archgen.views.graphs.changes.group_folding import fits_budget
from archgen.views.inline_text import count_noun
from archgen.views.shapes import Graph, Inlines

_SHOWN_PARTNERS = 12

_MAX_SENTENCE, _MAX_TITLE = 700, 100
"""Maximal number of characters of a sentence, and of a title."""
_MAX_OPEN_ITEMS, _MAX_OPEN_TOTAL = 8, 24
"""How many changes of one group, and of all of them, are not folded."""
_MAX_ERRORS = 5
_MAX_COMMAND = 250
# Escaped: at the beginning of an item "+" would start a list, and "~" a strike-through.
_MARKDOWN_SIGNS = {**change_wording.CHANGE_SIGNS, "added": "\\+", "changed": "\\~"}

ReadingErrors = tuple[Sequence[Diagnostic], Sequence[Diagnostic]]
"""The errors of reading either version."""


@dataclass(frozen=True, slots=True)
class SideNames:
    """The names of both versions, and the command that compares them in a terminal."""

    old_name: str
    new_name: str
    command: str = "archgen diff"


def write_comparison_markdown(
    comparison: Comparison,
    side_names: SideNames,
    reading_errors: ReadingErrors = ((), ()),
    *,
    limit: int = MAX_COMMENT_SIZE,
) -> str:
    """Write the comment, at most `most` characters long; `broken` are the errors of reading either version."""
    comment = LimitedComment(limit, _command_code(side_names))
    comment.add_block(_heading_line(comparison, reading_errors))
    comment.add_block(f"{_code_span(side_names.old_name)} → {_code_span(side_names.new_name)}{_count_line(comparison)}")
    for version_name, errors in zip((side_names.old_name, side_names.new_name), reading_errors, strict=True):
        _add_reading_errors(comment, version_name, errors)
    if comparison.is_empty:
        return comment.write_text()
    _add_breaking_changes(comment, comparison)
    _add_changes(comment, comparison)
    _add_chains(comment, comparison)
    _add_findings(comment, comparison, frozenset(reading_errors[1]))
    # Last, so that the picture never takes the room of the text.
    _add_picture(comment, comparison)
    return comment.write_text()


def _command_code(side_names: SideNames) -> str:
    """Return the command as code, shortened to `archgen diff` if the names are very long."""
    return _code_span(side_names.command if len(side_names.command) <= _MAX_COMMAND else "archgen diff")


def _heading_line(comparison: Comparison, reading_errors: ReadingErrors) -> str:
    """Return the heading: how many changes there are, and whom they break and concern."""
    caveat = " in what could be read" if any(reading_errors) else ""
    if comparison.only_breaking and not comparison.changes:
        return f"### No change breaks another partner{caveat}"
    if not comparison.changes:
        new_count = sum(finding not in reading_errors[1] for finding in comparison.new_findings)
        counts = [count_noun(new_count, "new finding")] if new_count else []
        counts += [count_noun(len(comparison.cured_findings), "cured finding")] if comparison.cured_findings else []
        counts += (
            [count_noun(len(comparison.silenced_findings), "silenced finding")] if comparison.silenced_findings else []
        )
        counts += [count_noun(len(comparison.chains), "chain") + " with another bound"] if comparison.chains else []
        return f"### No change of the architecture{caveat}" + (f", but {' and '.join(counts)}" if counts else "")
    broken_ids = change_wording.broken_partners(comparison.changes)
    notes = [f"breaks {_join_partners(broken_ids)}"] if broken_ids else []
    concerned_ids = [partner for partner in comparison.concerned_owners if partner not in broken_ids]
    notes += [f"{'also ' if broken_ids else ''}concerns {_join_partners(concerned_ids)}"] if concerned_ids else []
    headline = f"### {count_noun(len(comparison.changes), 'change')} of the architecture{caveat}"
    return headline + (f": {', '.join(notes)}" if notes else "")


def _join_partners(partner_ids: Sequence[str]) -> str:
    shown_names = [_code_span(partner_id) for partner_id in partner_ids[:_SHOWN_PARTNERS]] + (
        [f"{len(partner_ids) - _SHOWN_PARTNERS} more"] if len(partner_ids) > _SHOWN_PARTNERS else []
    )
    return join_words(shown_names)


def _count_line(comparison: Comparison) -> str:
    """Count changes by kind, and new findings by severity."""
    phrases = [change_wording.count_by_kind(comparison.changes)] if comparison.changes else []
    new_counts = ", ".join(phrase_severity_counts(comparison.new_findings))
    phrases += [f"new: {new_counts}"] if new_counts else []
    phrases += [count_noun(len(comparison.cured_findings), "finding") + " cured"] if comparison.cured_findings else []
    phrases += (
        [count_noun(len(comparison.silenced_findings), "finding") + " silenced"] if comparison.silenced_findings else []
    )
    return f": {'; '.join(phrases)}" if phrases else ""


def _add_reading_errors(comment: LimitedComment, version_name: str, errors: Sequence[Diagnostic]) -> None:
    if not errors:
        return
    lead = f"**{_code_span(version_name)} is not sound** ({count_noun(len(errors), 'error')}). What cannot be read there is left out of the"
    comment.add_block(f"{lead} comparison:")
    comment.add_items(
        "", [_finding_item(error) for error in errors[:_MAX_ERRORS]], uncounted_items=len(errors) - _MAX_ERRORS
    )


def _add_breaking_changes(comment: LimitedComment, comparison: Comparison) -> None:
    breaking_changes = [change for change in comparison.changes if change.breaks]
    if not breaking_changes:
        return
    comment.add_block("#### Breaking")
    if comparison.is_refused:
        comment.add_block(_sentence_markdown(change_wording.REFUSAL_HELP))
    comment.add_items("", [_breaking_item(change, comparison) for change in breaking_changes])


def _breaking_item(change: Change, comparison: Comparison) -> str:
    lines = [_change_item(change)]
    for reason, partners in change_wording.partners_by_reason(change).items():
        lines.append(f"  - breaks {_join_partners(sorted(set(partners)))}: {_sentence_markdown(reason)}")
    acceptance = change_wording.describe_acceptance(change, comparison)
    return "\n".join((*lines, *([f"  - {_sentence_markdown(acceptance)}"] if acceptance else [])))


def _add_changes(comment: LimitedComment, comparison: Comparison) -> None:
    other_changes = [change for change in comparison.changes if not change.breaks]
    weighty_changes = [change for change in other_changes if not change_wording.is_textual(change)]
    if weighty_changes:
        comment.add_block("#### Changes")
    open_left = _MAX_OPEN_TOTAL
    for change_group in change_wording.group_changes(weighty_changes, comparison):
        # Nine items are shown rather than eight and a fold with one.
        open_count = min(
            len(change_group.changes),
            _MAX_OPEN_ITEMS if len(change_group.changes) > _MAX_OPEN_ITEMS + 1 else _MAX_OPEN_ITEMS + 1,
            max(open_left, 0),
        )
        open_left -= open_count
        comment.add_items(
            f"**{_group_heading(change_group)}**",
            [_change_item(change) for change in change_group.changes],
            "{} more changes" if open_count else "{} changes",
            open_count,
        )
    text_changes = [change for change in other_changes if change_wording.is_textual(change)]
    if text_changes:
        comment.add_items(
            "",
            [_change_item(change) for change in text_changes],
            f"{count_noun(len(text_changes), 'change')} of texts and pictures only",
            0,
        )


def _group_heading(change_group: change_wording.ChangeGroup) -> str:
    title = escape_inert(_shorten_text(make_visible(change_group.title), _MAX_TITLE)) if change_group.title else ""
    return " · ".join(
        word for word in (title, _code_span(change_group.group_id) if change_group.group_id else "") if word
    )


def _change_item(change: Change) -> str:
    return f"- {_MARKDOWN_SIGNS[change.kind]} {_sentence_markdown(change.text)}"


def _add_chains(comment: LimitedComment, comparison: Comparison) -> None:
    rows = [
        (
            make_code_cell(make_visible(chain_change.id)[:_MAX_SENTENCE]),
            escape_inert(change_wording.format_bound(chain_change.before)),
            escape_inert(change_wording.format_bound(chain_change.after)),
            escape_inert(change_wording.format_growth(chain_change).replace("-", "\u2212")),
            escape_inert(change_wording.format_deadline(chain_change)),
            f"**{change_wording.format_verdict(chain_change)}**" if change_wording.format_verdict(chain_change) else "",
        )
        for chain_change in comparison.chains
    ]
    if rows:
        comment.add_block("#### Latency of chains")
        comment.add_table(("chain", "before", "after", "difference", "deadline", "verdict"), rows)


def _add_findings(comment: LimitedComment, comparison: Comparison, told_findings: Collection[Diagnostic]) -> None:
    """Add the new findings, gravest first and notes folded, without the errors in `told`, which were shown already."""
    new_findings = sort_gravest_first(finding for finding in comparison.new_findings if finding not in told_findings)
    grave_count = sum(finding.severity is not Severity.NOTE for finding in new_findings)
    if grave_count:
        comment.add_block("#### New findings")
    open_count = grave_count if grave_count <= _MAX_OPEN_ITEMS + 1 else _MAX_OPEN_ITEMS
    noun = "note" if open_count == grave_count else "finding"
    folded_summary = count_noun(len(new_findings) - open_count, f"{'more' if open_count else 'new'} {noun}")
    comment.add_items("", [_finding_item(finding) for finding in new_findings], folded_summary, open_count)
    if comparison.silenced_findings:
        comment.add_block("#### Silenced findings")
        comment.add_items(
            "",
            [_finding_item(finding) for finding in comparison.silenced_findings],
            "{} more findings",
            _MAX_OPEN_ITEMS,
        )
    if comparison.cured_findings:
        comment.add_items(
            "",
            [_finding_item(finding) for finding in comparison.cured_findings],
            count_noun(len(comparison.cured_findings), "cured finding"),
            0,
        )


def _finding_item(finding: Diagnostic) -> str:
    place_note = f" ({_code_span(str(finding.span))})" if finding.span.file else ""
    return f"- {finding.severity or Severity.ERROR} {_code_span(finding.rule)}: {_sentence_markdown(finding.message)}{place_note}"


def _add_picture(comment: LimitedComment, comparison: Comparison) -> None:
    """Add the first picture that has anything to show; components come before nodes."""
    graphs = pictures.draw_changes(comparison, pictures.SMALL_BUDGET)
    graph = next((graph for graph in graphs if graph.arrows or any(box.change for box in graph.boxes)), None)
    if graph is None:
        return
    text = _mermaid_block(graph)
    if fits_budget(graph, pictures.SMALL_BUDGET) and comment.has_room_for(text):
        comment.add_block(text)
    else:
        comment.add_block(
            f"The picture of what changed is too large for a comment: {comment.command}, with `--format svg` or `html`."
        )


def _mermaid_block(graph: Graph) -> str:
    signs = "\\+ added, \u2212 removed, \\~ changed, → renamed or moved; the rest is as before."
    notes = " ".join((signs, *(_sentence_markdown(note) for note in graph.notes)))
    return "\n".join(("```mermaid", *write_flowchart(graph), "```", "", f"<sub>{notes}</sub>"))


def _sentence_markdown(text: str) -> str:
    """Return a sentence of ours, with names from the project in it, as Markdown; what is in backticks is code."""
    return _runs_markdown(change_wording.text_runs(_shorten_text(make_visible(" ".join(text.split())), _MAX_SENTENCE)))


def _shorten_text(text: str, limit: int) -> str:
    return text if len(text) <= limit else f"{text[: limit - 1]}…"


def _runs_markdown(runs: Inlines) -> str:
    return "".join(_escape_piece(run.text) if not run.code else make_code_span(run.text) for run in runs)


def _escape_piece(text: str) -> str:
    """Escape a piece of a sentence, keeping the blanks at its ends."""
    leading_blank, trailing_blank = (" " if text[:1] == " " else ""), (" " if text[-1:] == " " and text.strip() else "")
    return f"{leading_blank}{escape_inert(text)}{trailing_blank}" if text.strip() else " "


def _code_span(text: str) -> str:
    return make_code_span(make_visible(text)[:_MAX_SENTENCE])
