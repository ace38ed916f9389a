"""Cases of rules: projects with the findings written at the lines that they are about, as in tests/analyses/cases.

A file holds cases. Each begins with a line `== RULE, RULE: what it shows`; findings of other rules are left out. Its
input is indented by four columns; a line `-- NAME` begins a file of its own (without one, the project is one file). The
column left of the input holds a `#` where a line says what archgen finds in the line above:

    == unread-output: nobody reads the depth image
        groups: {g: {components: {camera: {outputs: {depth: Depth image}}}}}
    #                                                ^^^^^ warning unread-output (g.camera): nobody reads `depth` of `g.camera`
    #                                                = help: let an input name it in `from`, or ...

`^^^` is a finding: severity, rule, element, message. `---` is one of its labels, wherever that stands. Where a case has
several findings, each line begins with the number of its own: `[2]`. A span that ends on another line says on which
(`to +2:14`: two lines below, column 14), one without width is a `!`, and what is written nowhere stands at the end, at `?`.

Tests compare the text of a case with its input and what is found in it. `--update-golden` writes what is found.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import Span
from archgen.pipeline import check_project

_GUTTER = "    "
_ONLY_FILE = "project.yaml"
# The line of a finding: its drawing (`^^^`, `^^^ to +2:14`, `!`, `? a.yaml:1:1`), its number, its severity, its rule.
_HEADLINE = re.compile(
    r"^# +(?:\^+(?: to \S+)?|!|\?(?: \S+)?) (?:\[\d+\] )?(?:error|warning|note) ([a-z-]+)(?= \(|:)", re.MULTILINE
)


@dataclass(frozen=True)
class RuleCase:
    """One case: the rules that it is about, and its text as it stands in the file, title included."""

    file: Path
    title: str
    rules: frozenset[str]
    text: str

    @property
    def expected_rules(self) -> frozenset[str]:
        """The rules that the case expects a finding of."""
        return frozenset(_HEADLINE.findall(self.text))

    def annotate(self, folder: Path) -> str:
        """Check the input in an empty folder and return the case's text with the findings."""
        files = self._read_input()
        for name, lines in files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
        findings = [
            finding
            for finding in check_project(folder / _ONLY_FILE if list(files) == [_ONLY_FILE] else folder).findings
            if finding.rule in self.rules
        ]
        remarks = _remarks_by_line(findings, files)
        annotated = [f"== {self.title}"]
        for name, lines in files.items():
            annotated += [] if list(files) == [_ONLY_FILE] else [f"-- {name}"]
            for number, line in enumerate(lines, 1):
                annotated += [f"{_GUTTER}{line}".rstrip(), *remarks.pop((name, number), ())]
        annotated += [remark for group in remarks.values() for remark in group]
        return "".join(f"{line}\n" for line in annotated)

    def _read_input(self) -> dict[str, list[str]]:
        files: dict[str, list[str]] = {}
        lines: list[str] = []
        for line in self.text.splitlines()[1:]:
            if line.startswith("-- "):
                lines = files.setdefault(line.removeprefix("-- "), [])
            elif not line.startswith("#"):
                assert line.startswith(_GUTTER) or not line, f"{self.file}: {line}"
                (lines if files else files.setdefault(_ONLY_FILE, lines)).append(line.removeprefix(_GUTTER))
        return files


def read_cases(folder: Path) -> Iterator[RuleCase]:
    """Yield the cases of all files of a folder."""
    for file in sorted(folder.glob("*.txt")):
        for part in re.split(r"^(?=== )", file.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
            title = part.partition("\n")[0].removeprefix("== ")
            text = "".join(f"{line}\n" for line in part.rstrip().splitlines())
            yield RuleCase(file, title, frozenset(title.partition(":")[0].split(", ")), text)


def renew_case(case: RuleCase, annotated: str) -> None:
    """Write what is found into the case's file."""
    text = case.file.read_text(encoding="utf-8")
    assert text.count(case.text) == 1, case.title
    case.file.write_text(text.replace(case.text, annotated), encoding="utf-8")


def _remarks_by_line(findings: list[Diagnostic], files: dict[str, list[str]]) -> dict[tuple[str, int], list[str]]:
    """Return the lines to write below each line of the input, by file and line number."""
    remarks: dict[tuple[str, int], list[str]] = defaultdict(list)
    for number, finding in enumerate(findings, 1):
        mark = f"[{number}] " if len(findings) > 1 else ""
        element = f" ({finding.element})" if finding.element else ""
        headline = f"{mark}{finding.severity} {finding.rule}{element}: {finding.message}"
        place, indent, stretch = _draw_span(finding.span, "^", files)
        remarks[place].append(f"{indent}{stretch} {headline}")
        if finding.help is not None:
            remarks[place].append(f"{indent}= {mark}help: {finding.help}")
        for label in finding.labels:
            place, indent, stretch = _draw_span(label.span, "-", files)
            remarks[place].append(f"{indent}{stretch} {mark}{label.text}")
    return remarks


def _draw_span(span: Span, sign: str, files: dict[str, list[str]]) -> tuple[tuple[str, int], str, str]:
    """Return the place of a span (file, line), the indent of what is written below it, and its drawing."""
    lines = files.get(span.file, [])
    if not 0 < span.line <= len(lines):
        return ("", 0), "#   ", f"? {span.file}:{span.line}:{span.column}" if span.file else "?"
    indent = "#" + " " * (len(_GUTTER) + span.column - 2)
    if span.end_line > span.line:
        width = len(lines[span.line - 1]) - span.column + 1
        return (
            (span.file, span.line),
            indent,
            f"{sign * max(width, 1)} to +{span.end_line - span.line}:{span.end_column}",
        )
    return (span.file, span.line), indent, sign * (span.end_column - span.column) or "!"


def case_ids(cases: Iterable[RuleCase]) -> list[str]:
    """Return the names of cases for pytest."""
    return [f"{case.file.stem}: {case.title}" for case in cases]
