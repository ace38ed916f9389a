"""Run the rules of a pass upon a tree: each as long as it finds something, all again until none does."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from archgen.diagnostics import Diagnostic, Label, Span
from archgen.diagnostics.element_origins import TreePath
from archgen.passes.linked_tree import LinkedTree
from archgen.passes.pass_shape import PassWork
from archgen.passes.patterns.architecture_view import ArchitectureView
from archgen.passes.patterns.edit_values import EditError, fill_pattern
from archgen.passes.patterns.expression_values import WrongValueError, evaluate_operand, is_condition_true
from archgen.passes.patterns.expressions import (
    WRONG_PASS,
    Call,
    LetBinding,
    ListOperand,
    PatternPass,
    RewriteRule,
    TextOperand,
)
from archgen.passes.patterns.matching import COMPONENTS, MAX_TEXT, BudgetExceededError, MatchBudget, match_view
from archgen.passes.patterns.model_facts import ModelFacts
from archgen.passes.patterns.pattern_shapes import Bindings, Constant, MappingPattern, PortReference, ViewValue
from archgen.passes.patterns.tree_edits import TreeEditor
from archgen.passes.patterns.view_values import FACT_KEYS
from archgen.syntax.yaml_tree import ScalarNode, SequenceNode

MAX_APPLICATIONS = 10_000
"""So often the rules of one pass may write something."""
MATCH_STEPS = 1_000_000
"""So many steps matching may take in one pass: some seconds."""
_STEPS_PER_COMPONENT = 500
"""So many more for each component, so that large projects have room."""
_STEPS_OF_LINKING = 2_000
_STEPS_OF_LINKED_COMPONENT = 20
"""So many steps it counts to link the project again, and for each component: what rules ask of the whole model follows."""
_MAX_NAMED = 4


class _PassStoppedError(Exception):
    """A pass comes to no end, or writes what cannot be written. Carries the finding."""

    def __init__(self, finding: Diagnostic) -> None:
        super().__init__()
        self.finding = finding


def run_rules(
    pattern_pass: PatternPass,
    work: PassWork,
    *,
    max_applications: int = MAX_APPLICATIONS,
    match_steps: int | None = None,
) -> tuple[Diagnostic, ...]:
    """Apply the rules of a pass to the tree of its work, in place, until none finds anything. Return what is wrong."""
    view = ArchitectureView(work.tree)
    steps = MATCH_STEPS + _STEPS_PER_COMPONENT * len(view.elements) if match_steps is None else match_steps
    runner = _RuleRunner(pattern_pass, view, work.link, MatchBudget(steps), max_applications)
    try:
        runner.run()
    except _PassStoppedError as stopped:
        return (stopped.finding,)
    return ()


class _RuleRunner:
    """Runs the rules of one pass."""

    def __init__(
        self,
        pattern_pass: PatternPass,
        view: ArchitectureView,
        link: Callable[[], LinkedTree],
        budget: MatchBudget,
        max_applications: int,
    ) -> None:
        self._pass = pattern_pass
        self._view = view
        self._link = link if asks_for_facts(pattern_pass) else None
        self._budget = budget
        self._max_applications = max_applications
        self._editor = TreeEditor(view)
        self._count = 0
        self._idle_at: dict[int, int] = {}

    def run(self) -> None:
        for rule in self._pass.rules:
            self._refuse_hidden(rule)
        has_changed = True
        while has_changed:
            has_changed = False
            for number, rule in enumerate(self._pass.rules):
                # What found nothing finds nothing in the same tree.
                while self._idle_at.get(number) != self._view.tree.edit_count:
                    if self._run_rule(rule):
                        has_changed = True
                    else:
                        self._idle_at[number] = self._view.tree.edit_count
        if self._editor.has_new_names:
            keep_meanings(self._view)

    def _refuse_hidden(self, rule: RewriteRule) -> None:
        """Stop at a component that is named by a path under which rules do not see it: nothing would ever be found there."""
        for section, entry in rule.find.entries:
            path = str(entry.key.text) if section == COMPONENTS and isinstance(entry.key, Constant) else ""
            key = self._view.find_key(path) if path else None
            if key not in {None, path}:
                message = f"`{path}` stands inside of an instance, and what is inside of it is seen in its type"
                help_line = f"`{key}` is what rules see; the pass `resolve_instances` makes it a component of its own"
                raise _PassStoppedError(Diagnostic(WRONG_PASS, message, entry.span, help=help_line))

    def _run_rule(self, rule: RewriteRule) -> bool:
        """Apply a rule wherever it finds something now; say whether it found anything."""
        has_applied = False
        try:
            self._renew_facts()
            for match_bindings in match_view(rule.find, self._view, {}, self._budget, rule.distinct):
                # What was written meanwhile may have taken away what was found.
                if has_applied and not self._is_found(rule, match_bindings):
                    continue
                bindings = self._bind_names(rule, match_bindings)
                if self._is_wanted(rule, bindings):
                    self._apply(rule, bindings)
                    has_applied = True
        except BudgetExceededError:
            message = (
                f"the pass `{self._pass.name}` takes more than {self._budget.steps:,} steps to find what it looks for"
                if self._budget.remaining < 0
                else f"the pass `{self._pass.name}` makes a text of more than {MAX_TEXT:,} letters"
            )
            help_line = "let the components of `find` have more in common: a variable, or `in`"
            raise _PassStoppedError(Diagnostic(WRONG_PASS, message, rule.span, help=help_line)) from None
        return has_applied

    def _renew_facts(self) -> bool:
        """Link the project again where rules ask for what only the linker knows and the tree was edited; say whether."""
        facts = self._editor.facts
        if self._link is None or (facts is not None and facts.edit_count == self._view.tree.edit_count):
            return False
        self._budget.spend(_STEPS_OF_LINKING + _STEPS_OF_LINKED_COMPONENT * len(self._view.elements))
        self._editor.facts = facts = ModelFacts(self._link(), self._view)
        self._view.show_facts(facts.elements, facts.hosts)
        return True

    def _is_found(self, rule: RewriteRule, bindings: Bindings) -> bool:
        return any(True for _ in match_view(rule.find, self._view, bindings, self._budget, rule.distinct))

    def _bind_names(self, rule: RewriteRule, match_bindings: Bindings) -> Bindings:
        bindings: dict[str, ViewValue] = dict(match_bindings)
        for let in rule.let:
            try:
                bindings[let.name] = self._evaluate_let(let, bindings)
            except (WrongValueError, EditError) as error:
                raise self._stop(rule, bindings, str(error), None, let.span) from None
        return bindings

    def _evaluate_let(self, let: LetBinding, bindings: Bindings) -> ViewValue:
        if let.is_expression and isinstance(let.value, (TextOperand, ListOperand, Call)):
            return evaluate_operand(let.value, bindings, self._view)
        return fill_pattern(let.value, bindings)  # type: ignore[arg-type]

    def _is_wanted(self, rule: RewriteRule, bindings: Bindings) -> bool:
        try:
            if not all(is_condition_true(written.comparison, bindings, self._view) for written in rule.where):
                return False
            for negative in rule.unless:
                for inner in match_view(
                    negative.pattern, self._view, bindings, self._budget, rule.distinct | negative.distinct
                ):
                    if all(is_condition_true(written.comparison, inner, self._view) for written in negative.where):
                        return False
        except WrongValueError as error:
            raise self._stop(rule, bindings, str(error), None) from None
        return True

    def _apply(self, rule: RewriteRule, bindings: Bindings) -> None:
        try:
            has_changed = self._editor.apply(rule.edits, bindings, self._find_origin(rule, bindings))
        except EditError as error:
            raise self._stop(rule, bindings, str(error), error.help_line) from None
        if not has_changed and self._renew_facts() and not self._is_open(rule, bindings):
            return
        if not has_changed:
            message = "this rule changes nothing that it finds, and comes to no end"
            raise self._stop(rule, bindings, message, "say in `unless` when its work is done")
        self._count += 1
        if self._count > self._max_applications:
            message = f"the pass `{self._pass.name}` has changed something {self._max_applications:,} times, and still finds more"
            raise self._stop(rule, bindings, message, "say in `unless` when the work of a rule is done")

    def _is_open(self, rule: RewriteRule, bindings: Bindings) -> bool:
        """Whether a rule still finds what it found, and would write it."""
        return self._is_found(rule, bindings) and self._is_wanted(rule, bindings)

    def _find_origin(self, rule: RewriteRule, bindings: Bindings) -> TreePath:
        """Return where the first element that a rule found is written: what it makes is made from that."""
        for section, entry in rule.find.entries:
            name = bindings.get(getattr(entry.key, "name", ""), str(getattr(entry.key, "text", "")))
            path = self._editor.find_path(section, name) if isinstance(name, str) else None
            if path is not None:
                return path
        return ()

    def _stop(
        self, rule: RewriteRule, bindings: Bindings, message: str, help_line: str | None, span: Span | None = None
    ) -> _PassStoppedError:
        """Return what ends the pass: the rule's place, and beside it that of what it found."""
        names = [f"`${name}` is `{value}`" for name, value in bindings.items() if isinstance(value, str)]
        place = self._view.tree.find_place(self._find_origin(rule, bindings))
        text = ", ".join(names[:_MAX_NAMED]) or "found here"
        place_of_rule = rule.span if span is None else span
        return _PassStoppedError(
            Diagnostic(
                WRONG_PASS,
                message,
                place_of_rule,
                labels=(Label(place, text),),
                help=help_line,
            )
        )


