"""A comparison as the comment on a pull request, for a reviewer who sees nothing else.

Short things come first, long lists are folded, and the length never exceeds what a comment may have: what is left out
is counted, with the command that shows it. Names, titles and messages remain text: see `emit/text/inert.py`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from archgen.compare import Change, Comparison
from archgen.diagnostic import Diagnostic, Severity
from archgen.emit.text.filters import code
from archgen.emit.text.inert import cell, plain
from archgen.emit.text.mermaid import flowchart
from archgen.findings.comment import MOST, Comment
from archgen.findings.escape import visible
from archgen.views.changes import telling
from archgen.views.graphs import changes as pictures
from archgen.views.graphs.changes.folded import fits
from archgen.views.shapes import Graph, Inlines
from archgen.views.words import plural

_LONGEST, _TITLE = 700, 100
"""Maximal number of characters of a sentence, and of a title."""
_OPEN, _OPEN_IN_ALL = 8, 24
"""How many changes of one group, and of all of them, are not folded."""
_ERRORS = 5
_COMMAND = 250
# Escaped: at the beginning of an item "+" would start a list, and "~" a strike-through.
_SIGNS = {**telling.SIGNS, "added": "\\+", "changed": "\\~"}

Broken = tuple[Sequence[Diagnostic], Sequence[Diagnostic]]
"""The errors of reading either version."""


@dataclass(frozen=True, slots=True)
class Names:
    """The names of both versions, and the command that compares them in a terminal."""

    before: str
    after: str
    command: str = "archgen diff"


def render(
    found: Comparison,
    names: Names,
    broken: Broken = ((), ()),
    *,
    most: int = MOST,
) -> str:
    """Write the comment, at most `most` characters long; `broken` are the errors of reading either version."""
    comment = Comment(most, _command(names))
    comment.add(_heading(found, broken))
    comment.add(f"{_code(names.before)} → {_code(names.after)}{_counts(found)}")
    for side, errors in zip((names.before, names.after), broken, strict=True):
        _unsound(comment, side, errors)
    if found.empty:
        return comment.text()
    _breaking(comment, found)
    _changes(comment, found)
    _chains(comment, found)
    _findings(comment, found, frozenset(broken[1]))
    # Last, so that the picture never takes the room of the text.
    _picture(comment, found)
    return comment.text()


def _command(names: Names) -> str:
    """Return the command as code, shortened to `archgen diff` if the names are very long."""
    return _code(names.command if len(names.command) <= _COMMAND else "archgen diff")


def _heading(found: Comparison, broken: Broken) -> str:
    """Return the heading: how many changes there are, and whom they break and concern."""
    unsure = " in what could be read" if any(broken) else ""
    if found.narrowed and not found.changes:
        return f"### No change breaks another partner{unsure}"
    if not found.changes:
        new = sum(each not in broken[1] for each in found.new)
        counts = [plural(new, "new finding")] if new else []
        counts += [plural(len(found.cured), "cured finding")] if found.cured else []
        counts += [plural(len(found.silenced), "silenced finding")] if found.silenced else []
        counts += [plural(len(found.chains), "chain") + " with another bound"] if found.chains else []
        return f"### No change of the architecture{unsure}" + (f", but {' and '.join(counts)}" if counts else "")
    losers = telling.broken(found.changes)
    tail = [f"breaks {_partners(losers)}"] if losers else []
    others = [partner for partner in found.owners if partner not in losers]
    tail += [f"{'also ' if losers else ''}concerns {_partners(others)}"] if others else []
    said = f"### {plural(len(found.changes), 'change')} of the architecture{unsure}"
    return said + (f": {', '.join(tail)}" if tail else "")


def _partners(names: Sequence[str]) -> str:
    shown = [_code(name) for name in names[:12]] + ([f"{len(names) - 12} more"] if len(names) > 12 else [])  # noqa: PLR2004
    return " and ".join((", ".join(shown[:-1]), shown[-1])) if len(shown) > 1 else shown[0]


def _counts(found: Comparison) -> str:
    """Count changes by kind, and new findings by severity."""
    said = [telling.by_kind(found.changes)] if found.changes else []
    severities = Counter(str(each.severity or Severity.ERROR) for each in found.new)
    new = ", ".join(plural(severities[name], name) for name in ("error", "warning", "note") if severities[name])
    said += [f"new: {new}"] if new else []
    said += [plural(len(found.cured), "finding") + " cured"] if found.cured else []
    said += [plural(len(found.silenced), "finding") + " silenced"] if found.silenced else []
    return f": {'; '.join(said)}" if said else ""


def _unsound(comment: Comment, side: str, errors: Sequence[Diagnostic]) -> None:
    if not errors:
        return
    said = (
        f"**{_code(side)} is not sound** ({plural(len(errors), 'error')}). What cannot be read there is left out of the"
    )
    comment.add(f"{said} comparison:")
    comment.items("", [_finding(error) for error in errors[:_ERRORS]], less=len(errors) - _ERRORS)


def _breaking(comment: Comment, found: Comparison) -> None:
    breaking = [change for change in found.changes if change.breaks]
    if not breaking:
        return
    comment.add("#### Breaking")
    if found.failing:
        comment.add(_sentence(telling.REFUSED))
    comment.items("", [_breaks(change, found) for change in breaking])


def _breaks(change: Change, found: Comparison) -> str:
    lines = [_change(change)]
    for why, partners in telling.reasons(change).items():
        lines.append(f"  - breaks {_partners(sorted(set(partners)))}: {_sentence(why)}")
    accepted = telling.accepted(change, found)
    return "\n".join((*lines, *([f"  - {_sentence(accepted)}"] if accepted else [])))


def _changes(comment: Comment, found: Comparison) -> None:
    others = [change for change in found.changes if not change.breaks]
    weighty = [change for change in others if not telling.textual(change)]
    if weighty:
        comment.add("#### Changes")
    left = _OPEN_IN_ALL
    for part in telling.parts(weighty, found):
        # Nine items are shown rather than eight and a fold with one.
        shown = min(len(part.changes), _OPEN if len(part.changes) > _OPEN + 1 else _OPEN + 1, max(left, 0))
        left -= shown
        comment.items(
            f"**{_named(part)}**",
            [_change(change) for change in part.changes],
            "{} more changes" if shown else "{} changes",
            shown,
        )
    texts = [change for change in others if telling.textual(change)]
    if texts:
        comment.items(
            "", [_change(change) for change in texts], f"{plural(len(texts), 'change')} of texts and pictures only", 0
        )


def _named(part: telling.Part) -> str:
    title = plain(_cut(visible(part.title), _TITLE)) if part.title else ""
    return " · ".join(word for word in (title, _code(part.id) if part.id else "") if word)


def _change(change: Change) -> str:
    return f"- {_SIGNS[change.kind]} {_sentence(change.text)}"


def _chains(comment: Comment, found: Comparison) -> None:
    rows = [
        (
            cell(visible(each.id)[:_LONGEST]),
            plain(telling.bound(each.before)),
            plain(telling.bound(each.after)),
            plain(telling.grown(each).replace("-", "\u2212")),
            plain(telling.deadline(each)),
            f"**{telling.verdict(each)}**" if telling.verdict(each) else "",
        )
        for each in found.chains
    ]
    if rows:
        comment.add("#### Latency of chains")
        comment.table(("chain", "before", "after", "difference", "deadline", "verdict"), rows)


def _findings(comment: Comment, found: Comparison, told: Collection[Diagnostic]) -> None:
    """Add the new findings, gravest first and notes folded, without the errors in `told`, which were shown already."""
    order = list(Severity)
    new = sorted(
        (each for each in found.new if each not in told), key=lambda each: -order.index(each.severity or Severity.ERROR)
    )
    grave = sum(each.severity is not Severity.NOTE for each in new)
    if grave:
        comment.add("#### New findings")
    shown = grave if grave <= _OPEN + 1 else _OPEN
    noun = "note" if shown == grave else "finding"
    left = plural(len(new) - shown, f"{'more' if shown else 'new'} {noun}")
    comment.items("", [_finding(each) for each in new], left, shown)
    if found.silenced:
        comment.add("#### Silenced findings")
        comment.items("", [_finding(each) for each in found.silenced], "{} more findings", _OPEN)
    if found.cured:
        comment.items("", [_finding(each) for each in found.cured], plural(len(found.cured), "cured finding"), 0)


def _finding(each: Diagnostic) -> str:
    place = f" ({_code(str(each.span))})" if each.span.file else ""
    return f"- {each.severity or Severity.ERROR} {_code(each.rule)}: {_sentence(each.message)}{place}"


def _picture(comment: Comment, found: Comparison) -> None:
    """Add the first picture that has anything to show; components come before nodes."""
    drawn = pictures.pictures(found, pictures.SMALL)
    graph = next((graph for graph in drawn if graph.arrows or any(box.change for box in graph.boxes)), None)
    if graph is None:
        return
    text = _mermaid(graph)
    if fits(graph, pictures.SMALL) and comment.fits(text):
        comment.add(text)
    else:
        comment.add(
            f"The picture of what changed is too large for a comment: {comment.command}, with `--format svg` or `html`."
        )


def _mermaid(graph: Graph) -> str:
    signs = "\\+ added, \u2212 removed, \\~ changed, → renamed or moved; the rest is as before."
    notes = " ".join((signs, *(_sentence(note) for note in graph.notes)))
    return "\n".join(("```mermaid", *flowchart(graph), "```", "", f"<sub>{notes}</sub>"))


def _sentence(text: str) -> str:
    """Return a sentence of ours, with names from the project in it, as Markdown; what is in backticks is code."""
    return _inlines(telling.runs(_cut(visible(" ".join(text.split())), _LONGEST)))


def _cut(text: str, most: int) -> str:
    return text if len(text) <= most else f"{text[: most - 1]}…"


def _inlines(runs: Inlines) -> str:
    return "".join(_kept(run.text) if not run.code else code(run.text) for run in runs)


def _kept(text: str) -> str:
    """Escape a piece of a sentence, keeping the blanks at its ends."""
    lead, trail = (" " if text[:1] == " " else ""), (" " if text[-1:] == " " and text.strip() else "")
    return f"{lead}{plain(text)}{trail}" if text.strip() else " "


def _code(text: str) -> str:
    return code(visible(text)[:_LONGEST])
