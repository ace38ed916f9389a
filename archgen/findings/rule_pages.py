"""A rule's page, for the terminal and as Markdown: what it reports, why, and an example that is reported and one that
is not.
"""

from __future__ import annotations

import re
import textwrap
from typing import TYPE_CHECKING, NamedTuple

from archgen.diagnostics.text_columns import wrap_line

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from archgen.diagnostics.diagnostic import Rule

_TEXT_WIDTH = 100
_SECTION_PATTERN = re.compile(r"^(Why|Bad|Good):[ ]?", re.MULTILINE)


class RulePage(NamedTuple):
    """The parts of a rule's page; the examples are one-file projects."""

    summary: str
    why: str
    bad: str
    good: str


def parse_rule_page(rule: Rule) -> RulePage:
    """Split a rule's page into its parts."""
    # The pattern has a group, so that names and texts of the sections alternate in the result.
    summary, *section_parts = _SECTION_PATTERN.split(rule.doc)
    sections = dict(zip(section_parts[::2], section_parts[1::2], strict=True))
    return RulePage(
        " ".join(summary.split()),
        sections.get("Why", "").strip(),
        _dedent_example(sections.get("Bad", "")),
        _dedent_example(sections.get("Good", "")),
    )


def format_rule_page(rule: Rule, *, colour: bool = False, width: int | None = None) -> str:
    """Return a rule's page as text for a terminal; examples keep their lines."""
    rule_page = parse_rule_page(rule)
    bold = ("\x1b[1m", "\x1b[0m") if colour else ("", "")
    text_width = min(width or _TEXT_WIDTH, _TEXT_WIDTH)
    prose = (
        textwrap.fill(paragraph, text_width) for paragraph in (rule_page.summary, *_fold_paragraphs(rule_page.why))
    )
    blocks = [f"{bold[0]}{rule.name}{bold[1]} ({_describe_severity(rule)})", *prose]
    if rule.options:
        blocks += [
            f"{bold[0]}Options:{bold[1]}",
            "\n".join(part for line in _describe_options(rule) for part in wrap_line(f"    {line}", width)),
        ]
    for title, example in (("Reported:", rule_page.bad), ("Not reported:", rule_page.good)):
        if example:
            blocks += [f"{bold[0]}{title}{bold[1]}", "\n".join(f"    {line}".rstrip() for line in example.splitlines())]
    return "\n\n".join(blocks) + "\n"


def rule_page_to_markdown(rule: Rule) -> str:
    """Return a rule's page as Markdown."""
    rule_page = parse_rule_page(rule)
    blocks = [
        f"# {rule.name}",
        rule_page.summary,
        f"*{_describe_severity(rule)[0].upper()}{_describe_severity(rule)[1:]}.*",
    ]
    blocks += ["## Why", *_fold_paragraphs(rule_page.why)] if rule_page.why else []
    blocks += ["## Options", "\n".join(f"- {line}" for line in _describe_options(rule))] if rule.options else []
    for title, example in (("Reported", rule_page.bad), ("Not reported", rule_page.good)):
        blocks += [f"## {title}", f"```yaml\n{example}\n```"] if example else []
    if rule.setting:
        blocks += ["## To change it", f"In `archgen.yaml`:\n\n```yaml\n{rule.setting}\n```"]
    elif not rule.fixed:
        setting = f"rules: {{{rule.name}: note}}  # off, note, warning or error"
        comment = f"# archgen: ignore[{rule.name}] because ..."
        blocks += ["## To change it", f"For the whole project, in `archgen.yaml`:\n\n```yaml\n{setting}\n```"]
        if rule.options:
            option = rule.options[0]
            example = f"rules: {{{rule.name}: {{severity: note, {option.name}: {option.example} %}}}}"
            blocks.append(f"With an option:\n\n```yaml\n{example}\n```")
        blocks += [f"In one place, at the end of the line that it points at:\n\n```yaml\n{comment}\n```"]
    return "\n\n".join(blocks) + "\n"


def format_rule_index(rules: Mapping[str, Rule]) -> str:
    """Return the list of all rules' pages as Markdown."""
    lines = [
        f"| [{rule.name}]({rule.name}.md) | {_describe_severity(rule)} | {_escape_cell(parse_rule_page(rule).summary)} |"
        for rule in rules.values()
    ]
    head = ["# Rules", "", "What archgen reports. `archgen explain NAME` shows a rule's page in the terminal.", ""]
    return "\n".join([*head, "| rule | severity | what it finds |", "|---|---|---|", *lines]) + "\n"


def _describe_options(rule: Rule) -> Iterable[str]:
    """Yield a line for each option."""
    return (
        f"`{option.name}`: {option.summary} {option.range_phrase.capitalize()}; without it {option.default} %."
        for option in rule.options
    )


def _describe_severity(rule: Rule) -> str:
    severity = f"{rule.severity}, cannot be changed" if rule.fixed else str(rule.severity)
    return f"{severity}, of {rule.origin}" if rule.origin else severity


def _dedent_example(text: str) -> str:
    """Remove the indentation of an example."""
    lines = text.strip("\n").rstrip().splitlines()
    indent = min((len(line) - len(line.lstrip()) for line in lines if line.strip()), default=0)
    return "\n".join(line[indent:] for line in lines)


def _fold_paragraphs(text: str) -> Iterable[str]:
    """Join each paragraph into one line: the reader's screen decides where it breaks."""
    return (" ".join(paragraph.split()) for paragraph in re.split(r"\n\s*\n", text) if paragraph.strip())


def _escape_cell(text: str) -> str:
    return text.replace("|", "\\|")
