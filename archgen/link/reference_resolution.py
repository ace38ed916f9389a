"""Resolve references: which element a dotted path means, and what to report if it means none, or several.

Say that a reference names nothing, and what it may have meant.

Names of components are looked up in what is composed around their writer first.

Somebody may listen: where a reference is written, and which element it means.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from types import MappingProxyType

from archgen.diagnostics import NO_SPAN, AskedName, Diagnostic, Label, Span, join_words
from archgen.frozen import NamedTuple, dataclass, field, replace
from archgen.language.language_tables import PLAIN_SECTIONS
from archgen.link import mapping_values
from archgen.link.path_guesses import PathGuesser, list_possible_kinds
from archgen.model.path_resolver import NO_MATCH, ElementRef, PathIndex, PathMatch, PathResolver
from archgen.syntax.yaml_tree import MappingNode, ScalarNode


class HeardReference(NamedTuple):
    """A reference that was resolved: `text` as it is written at `span`, `kind` and complete `id` of what it means.

    `writer` is the element that writes it. A reference inside of a component type is heard once for each instance.
    """

    span: Span
    kind: str
    id: str
    text: str
    writer: str


HeardReferences = list[HeardReference]


_MAX_LISTED = 6
"""So many names are listed where no name resembles an unknown one."""


def diagnose_unknown_reference(  # noqa: PLR0913 - what it says
    reference: ScalarNode,
    kind_phrase: str,
    guess: str | None,
    declared_span: Span,
    element_id: str,
    *,
    known_names: Sequence[str] = (),
    asked_name: AskedName | None = None,
) -> Diagnostic:
    """Report that there is no such element, with what may have been meant, or all that there are if they are few."""
    return Diagnostic(
        "unknown-reference",
        f"no {kind_phrase} named `{reference.text}`",
        reference.span,
        labels=(Label(declared_span, "declared here"),) if guess and declared_span != NO_SPAN else (),
        help=f"did you mean `{guess}`?" if guess else list_known_names(known_names),
        element=element_id,
        asked_name=None if guess else asked_name,
    )


def list_known_names(names: Sequence[str]) -> str | None:
    """Return a help line with all names that could be meant, if there are few; else None."""
    if not 0 < len(names) <= _MAX_LISTED:
        return None
    return f"there {'are' if len(names) > 1 else 'is'} {join_words([f'`{name}`' for name in names], 'and')}"


SECTIONS_OF_PLAIN_NAMES = {kind.replace("_", " "): section for kind, section in PLAIN_SECTIONS.items()}
"""The sections that declare what is named by its id alone, by the word of their kind."""
_NO_NODES: Mapping[str, Collection[str]] = MappingProxyType({})
NameList = tuple[tuple[str, tuple[str, ...]], ...]
"""All names of a version, by kind: in two versions with the same ones each reference means the same."""


class Answer(NamedTuple):
    """A reference that was resolved, and what it means; None for what is named by its id alone."""

    text: str
    kinds: Sequence[str]
    component_id: str | None = None
    target: ElementRef | None = None


@dataclass(slots=True)
class HeardAnswers:
    """What was resolved for one element."""

    answers: list[Answer]
    references: tuple[HeardReference, ...] | None = None
    """The same as a listener hears it, None where there is none."""
    is_flawless: bool = False
    """Whether nothing was found fault with."""


@dataclass(slots=True)
class ReferenceResolver:
    """Resolves references to everything that can be referred to, and collects what is wrong with them."""

    spans: Mapping[str, Mapping[str, Span]]
    """Where elements that dotted paths can name were declared, by kind and complete id."""
    plain_spans: Mapping[str, Mapping[str, Span]]
    """The same for elements named by their id alone, by kind (`partner`, `host`, `container`, `use case`) and id."""
    diagnostics: list[Diagnostic]
    lost_keys: frozenset[str] = frozenset()
    """The keys in files that could not be read: what they may declare is not reported as unknown."""
    damaged_elements: frozenset[str] = frozenset()
    """The ids of components in which something could not be read: what it may be is not reported as unknown."""
    suspect_ids: set[str] = field(default_factory=set)
    """Complete ids of what unresolved references most likely meant: later rules do not call these unconnected."""
    make_index: Callable[[str, Iterable[str]], PathIndex] | None = None
    """What indexes the ids of a kind, where somebody remembers these."""
    all_names: NameList | None = None
    """All names of this version, where somebody remembers them: the same object for another one with the same names."""
    answers: list[Answer] | None = None
    """What was resolved since somebody began to listen, None where nobody does."""
    heard: HeardReferences | None = None
    """Where what is resolved is told, None where nobody asks where references stand."""
    names: PathResolver = field(init=False)
    guesser: PathGuesser = field(init=False)
    _is_finished: bool = False
    _changed_paths: dict[int, tuple[NameList, frozenset[str]]] = field(default_factory=dict)
    """By the identity of the names of another version, which are kept so that no others have it."""

    def __post_init__(self) -> None:
        self.names = PathResolver(self.spans, self.make_index) if self.make_index else PathResolver(self.spans)
        # Components inside of components have longer ids.
        extra_depth = max((path.count(".") for path in self.spans.get("component", ())), default=1) - 1
        self.guesser = PathGuesser(self.names, extra_depth)

    def report(  # noqa: PLR0913 - what a diagnostic has
        self,
        rule: str,
        message: str,
        span: Span,
        *,
        labels: tuple[Label, ...] = (),
        help_line: str | None = None,
        element: str | None = None,
    ) -> None:
        """Add a diagnostic."""
        self.diagnostics.append(Diagnostic(rule, message, span, labels=labels, help=help_line, element=element))

    def resolve_reference(  # noqa: PLR0913 - the last two by name
        self,
        reference: ScalarNode,
        kinds: Sequence[str],
        element_id: str,
        component_id: str | None = None,
        *,
        implements: Mapping[str, Collection[str]] = _NO_NODES,
        names: PathResolver | None = None,
    ) -> ElementRef | None:
        """Return the element that a reference means; None, and a diagnostic, if that is not clear.

        `kinds` are the kinds that are allowed here; the diagnostic is about `element_id`. `component_id` is the
        component that writes the reference: elements of its group win; a single word never means itself or its output.
        Where nodes are allowed, `implements` holds the components of each: a node never hides one of its own. `names`
        are what can be named here, where that is not everything.
        """
        self._refuse_if_finished()
        dotted_path = reference.text
        match = (names or self.names).resolve_path(dotted_path, kinds, component_id=component_id)
        target = match.unique_element
        # Whatever an unresolved reference may have meant is a suspect: that such an element seems unread is an
        # aftermath of this finding, not a second mistake.
        if match.count > 1:
            self.report_ambiguous(reference, match, element_id)
        elif target is None and not self.is_lost(dotted_path):
            self.diagnostics.append(self._diagnose_unknown(reference, kinds, element_id, component_id))
        elif target and match.hidden_elements:
            # A node and the component that it implements often have the same name: either is meant, nothing is hidden.
            own_components = implements.get(target.id, ())
            hidden_elements = [element for element in match.hidden_elements if element.id not in own_components]
            if hidden_elements:
                self._warn_hidden(reference, target, hidden_elements, element_id)
        if self.answers is not None:
            self.answers.append(Answer(dotted_path, tuple(kinds), component_id, target))
        if target is not None:
            self.tell(reference.span, dotted_path, *target, element_id)
        return target

    def tell(self, span: Span, text: str, kind: str, target_id: str, writer: str) -> None:
        """Tell who listens which element a reference means."""
        if self.heard is not None:
            self.heard.append(HeardReference(span, kind, target_id, text, writer))

    def tell_again(self, references: tuple[HeardReference, ...] | None) -> bool:
        """Tell what was heard of a part that is taken over; return whether that is possible: somebody listened then."""
        if self.heard is not None and references is not None:
            self.heard.extend(references)
        return self.heard is None or references is not None

    def report_ambiguous(self, reference: ScalarNode, match: PathMatch, element_id: str) -> None:
        """Report a reference that can mean several elements."""
        self.suspect_ids.update(name.id for name in match.elements)
        self.diagnostics.append(self._diagnose_ambiguous(reference, match, element_id))

    @contextmanager
    def listen(self) -> Iterator[HeardAnswers]:
        """Note what is resolved, and whether anything is found fault with."""
        heard = HeardAnswers([])
        counts = len(self.diagnostics), len(self.suspect_ids)
        told_count = len(self.heard or ())
        self.answers = heard.answers
        yield heard
        self.answers = None
        heard.references = tuple(self.heard[told_count:]) if self.heard is not None else None
        heard.is_flawless = counts == (len(self.diagnostics), len(self.suspect_ids))

    def gives_answers(self, answers: Iterable[Answer], names: NameList | None) -> bool:
        """Whether references still mean, without any doubt, what they meant in a version of the project with these names."""
        changed_paths = self._find_changed_paths(names or ())
        for text, kinds, component_id, target in answers:
            if target is None:
                if text not in self.plain_spans.get(kinds[0], ()):
                    return False
            elif text in changed_paths:
                match = self.names.resolve_path(text, kinds, component_id=component_id)
                if match.hidden_elements or match.unique_element != target:
                    return False
        return True

    def _find_changed_paths(self, names: NameList) -> frozenset[str]:
        """Return all paths that may mean what only one of two versions has: any other means what it meant."""
        if id(names) not in self._changed_paths:
            own_ids, other_ids = (
                {(kind, element_id) for kind, ids in each for element_id in ids}
                for each in (self.all_names or (), names)
            )
            paths = frozenset(path for _, element_id in own_ids ^ other_ids for path in list_endings(element_id))
            self._changed_paths[id(names)] = names, paths
        return self._changed_paths[id(names)][1]

    def finish_resolving(self) -> frozenset[str]:
        """Return the suspects of all references; from here on the resolver refuses to resolve any more."""
        self._is_finished = True
        return frozenset(self.suspect_ids)

    def resolve_plain_id(self, reference: ScalarNode | None, kind: str, element_id: str) -> str | None:
        """Return the id of a partner, host, container or use case; None, and a diagnostic, if there is no such one."""
        self._refuse_if_finished()
        known_spans = self.plain_spans[kind]
        if reference is None:
            return None
        if reference.text in known_spans:
            if self.answers is not None:
                self.answers.append(Answer(reference.text, (kind,)))
            self.tell(reference.span, reference.text, kind.replace(" ", "_"), reference.text, element_id)
            return reference.text
        if self.is_lost(reference.text) or SECTIONS_OF_PLAIN_NAMES[kind] in self.lost_keys:
            return None
        guess = self.guesser.guess_name(reference.text, known_spans)
        diagnostic = diagnose_unknown_reference(
            reference,
            kind,
            guess,
            known_spans.get(guess or "", NO_SPAN),
            element_id,
            known_names=tuple(known_spans),
            asked_name=AskedName(kind),
        )
        help_line = diagnostic.help or f"declare it in the section `{SECTIONS_OF_PLAIN_NAMES[kind]}`"
        self.diagnostics.append(replace(diagnostic, help=help_line))
        return None

    def resolve_plain_ids(self, references: Iterable[ScalarNode], kind: str, element_id: str) -> tuple[str, ...]:
        """Return the plain ids in a list that are declared, each once; the others are reported."""
        ids = (self.resolve_plain_id(reference, kind, element_id) for reference in references)
        return tuple(dict.fromkeys(name for name in ids if name))

    def _refuse_if_finished(self) -> None:
        if self._is_finished:
            msg = "a reference is resolved after the suspects were taken: they would lack what it may have meant"
            raise RuntimeError(msg)

    def resolve_owners(self, body: MappingNode, element_id: str, inherited_owners: Iterable[str]) -> tuple[str, ...]:
        """Return the owners of an element, each once: those written, or the inherited ones if none are written."""
        if body.get("owner") is None:
            return tuple(dict.fromkeys(inherited_owners))
        return self.resolve_plain_ids(mapping_values.get_scalars(body, "owner"), "partner", element_id)

    def is_lost(self, dotted_path: str) -> bool:
        """Whether what could not be read may declare what a path names."""
        # The last part or the one before it: a port may be lost, or the component that it belongs to.
        if not self.lost_keys.isdisjoint(dotted_path.split(".")[-2:]):
            return True
        component_path, dot, _ = dotted_path.rpartition(".")
        component = self.names.resolve_path(component_path, ("component",)).unique_element if dot else None
        return component is not None and component.id in self.damaged_elements

    def _diagnose_ambiguous(self, reference: ScalarNode, match: PathMatch, element_id: str) -> Diagnostic:
        quoted_ids = [f"`{name.id}`" for name in match.elements]
        rest = [f"{match.count - len(quoted_ids)} more"] if match.count > len(quoted_ids) else []
        return Diagnostic(
            "ambiguous-reference",
            f"`{reference.text}` can mean {join_words([*quoted_ids, *rest], 'or')}",
            reference.span,
            labels=tuple(Label(self._span_of(name), f"`{name.id}`") for name in match.elements),
            help=f"write more of the path, such as `{match.elements[0].id}`",
            element=element_id,
        )

    def _diagnose_unknown(
        self, reference: ScalarNode, kinds: Sequence[str], element_id: str, component_id: str | None
    ) -> Diagnostic:
        dotted_path = reference.text
        kind_phrase = list_possible_kinds(kinds, dotted_path.count(".") + 1)
        # The commonest reasons are named before anything is guessed: the writer itself, an input, a group.
        own_output = f"{component_id}.{dotted_path}"
        if component_id and (own_output in self.spans["output"] or component_id.endswith(f".{dotted_path}")):
            help_line = "one word never means the writer itself or its own output: a loop is written `component.output`"
            message = f"no other {kind_phrase} named `{dotted_path}`"
            return Diagnostic("unknown-reference", message, reference.span, help=help_line, element=element_id)
        inputs = self.names.ids_ending_in("input", dotted_path)
        if "output" in kinds and inputs:
            labels = (Label(self.spans["input"][inputs[0]], "an input"),)
            message = f"no {kind_phrase} named `{dotted_path}`: `{inputs[0]}` is an input"
            help_line = "name the output that the data comes from"
            return Diagnostic(
                "unknown-reference", message, reference.span, labels=labels, help=help_line, element=element_id
            )
        if dotted_path in self.spans["group"] and "group" not in kinds:
            return self._diagnose_group(reference, kind_phrase, element_id)
        other_kind = self._diagnose_other_kind(reference, kinds, kind_phrase, element_id)
        if other_kind is not None:
            return other_kind
        guess = self.guesser.guess_path(dotted_path, kinds)
        candidates = self.names.resolve_path(guess, kinds, component_id=component_id) if guess else NO_MATCH
        self.suspect_ids.update(name.id for name in candidates.elements)
        guessed_element = candidates.unique_element
        return diagnose_unknown_reference(
            reference,
            kind_phrase,
            guess,
            self._span_of(guessed_element) if guessed_element else NO_SPAN,
            element_id,
            known_names=self._list_outputs(dotted_path) if "output" in kinds else (),
            asked_name=AskedName("part"),
        )

    def _list_outputs(self, dotted_path: str) -> tuple[str, ...]:
        """Return the outputs of the component that a path leads to but for its last part."""
        component = self.names.resolve_path(dotted_path.rpartition(".")[0], ("component",)).unique_element
        prefix = f"{component.id}." if component else ""
        return tuple(name for name in self.spans["output"] if prefix and name.startswith(prefix))

    def _diagnose_other_kind(
        self, reference: ScalarNode, kinds: Sequence[str], kind_phrase: str, element_id: str
    ) -> Diagnostic | None:
        """Report a path that names an output, or a node, where none can stand; None for any other path."""
        for kind, help_line in (("output", "name its component"), ("node", "name the component that it implements")):
            ids = self.names.ids_ending_in(kind, reference.text) if kind not in kinds else ()
            if ids:
                self.suspect_ids.update(ids)
                is_sure = kind == "output" and "component" in kinds and len(ids) == 1
                sure_help = f"did you mean `{ids[0].rpartition('.')[0]}`?" if is_sure else help_line
                message = f"no {kind_phrase} named `{reference.text}`: it is {'an' if kind == 'output' else 'a'} {kind}"
                labels = (Label(self.spans[kind][ids[0]], f"the {kind}"),)
                return Diagnostic(
                    "unknown-reference", message, reference.span, labels=labels, help=sure_help, element=element_id
                )
        return None

    def _diagnose_group(self, reference: ScalarNode, kind_phrase: str, element_id: str) -> Diagnostic:
        group_id, group_span = reference.text, self.spans["group"][reference.text]
        self.suspect_ids.update(path for path in self.spans["component"] if path.startswith(f"{group_id}."))
        return Diagnostic(
            "unknown-reference",
            f"no {kind_phrase} named `{group_id}`: it is a group",
            reference.span,
            labels=(Label(group_span, "the group"),),
            help="name its components",
            element=element_id,
        )

    def _warn_hidden(
        self, reference: ScalarNode, visible: ElementRef, hidden: Sequence[ElementRef], element_id: str
    ) -> None:
        self.report(
            "hidden-reference",
            f"`{reference.text}` is the {visible.kind} `{visible.id}`, which hides the {hidden[0].kind} `{hidden[0].id}`",
            reference.span,
            labels=tuple(Label(self._span_of(element), "hidden") for element in hidden),
            help_line=f"write `{hidden[0].id}` if that is meant",
            element=element_id,
        )

    def _span_of(self, element: ElementRef) -> Span:
        return self.spans[element.kind][element.id]


def list_endings(element_id: str) -> Iterator[str]:
    """Yield every path that an id ends in, itself included."""
    ending, dot = element_id, "."
    while dot:
        yield ending
        _, dot, ending = ending.partition(".")


def find_inner_component(text: str, resolver: ReferenceResolver, writer_id: str) -> str | None:
    """Return the component that a text names inside of its writer or of what is around it, the innermost one; not the writer.

    So a name in a component type means one of its own components in each instance.
    """
    around = writer_id
    # What has no dot is a group: in it names are looked up as everywhere.
    while "." in around:
        if f"{around}.{text}" != writer_id and f"{around}.{text}" in resolver.spans["component"]:
            return f"{around}.{text}"
        around = around.rpartition(".")[0]
    return None
