"""Passes that are written as rules, among all others: those that ship, and those of a project."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.source_span import SourceTexts, Span
from archgen.frozen import dataclass
from archgen.model.element_ids import is_id
from archgen.passes.pass_registry import PASSES
from archgen.passes.pass_shape import STATES, Pass, PassWork
from archgen.passes.patterns.pass_files import ReadPass, list_project_passes, list_shipped_passes
from archgen.passes.patterns.pass_shapes import WRONG_PASS, PatternPass
from archgen.passes.patterns.rule_running import run_rules
from archgen.project import LoadedProject
from archgen.schema import validate_document
from archgen.syntax.project_files import ProjectFiles
from archgen.syntax.yaml_tree import MappingNode, YamlDocument, copy_node

SHIPPED_PREFIX = "rules."
"""Before the names of the passes that ship as rules: each says what a pass of the same name does, in the language's words."""


@dataclass(frozen=True, slots=True)
class KnownPasses:
    """All passes that a project may ask for, by name, and the files of its own."""

    passes: dict[str, Pass]
    own_files: dict[str, str]
    """The project's own passes: the file of each, by name."""


def find_known_passes(loaded_project: LoadedProject | None) -> KnownPasses:
    """Return the passes of archgen, its passes that are rules, and a project's own. A broken one says so when it runs."""
    passes = dict(PASSES)
    for shipped in list_shipped_passes(tuple(STATES)):
        name = f"{SHIPPED_PREFIX}{shipped.name}"
        passes[name] = _make_pass(name, shipped, shipped.diagnostics)
    own_files: dict[str, str] = {}
    for own in list_project_passes(loaded_project.files, tuple(STATES)) if loaded_project else ():
        loaded_project.sources.add_text(own.file, own.text) if loaded_project else None
        findings = (*own.diagnostics, *_judge_name(own))
        # One that cannot be called so hides none that ships.
        if own.name not in passes:
            passes[own.name] = _make_pass(own.name, own, findings)
            own_files[own.name] = own.file
    return KnownPasses(passes, own_files)


def find_wrong_passes(files: ProjectFiles, sources: SourceTexts) -> Iterator[Diagnostic]:
    """Yield what is wrong with the passes of a project."""
    for own in list_project_passes(files, tuple(STATES)):
        if own.has_rules:
            sources.add_text(own.file, own.text)
            yield from own.diagnostics
            yield from _judge_name(own)


def _judge_name(own: ReadPass) -> Iterator[Diagnostic]:
    if own.name in PASSES:
        message = f"there is a pass `{own.name}` already"
        yield Diagnostic(WRONG_PASS, message, Span.of_file(own.file), help="give its file another name")
    elif not is_id(own.name):
        message = f"`{own.name}` is no name for a pass"
        help_line = "small letters, digits and `_`, as in `tag_cameras.yaml`"
        yield Diagnostic(WRONG_PASS, message, Span.of_file(own.file), help=help_line)


def _make_pass(name: str, read: ReadPass, findings: tuple[Diagnostic, ...]) -> Pass:
    pattern_pass = read.read_pass

    def run(work: PassWork) -> None:
        if pattern_pass is None or findings:
            work.findings += findings
            return
        # A pass that is stopped makes nothing: what it wrote so far is taken back.
        kept_root, kept_provenance = copy_node(work.tree.root, work.tree.root.span), dict(work.tree.provenance)
        problems = run_rules(pattern_pass, work.tree)
        if not problems and isinstance(kept_root, MappingNode):
            problems = tuple(check_result(pattern_pass, kept_root, work.tree.root))
        if problems and isinstance(kept_root, MappingNode):
            work.tree.root, work.tree.provenance = kept_root, kept_provenance
            work.tree.edit_count += 1
        work.findings += problems

    if pattern_pass is None:
        return Pass(name, "cannot be read", run)
    return Pass(name, pattern_pass.title, run, pattern_pass.needs, pattern_pass.leaves, pattern_pass.ends)


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
