"""Read a baseline: the findings that a project knows and will fix in its own time (docs/checks.md)."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from archgen.diagnostic import Diagnostic, Rule
from archgen.identity import Known
from archgen.suggest import did_you_mean
from archgen.syntax import files, yaml
from archgen.syntax.folder import Folder
from archgen.syntax.tree import Entry, Listing, Scalar, Table, Value

MARK = "archgen_baseline"
"""The key that tells a baseline from all other files; its value is the version of the format."""
_KEYS = ("rule", "element", "message", "count")
_MOST = 1_000_000
_OWN = re.compile(rf"^{MARK}[ \t]*:", re.MULTILINE)


def is_own(text: str) -> bool:
    """Whether a text is a baseline, even one that cannot be parsed.

    Only such a file may be overwritten: one that a merge broke can be written anew, anything else is somebody's work.
    """
    return _OWN.search(text) is not None


def read(file: Path, shown: str, rules: Mapping[str, Rule]) -> tuple[str, tuple[Known, ...], tuple[Diagnostic, ...]]:
    """Return a baseline's text, the findings that it lists, and what is wrong with it.

    Diagnostics name the file `display_name`. An entry with a mistake is left out; with a syntax error nothing is used.
    """
    # Through FolderFiles for its protections: size, pipes, encoding, and no link out of the baseline's own folder.
    text = files.read(Folder(file.parent.resolve()), file.name)
    if text.problem:
        place = text.problem.span._replace(file=shown)
        return text.text, (), (Diagnostic(text.problem.rule, text.problem.message, place, help=text.problem.help),)
    document, problems = yaml.parse(shown, text.text)
    if document is None:
        return text.text, (), problems
    found = list(problems)
    return text.text, tuple(_entries(document.root, rules, found)), tuple(found)


def _entries(root: Table, rules: Mapping[str, Rule], found: list[Diagnostic]) -> Iterator[Known]:
    version = root.get(MARK)
    if not isinstance(version, Scalar) or version.value != 1:
        message = f"this is no baseline: it does not say `{MARK}: 1`"
        at = root.entries[MARK].value.at if version else root.at
        found.append(Diagnostic("wrong-value", message, at, help="`archgen check --update-baseline` writes one"))
        return
    found += _unknown(root, (MARK, "findings"))
    listed = root.get("findings")
    if isinstance(listed, Listing):
        for item in listed.items:
            yield from _entry(item, rules, found)
    elif listed is not None and not (isinstance(listed, Scalar) and listed.value is None):
        found.append(Diagnostic("wrong-value", "`findings` takes a list", listed.at, help="`- rule: ...` for each"))


def _entry(item: Value, rules: Mapping[str, Rule], found: list[Diagnostic]) -> Iterator[Known]:
    if not isinstance(item, Table):
        found.append(Diagnostic("wrong-value", "a finding takes the keys rule, element and message", item.at))
        return
    wrong = [*_unknown(item, _KEYS), *_wrong(item), *_missing(item)]
    found += wrong
    rule, message = _text(item, "rule"), _text(item, "message")
    if wrong:
        return
    if rule not in rules or rules[rule].fixed:
        found.append(_no_rule(rule, item.entries["rule"], rules))
        return
    count = item.get("count")
    number = count.value if isinstance(count, Scalar) and isinstance(count.value, int) else 1
    yield Known(rule, _text(item, "element"), message, number, item.entries["rule"].at)


def _unknown(table: Table, keys: Iterable[str]) -> Iterator[Diagnostic]:
    for entry in table:
        if entry.key not in keys:
            cure = did_you_mean(entry.key, keys) or f"it takes {', '.join(keys)}"
            yield Diagnostic("unknown-key", f"a baseline has no key `{entry.key}` here", entry.at, help=cure)


def _wrong(table: Table) -> Iterator[Diagnostic]:
    for key in ("rule", "element", "message"):
        value = table.get(key)
        if value is not None and not isinstance(value, Scalar):
            yield Diagnostic("wrong-value", f"`{key}` takes text", value.at)
    count = table.get("count")
    number = count.value if isinstance(count, Scalar) else None
    # `type(...) is`, because True is an int too.
    if count is not None and (type(number) is not int or not 0 < number <= _MOST):
        yield Diagnostic("wrong-value", f"`count` takes a whole number from 1 to {_MOST}", count.at)


def _missing(table: Table) -> Iterator[Diagnostic]:
    for key in ("rule", "message"):
        if key not in table.entries:
            cure = "`archgen check --update-baseline` writes the file anew"
            yield Diagnostic("missing-key", f"this finding has no `{key}`", table.at, help=cure)


def _no_rule(name: str, entry: Entry, rules: Mapping[str, Rule]) -> Diagnostic:
    if name in rules:
        message = f"`{name}` cannot be known in advance: what comes after reading and linking rests on it"
        return Diagnostic("unknown-rule", message, entry.value.at, help="mend what it reports, and take the entry out")
    cure = did_you_mean(name, (rule.name for rule in rules.values() if not rule.fixed))
    return Diagnostic("unknown-rule", f"there is no rule `{name}`", entry.value.at, help=cure)


def _text(table: Table, key: str) -> str:
    value = table.get(key)
    return value.text if isinstance(value, Scalar) else ""
