"""Read a baseline: the findings that a project knows and will fix in its own time (docs/checks.md)."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from archgen.diagnostics import Diagnostic, Rule, did_you_mean, name_rule
from archgen.diagnostics.finding_identity import BaselineEntry
from archgen.syntax import project_files, yaml_parser
from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode

BASELINE_KEY = "archgen_baseline"
"""The key that tells a baseline from all other files; its value is the version of the format."""
_FINDING_KEYS = ("rule", "element", "message", "count")
_MAX_COUNT = 1_000_000
_BASELINE_LINE = re.compile(rf"^{BASELINE_KEY}[ \t]*:", re.MULTILINE)


def is_baseline(text: str) -> bool:
    """Whether a text is a baseline, even one that cannot be parsed.

    Only such a file may be overwritten: one that a merge broke can be written anew, anything else is somebody's work.
    """
    return _BASELINE_LINE.search(text) is not None


def read_baseline(
    file: Path, display_name: str, rules: Mapping[str, Rule]
) -> tuple[str, tuple[BaselineEntry, ...], tuple[Diagnostic, ...]]:
    """Return a baseline's text, the findings that it lists, and what is wrong with it.

    Diagnostics name the file `display_name`. An entry with a mistake is left out; with a syntax error nothing is used.
    """
    # Through FolderFiles for its protections: size, pipes, encoding, and no link out of the baseline's own folder.
    file_text = project_files.read_text_file(FolderFiles(file.parent.resolve()), file.name)
    if file_text.problem:
        span = file_text.problem.span._replace(file=display_name)
        return (
            file_text.text,
            (),
            (Diagnostic(file_text.problem.rule, file_text.problem.message, span, help=file_text.problem.help),),
        )
    document, yaml_diagnostics = yaml_parser.parse_yaml(display_name, file_text.text)
    if document is None:
        return file_text.text, (), yaml_diagnostics
    diagnostics = list(yaml_diagnostics)
    return file_text.text, tuple(_read_entries(document.root, rules, diagnostics)), tuple(diagnostics)


def _read_entries(
    root: MappingNode, rules: Mapping[str, Rule], diagnostics: list[Diagnostic]
) -> Iterator[BaselineEntry]:
    version = root.get(BASELINE_KEY)
    if not isinstance(version, ScalarNode) or version.value != 1:
        message = f"this is no baseline: it does not say `{BASELINE_KEY}: 1`"
        span = root.entries[BASELINE_KEY].value.span if version else root.span
        diagnostics.append(
            Diagnostic("wrong-value", message, span, help="`archgen check --update-baseline` writes one")
        )
        return
    diagnostics += _find_unknown_keys(root, (BASELINE_KEY, "findings"))
    findings_node = root.get("findings")
    if isinstance(findings_node, SequenceNode):
        for item in findings_node.items:
            yield from _read_entry(item, rules, diagnostics)
    elif findings_node is not None and not (isinstance(findings_node, ScalarNode) and findings_node.value is None):
        diagnostics.append(
            Diagnostic("wrong-value", "`findings` takes a list", findings_node.span, help="`- rule: ...` for each")
        )


def _read_entry(item: YamlNode, rules: Mapping[str, Rule], diagnostics: list[Diagnostic]) -> Iterator[BaselineEntry]:
    if not isinstance(item, MappingNode):
        diagnostics.append(Diagnostic("wrong-value", "a finding takes the keys rule, element and message", item.span))
        return
    entry_diagnostics = [*_find_unknown_keys(item, _FINDING_KEYS), *_find_wrong_values(item), *_find_missing_keys(item)]
    diagnostics += entry_diagnostics
    rule, message = name_rule(_get_text(item, "rule")), _get_text(item, "message")
    if entry_diagnostics:
        return
    if rule not in rules or rules[rule].fixed:
        diagnostics.append(_diagnose_unusable_rule(rule, item.entries["rule"], rules))
        return
    count = item.get("count")
    number = count.value if isinstance(count, ScalarNode) and isinstance(count.value, int) else 1
    yield BaselineEntry(rule, _get_text(item, "element"), message, number, item.entries["rule"].key_span)


def _find_unknown_keys(mapping: MappingNode, keys: Iterable[str]) -> Iterator[Diagnostic]:
    for entry in mapping:
        if entry.key not in keys:
            help_line = did_you_mean(entry.key, keys) or f"it takes {', '.join(keys)}"
            yield Diagnostic("unknown-key", f"a baseline has no key `{entry.key}` here", entry.key_span, help=help_line)


def _find_wrong_values(mapping: MappingNode) -> Iterator[Diagnostic]:
    for key in ("rule", "element", "message"):
        value = mapping.get(key)
        if value is not None and not isinstance(value, ScalarNode):
            yield Diagnostic("wrong-value", f"`{key}` takes text", value.span)
    count = mapping.get("count")
    number = count.value if isinstance(count, ScalarNode) else None
    # `type(...) is`, because True is an int too.
    if count is not None and (type(number) is not int or not 0 < number <= _MAX_COUNT):
        yield Diagnostic("wrong-value", f"`count` takes a whole number from 1 to {_MAX_COUNT}", count.span)


def _find_missing_keys(mapping: MappingNode) -> Iterator[Diagnostic]:
    for key in ("rule", "message"):
        if key not in mapping.entries:
            help_line = "`archgen check --update-baseline` writes the file anew"
            yield Diagnostic("missing-key", f"this finding has no `{key}`", mapping.span, help=help_line)


def _diagnose_unusable_rule(name: str, entry: MappingEntry, rules: Mapping[str, Rule]) -> Diagnostic:
    if name in rules:
        message = f"`{name}` cannot be known in advance: what comes after reading and linking rests on it"
        return Diagnostic(
            "unknown-rule", message, entry.value.span, help="mend what it reports, and take the entry out"
        )
    help_line = did_you_mean(name, (rule.name for rule in rules.values() if not rule.fixed))
    return Diagnostic("unknown-rule", f"there is no rule `{name}`", entry.value.span, help=help_line)


def _get_text(mapping: MappingNode, key: str) -> str:
    value = mapping.get(key)
    return value.text if isinstance(value, ScalarNode) else ""
