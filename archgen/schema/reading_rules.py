"""The rules of reading, for syntax and schema alike: what can be wrong with a file by itself."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity


def _make_fixed_rule(name: str, doc: str) -> Rule:
    return Rule(name, Severity.ERROR, doc, fixed=True)


RULES: tuple[Rule, ...] = (
    _make_fixed_rule("syntax-error", "A file is not YAML, or not a text file."),
    _make_fixed_rule("merge-conflict", "A file holds the markers of a merge that Git could not finish."),
    _make_fixed_rule("duplicate-key", "One mapping has the same key twice."),
    _make_fixed_rule("recursive-alias", "An alias stands inside of the value that it stands for."),
    _make_fixed_rule("too-large", "A file is larger, deeper or, with its aliases expanded, longer than archgen reads."),
    _make_fixed_rule("unknown-key", "A key that the language does not have."),
    _make_fixed_rule(
        "missing-key", "An element lacks the key without which it means nothing, in all files of the project."
    ),
    _make_fixed_rule(
        "wrong-type",
        "A value is of another kind than its key takes: text instead of a mapping, or instead of a number.",
    ),
    _make_fixed_rule(
        "wrong-value",
        "A value that its key does not take: an unknown word, a quantity without its unit, an id that is none.",
    ),
    Rule(
        "swallowed-text",
        Severity.NOTE,
        "A comment right after plain text looks as if it were meant as a part of the text.",
    ),
)