def asks_for_facts(pattern_pass: PatternPass) -> bool:
    """Whether a pass asks for what is only known once the project is linked: nodes, hosts, where a component runs."""
    for rule in pattern_pass.rules:
        patterns = (rule.find, *(each.pattern for each in rule.unless), *(each.pattern for each in rule.edits))
        for section, entry in (each for pattern in patterns for each in pattern.entries):
            inner = entry.value.entries if isinstance(entry.value, MappingPattern) else ()
            keys = {str(each.key.text) for each in inner if isinstance(each.key, Constant)}
            if section in FACT_KEYS or (section == COMPONENTS and "host" in keys):
                return True
    return False


def keep_meanings(view: ArchitectureView) -> None:
    """Write references anew that new names would let mean something else: each means what it meant before."""
    view.references.forget_names()
    for path, reference, writer, is_output in list(_list_references(view)):
        node = view.tree.get(path)
        if not isinstance(node, ScalarNode):
            continue
        if view.references.resolve(node.text, writer, is_output=is_output) != reference:
            words = view.references.write(reference, writer, is_output=is_output)
            if words is not None and words != node.text:
                view.tree.set(path, ScalarNode(words, words, node.span), path)


def _list_references(view: ArchitectureView) -> Iterator[tuple[TreePath, PortReference, str, bool]]:
    for key in view.elements:
        layer = view.list_layers(key)[0]
        yield from _list_items(view, (*layer.path, "from"), key, is_output=False)
        for side in ("inputs", "outputs"):
            ports = view.tree.get_mapping((*layer.path, side))
            for name in tuple(ports):
                yield from _list_items(view, (*layer.path, side, name, "from"), key, is_output=side == "outputs")


def _list_items(
    view: ArchitectureView, path: TreePath, key: str, *, is_output: bool
) -> Iterator[tuple[TreePath, PortReference, str, bool]]:
    node = view.tree.get(path)
    for number, item in enumerate(node.items if isinstance(node, SequenceNode) else ()):
        reference = view.find_reference(item)
        if reference is not None:
            yield (*path, number), reference, key, is_output
