"""What a pass of rules wrote is held against the language: rules may write any value anywhere."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.source_span import Span
from archgen.passes.patterns.pass_shapes import WRONG_PASS, PatternPass
from archgen.schema import validate_document
from archgen.syntax.yaml_tree import MappingNode, YamlDocument, copy_node


def check_result(pattern_pass: PatternPass, before: MappingNode, after: MappingNode) -> Iterator[Diagnostic]:
    """Yield what a pass made of a project that no file may hold. Neither tree is changed."""
    findings = _validate_copy(after, pattern_pass.file)
    known = {(each.message, each.span) for each in _validate_copy(before, pattern_pass.file)} if findings else set()
    for finding in findings:
        if (finding.message, finding.span) not in known:
            yield Diagnostic(
                WRONG_PASS,
                f"the pass `{pattern_pass.name}` writes what no file may hold: {finding.message}",
                Span.of_file(pattern_pass.file),
                labels=(Label(finding.span, "made from this"),),
                help=finding.help,
            )


def _validate_copy(root: MappingNode, file: str) -> tuple[Diagnostic, ...]:
    # Validating takes out what is wrong.
    copied_root = copy_node(root, root.span)
    return validate_document(YamlDocument(file, copied_root)) if isinstance(copied_root, MappingNode) else ()
