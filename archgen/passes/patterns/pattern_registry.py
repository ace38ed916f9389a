"""Passes that are written as rules, among all others: those that ship, and those of a project."""

from __future__ import annotations

from collections.abc import Iterator

from archgen import resources
from archgen.diagnostics import Diagnostic, Label, SourceTexts, Span, did_you_mean
from archgen.frozen import dataclass
from archgen.model.element_ids import is_id
from archgen.passes.pass_running import PASSES
from archgen.passes.pass_shape import STATES, Pass, PassWork
from archgen.passes.patterns.expressions import WRONG_PASS, PatternPass, RewriteRule, diagnose_pass
from archgen.passes.patterns.rule_reading import RuleReader, list_items
from archgen.passes.patterns.rule_running import run_rules
from archgen.project import LoadedProject
from archgen.schema import validate_document
from archgen.syntax.file_patterns import YAML_ENDINGS
from archgen.syntax.project_files import ProjectFiles, read_text_file
from archgen.syntax.yaml_parser import parse_yaml
from archgen.syntax.yaml_tree import (
    MappingNode,
    ScalarNode,
    SequenceNode,
    YamlDocument,
    YamlNode,
    copy_node,
    list_spans,
)

_PASS_FOLDER = "passes"  # noqa: S105 - not a password
"""The folder of a project that holds its own passes."""
FILE_KEYS = ("title", "description", "needs", "leaves", "ends", "rules")
_MAX_TEXT = 200_000
_MAX_VALUES = 20_000
MAX_RULES = 200


@dataclass(frozen=True, slots=True)
class ReadPass:
    """What was read of a pass file: the pass, or what is wrong with it."""

    name: str
    file: str
    text: str
    read_pass: PatternPass | None
    diagnostics: tuple[Diagnostic, ...]
    has_rules: bool = False
    """Whether it is meant as a pass: its `rules` are a list."""


def read_pass(name: str, file: str, text: str, known_states: tuple[str, ...] = ()) -> ReadPass:
    """Read the text of a pass file. `known_states` are what it may say that it needs and leaves."""
    if len(text) > _MAX_TEXT:
        message = f"a pass file of {len(text):,} letters; at most {_MAX_TEXT:,} are read"
        return ReadPass(name, file, text, None, (diagnose_pass(message, Span.of_file(file), "write several passes"),))
    document, findings = parse_yaml(file, text)
    diagnostics = [Diagnostic(WRONG_PASS, f.message, f.span, labels=f.labels, help=f.help) for f in findings]
    if document is None or diagnostics:
        return ReadPass(name, file, text, None, tuple(diagnostics))
    if sum(1 for _ in list_spans(document.root)) > _MAX_VALUES:
        message = f"a pass file of more than {_MAX_VALUES:,} keys and values"
        return ReadPass(name, file, text, None, (diagnose_pass(message, Span.of_file(file), "write several passes"),))
    read = _PassFileReader(name, file, known_states).read(document.root)
    has_rules = isinstance(document.root.get("rules"), SequenceNode)
    return ReadPass(name, file, text, *read, has_rules=has_rules)


