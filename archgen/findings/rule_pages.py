"""A rule's page, for the terminal and as Markdown: what it reports, why, and an example that is reported and one that
is not. Those of archgen's own rules are docs/rules/NAME.md; that of a rule of another package is its docstring.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Mapping

from archgen import resources
from archgen.diagnostics import Rule
from archgen.diagnostics.text_columns import wrap_line
from archgen.frozen import NamedTuple

_TEXT_WIDTH = 100
_SECTION_PATTERN = re.compile(
    r"^(Why:|Bad:|Good:|## (?:Why|Options|Reported|Not reported|To change it)$)", re.MULTILINE
)
"""Where a section begins, in a docstring and in Markdown."""


class RulePage(NamedTuple):
    """The parts of a rule's page; the examples are one-file projects."""

    summary: str
    why: str
    bad: str
    good: str


def summarise_rule(rule: Rule) -> str:
    """Return the sentence that says what a rule finds; its page is not read for that."""
    return " ".join(_SECTION_PATTERN.split(rule.doc, maxsplit=1)[0].split())


def read_rule_page(rule: Rule) -> RulePage:
    """Read a rule's page and split it into its parts."""
    path = resources.resource_path("docs", "rules", f"{rule.name}.md")
    page = path.read_text(encoding="utf-8") if path.is_file() else rule.doc
    # The pattern has a group, so that headings and texts of the sections alternate in the result.
    _, *section_parts = _SECTION_PATTERN.split(page)
    sections = dict(zip(section_parts[::2], section_parts[1::2], strict=True))
    why, bad, good = (
        sections.get(in_docstring) or sections.get(in_markdown, "")
        for in_docstring, in_markdown in (("Why:", "## Why"), ("Bad:", "## Reported"), ("Good:", "## Not reported"))
    )
    return RulePage(summarise_rule(rule), why.strip(), _read_example(bad), _read_example(good))


def format_rule_page(rule: Rule, *, colour: bool = False, width: int | None = None) -> str:
    """Return a rule's page as text for a terminal; examples keep their lines."""
    rule_page = read_rule_page(rule)
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
    rule_page = read_rule_page(rule)
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
        f"| [{rule.name}]({rule.name}.md) | {_describe_severity(rule)} | {_escape_cell(summarise_rule(rule))} |"
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


def _read_example(text: str) -> str:
    """Remove what sets an example off: indentation in a docstring, fences in Markdown."""
    lines = text.strip("\n").rstrip().splitlines()
    if lines and lines[0].startswith("```"):
        lines = lines[1:-1]
    indent = min((len(line) - len(line.lstrip()) for line in lines if line.strip()), default=0)
    return "\n".join(line[indent:] for line in lines)


def _fold_paragraphs(text: str) -> Iterable[str]:
    """Join each paragraph into one line: the reader's screen decides where it breaks."""
    return (" ".join(paragraph.split()) for paragraph in re.split(r"\n\s*\n", text) if paragraph.strip())


def _escape_cell(text: str) -> str:
    return text.replace("|", "\\|")
