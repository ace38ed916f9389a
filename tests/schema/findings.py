"""What the schema finds wrong with a text, in one line each."""

from __future__ import annotations

from archgen.schema import validate_document
from archgen.syntax import yaml_parser


def find_mistakes(text: str) -> list[str]:
    """Return `line:column rule: message | help` of each mistake."""
    document, _ = yaml_parser.parse_yaml("f", text)
    assert document is not None
    return [f"{d.span.line}:{d.span.column} {d.rule}: {d.message} | {d.help}" for d in validate_document(document)]