class _PassFileReader:
    def __init__(self, name: str, file: str, known_states: tuple[str, ...]) -> None:
        self._name = name
        self._file = file
        self._states = known_states
        self._rules = RuleReader()

    def read(self, root: MappingNode) -> tuple[PatternPass | None, tuple[Diagnostic, ...]]:
        self._rules.refuse_unknown_keys(root, FILE_KEYS, "a pass")
        found = self._rules.diagnostics
        texts = {key: self._read_text(root.get(key), key) for key in ("title", "description")}
        if not texts["title"] and "title" not in root.entries:
            found.append(diagnose_pass("a pass has a title", Span.of_file(self._file), "write `title: What it does.`"))
        lists = {key: self._read_states(root.get(key)) for key in ("needs", "leaves", "ends")}
        rules_entry = root.entries.get("rules")
        rules: list[RewriteRule] = []
        if rules_entry is None or not isinstance(rules_entry.value, SequenceNode) or not rules_entry.value.items:
            place = rules_entry.key_span if rules_entry else Span.of_file(self._file)
            found.append(
                diagnose_pass("a pass has a list of rules", place, "write `rules:` and below it `- find: {...}`")
            )
        elif len(rules_entry.value.items) > MAX_RULES:
            message = f"{len(rules_entry.value.items):,} rules; a pass has at most {MAX_RULES}"
            found.append(diagnose_pass(message, rules_entry.key_span, "write several passes"))
        else:
            read_rules = [self._rules.read_rule(item) for item in rules_entry.value.items]
            rules = [rule for rule in read_rules if rule is not None]
        if found:
            return None, tuple(found)
        return PatternPass(self._name, texts["title"], texts["description"], tuple(rules), self._file, **lists), ()

    def _read_text(self, node: YamlNode | None, key: str) -> str:
        if node is None:
            return ""
        if not isinstance(node, ScalarNode) or node.value is None or not node.text.strip():
            self._rules.diagnostics.append(diagnose_pass(f"`{key}` is a text", node.span, None))
            return ""
        return node.text

    def _read_states(self, node: YamlNode | None) -> tuple[str, ...]:
        words: list[str] = []
        for item in list_items(node):
            word = item.text if isinstance(item, ScalarNode) else ""
            if word in self._states:
                words.append(word)
                continue
            help_line = (
                did_you_mean(word, self._states) or f"there are {', '.join(f'`{each}`' for each in self._states)}"
            )
            self._rules.diagnostics.append(
                diagnose_pass(f"`{word}` is nothing that passes leave true", item.span, help_line)
            )
        return tuple(words)


def list_shipped_passes(known_states: tuple[str, ...] = ()) -> Iterator[ReadPass]:
    """Yield the passes that ship with archgen, by name."""
    folder = resources.resource_path(_PASS_FOLDER)
    for file in sorted(folder.glob("*.yaml")):
        yield read_pass(file.stem, f"{_PASS_FOLDER}/{file.name}", file.read_text("utf-8"), known_states)


def list_project_passes(files: ProjectFiles, known_states: tuple[str, ...] = ()) -> Iterator[ReadPass]:
    """Yield the passes of a project, by name. A file behind a link is refused: it could lead out of the project."""
    for file in _list_pass_files(files):
        name = file.removeprefix(f"{_PASS_FOLDER}/").rpartition(".")[0]
        if files.is_behind_link(file):
            finding = diagnose_pass(
                "a pass is reached by a link; it stands in the project itself", Span.of_file(file), None
            )
            yield ReadPass(name, file, "", None, (finding,))
            continue
        file_text = read_text_file(files, file)
        if file_text.problem:
            problem = diagnose_pass(file_text.problem.message, file_text.problem.span, file_text.problem.help)
            yield ReadPass(name, file, file_text.text, None, (problem,))
        else:
            yield read_pass(name, file, file_text.text, known_states)


def _list_pass_files(files: ProjectFiles) -> list[str]:
    """Return the paths of a project's pass files: those directly in its folder `passes`."""
    for folder, _, names in files.walk_folders(_PASS_FOLDER):
        if folder in {"", "."}:
            return sorted(
                f"{_PASS_FOLDER}/{name}" for name in names if name.endswith(YAML_ENDINGS) and name.isprintable()
            )
        break
    return []


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
        yield diagnose_pass(message, Span.of_file(own.file), "give its file another name")
    elif not is_id(own.name):
        message = f"`{own.name}` is no name for a pass"
        help_line = "small letters, digits and `_`, as in `tag_cameras.yaml`"
        yield diagnose_pass(message, Span.of_file(own.file), help_line)


def _make_pass(name: str, read: ReadPass, findings: tuple[Diagnostic, ...]) -> Pass:
    pattern_pass = read.read_pass

    def run(work: PassWork) -> None:
        if pattern_pass is None or findings:
            work.findings += findings
            return
        # A pass that is stopped makes nothing: what it wrote so far is taken back.
        kept_root, kept_provenance = copy_node(work.tree.root, work.tree.root.span), dict(work.tree.provenance)
        problems = run_rules(pattern_pass, work)
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
